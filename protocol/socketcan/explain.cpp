#include <cerrno>
#include <cstring>

#include "protocol/socketcan/socket_bus.hpp"

namespace pinjaw::socketcan {

bus::Failure explain(int error, const std::string& interface) {
  using Kind = bus::FailureKind;
  switch (error) {
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT:
      return {
          Kind::Unavailable,
          "this machine's kernel has no CAN: load it with 'modprobe -a can can-raw vcan', or run the command "
          "inside 'tools/vcan-run', or, for pinjaw run, use '--bus sim:'"};
    case ENODEV:
    case ENXIO:
      return {Kind::Unavailable,
              "there is no CAN interface " + interface +
                  ": 'ip -brief link show type can' and '... type vcan' list those there are, "
                  "'ip link add dev " +
                  interface + " type vcan' makes a virtual one"};
    case ENETDOWN:
      return {Kind::Down, "the CAN interface " + interface + " is down: 'ip link set " + interface +
                              " up' starts it (a real one needs its bit rate first: 'ip link set " +
                              interface + " type can bitrate 500000')"};
    case EPERM:
    case EACCES:
      return {Kind::Unavailable,
              "this user may not use the CAN interface " + interface + ": " + std::strerror(error)};
    case ENOBUFS:
    case EAGAIN:
      return {Kind::Overflow, "too many frames wait for " + interface +
                                  ": nobody acknowledges them, or the bus is full ('ip -details link show " +
                                  interface + "')"};
    default:
      return {Kind::System, "the CAN interface " + interface + " failed: " + std::strerror(error)};
  }
}

}  // namespace pinjaw::socketcan

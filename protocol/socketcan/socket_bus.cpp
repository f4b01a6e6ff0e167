#include "protocol/socketcan/socket_bus.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

namespace pinjaw::socketcan {

namespace {

constexpr int kReceiveBuffer_bytes = 4 << 20;  // the default holds 278 frames, 75 ms of a full 500 kbit/s bus

/// Only for how long frames have waited.
std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

template <class Value>
bool set_option(int descriptor, int level, int name, const Value& value) {
  return ::setsockopt(descriptor, level, name, &value, sizeof value) == 0;
}

bool set_filters(int descriptor, const std::vector<bus::Filter>& filters) {
  if (filters.empty()) return true;
  std::vector<can_filter> raw;
  raw.reserve(filters.size());
  for (const bus::Filter& filter : filters) {
    // The flags belong to the mask, else 0x123 would also let an extended or remote frame 0x123 pass.
    raw.push_back({filter.id & CAN_SFF_MASK, (filter.mask & CAN_SFF_MASK) | CAN_EFF_FLAG | CAN_RTR_FLAG});
  }
  return ::setsockopt(descriptor, SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(),
                      static_cast<socklen_t>(raw.size() * sizeof(can_filter))) == 0;
}

/// Everything that must be so before bind(), so that no frame comes early. Gives an errno, or 0.
int configure(int descriptor, const Settings& settings) {
  if (!set_filters(descriptor, settings.filters)) return errno;
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int on = 1;
  if (!set_option(descriptor, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors)) return errno;
  if (settings.hear_self && !set_option(descriptor, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, on)) return errno;
  if (!set_option(descriptor, SOL_SOCKET, SO_RXQ_OVFL, on)) return errno;
  if (!set_option(descriptor, SOL_SOCKET, SO_TIMESTAMP, on)) return errno;
  if (!set_option(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, kReceiveBuffer_bytes) &&
      !set_option(descriptor, SOL_SOCKET, SO_RCVBUF, kReceiveBuffer_bytes)) {
    return errno;
  }
  return 0;
}

/// Binds to `interface` and makes sure that it is up. Gives an errno, or 0.
int attach(int descriptor, const std::string& interface) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) return ENODEV;
  ifreq request{};
  std::memcpy(request.ifr_name, interface.data(), interface.size());
  if (::ioctl(descriptor, SIOCGIFINDEX, &request) != 0) return errno;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return errno;
  if (::ioctl(descriptor, SIOCGIFFLAGS, &request) != 0) return errno;
  return (request.ifr_flags & IFF_UP) != 0 ? 0 : ENETDOWN;
}

can_frame to_raw(const wire::Frame& frame) {
  can_frame raw{};
  raw.can_id = frame.extended ? (frame.id & CAN_EFF_MASK) | CAN_EFF_FLAG : frame.id & CAN_SFF_MASK;
  if (frame.kind == wire::FrameKind::Remote) raw.can_id |= CAN_RTR_FLAG;
  if (frame.kind == wire::FrameKind::Error) raw.can_id = (frame.id & CAN_ERR_MASK) | CAN_ERR_FLAG;
  raw.can_dlc = std::min<std::uint8_t>(frame.length, CAN_MAX_DLEN);
  std::copy_n(frame.data.begin(), raw.can_dlc, raw.data);
  return raw;
}

wire::Frame from_raw(const can_frame& raw) {
  wire::Frame frame;
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    frame.kind = wire::FrameKind::Error;
    frame.id = raw.can_id & CAN_ERR_MASK;
  } else {
    frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.kind = (raw.can_id & CAN_RTR_FLAG) != 0 ? wire::FrameKind::Remote : wire::FrameKind::Data;
    frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  }
  frame.length = std::min<std::uint8_t>(raw.can_dlc, CAN_MAX_DLEN);
  if (frame.kind != wire::FrameKind::Remote) std::copy_n(raw.data, frame.length, frame.data.begin());
  return frame;
}

bus::Origin origin_of(int flags) {
  if ((flags & MSG_CONFIRM) != 0) return bus::Origin::Self;
  return (flags & MSG_DONTROUTE) != 0 ? bus::Origin::SameMachine : bus::Origin::Elsewhere;
}

/// What the kernel tells beside a frame.
struct Ancillary {
  std::int64_t time_us = 0;
  std::optional<std::uint32_t> overflow;
};

Ancillary ancillary_of(msghdr& message) {
  Ancillary ancillary;
  for (cmsghdr* entry = CMSG_FIRSTHDR(&message); entry != nullptr; entry = CMSG_NXTHDR(&message, entry)) {
    if (entry->cmsg_level != SOL_SOCKET) continue;
    if (entry->cmsg_type == SO_TIMESTAMP) {
      timeval time{};
      std::memcpy(&time, CMSG_DATA(entry), sizeof time);
      ancillary.time_us = std::int64_t{time.tv_sec} * 1'000'000 + time.tv_usec;
    } else if (entry->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t dropped = 0;
      std::memcpy(&dropped, CMSG_DATA(entry), sizeof dropped);
      ancillary.overflow = dropped;
    }
  }
  return ancillary;
}

}  // namespace

bus::Expected<std::unique_ptr<SocketBus>> SocketBus::open(const std::string& interface,
                                                          const Settings& settings) {
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (descriptor < 0) return tl::unexpected(explain(errno, interface));
  std::unique_ptr<SocketBus> opened(new SocketBus(descriptor, interface));
  if (const int error = configure(descriptor, settings)) return tl::unexpected(explain(error, interface));
  if (const int error = attach(descriptor, interface)) return tl::unexpected(explain(error, interface));
  return opened;
}

SocketBus::SocketBus(int descriptor, std::string interface)
    : descriptor_(descriptor), interface_(std::move(interface)) {}

SocketBus::~SocketBus() {
  ::close(descriptor_);
}

WriteResult SocketBus::write(const wire::Frame& frame) {
  const can_frame raw = to_raw(frame);
  if (::write(descriptor_, &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw)) {
    ++statistics_.sent;
    return WriteResult::Taken;
  }
  write_error_ = errno;
  return write_error_ == ENOBUFS || write_error_ == EAGAIN ? WriteResult::Full : WriteResult::Failed;
}

bus::Expected<void> SocketBus::flush() {
  const auto result = queue_.flush(steady_us(), [this](const wire::Frame& frame) { return write(frame); });
  if (result == WriteResult::Failed) return tl::unexpected(explain(write_error_, interface_));
  return {};
}

bus::Expected<void> SocketBus::send(const wire::Frame& frame) {
  if (!queue_.push(frame, steady_us())) {
    ++statistics_.lost_sending;
    return tl::unexpected(explain(ENOBUFS, interface_));
  }
  return flush();
}

bus::Expected<std::optional<bus::Received>> SocketBus::receive() {
  if (!queue_.empty()) {
    if (const auto flushed = flush(); !flushed) return tl::unexpected(flushed.error());
  }
  can_frame raw{};
  iovec buffer{&raw, sizeof raw};
  alignas(cmsghdr) std::array<char, 256> control{};
  msghdr message{};
  message.msg_iov = &buffer;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(descriptor_, &message, MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return std::nullopt;
  if (size < 0) return tl::unexpected(explain(errno, interface_));
  const Ancillary ancillary = ancillary_of(message);
  if (ancillary.overflow) overflow_ = *ancillary.overflow;
  if (size != static_cast<ssize_t>(sizeof raw)) return std::nullopt;
  const bus::Received received{from_raw(raw), ancillary.time_us, origin_of(message.msg_flags)};
  if (received.frame.kind == wire::FrameKind::Error) ++statistics_.error_frames;
  ++statistics_.received;
  return received;
}

bus::Statistics SocketBus::statistics() const {
  bus::Statistics statistics = statistics_;
  statistics.lost_receiving = overflow_;
  statistics.lost_sending += queue_.dropped();
  return statistics;
}

void SocketBus::wait(std::int64_t timeout_us) {
  // POLLOUT does not tell of room in the driver's queue, so what waits is tried again soon.
  if (!queue_.empty()) timeout_us = std::min<std::int64_t>(timeout_us, 1000);
  pollfd poll{.fd = descriptor_, .events = POLLIN, .revents = 0};
  const timespec timeout{.tv_sec = timeout_us / 1'000'000, .tv_nsec = timeout_us % 1'000'000 * 1000};
  ::ppoll(&poll, 1, &timeout, nullptr);
}

}  // namespace pinjaw::socketcan

#pragma once

#include <cstdint>

#include "protocol/wire/codes.hpp"

namespace pinjaw::core {

/// How bad each fault is. With Hold or worse a node neither gives nor takes, and its session ends.
constexpr wire::Severity severity_of(wire::FaultCode code) {
  using enum wire::FaultCode;
  switch (code) {
    case None:
    case HandoffAborted:
    case LayoutRefused:
    case BusOffRecovered:
      return wire::Severity::Info;
    case SupplyVoltage:
    case SupplyAirLow:
    case Leak:
    case ReceiveOverrun:
    case BusPassive:
    case HostLost:
    case PeerLost:
    case OwnIdSeen:
    case BadChecksum:
    case BadSequence:
    case BadSession:
    case Authentication:
    case InDoubt:
    case ManualRelease:
      return wire::Severity::Warning;
    case CustodyMemory:
    case MemorySelfTest:
    case Watchdog:
      return wire::Severity::Latched;
    default:
      return wire::Severity::Hold;
  }
}

/// The faults of a controller as sets of bits; a bit is a fault's index on the wire.
class Faults {
 public:
  /// Sets a fault; true where it was not there before.
  bool raise(wire::FaultCode code) {
    const std::uint32_t bit = bit_of(code);
    const bool fresh = (active_ & bit) == 0;
    active_ |= bit;
    if (fresh) to_report_ |= bit;
    return fresh;
  }
  void clear(wire::FaultCode code) {
    const std::uint32_t bit = bit_of(code) & active_;
    active_ &= ~bit;
    to_report_ |= bit;
  }
  void clear_all() {
    to_report_ |= active_;
    active_ = 0;
  }
  /// Reports something that happened and is over.
  void note(wire::FaultCode code) { to_report_ |= bit_of(code); }
  void report_all_again() { to_report_ |= active_; }

  [[nodiscard]] bool active(wire::FaultCode code) const { return (active_ & bit_of(code)) != 0; }
  /// The worst active fault, or None.
  [[nodiscard]] wire::FaultCode worst() const {
    wire::FaultCode worst = wire::FaultCode::None;
    for (const wire::FaultCode code : wire::kFaultCodes) {
      if (active(code) && (worst == wire::FaultCode::None || severity_of(code) > severity_of(worst))) {
        worst = code;
      }
    }
    return worst;
  }
  /// One for which the node must hold is active.
  [[nodiscard]] bool must_hold() const { return severity_of(worst()) >= wire::Severity::Hold; }
  /// The next fault to report, once; None where there is none.
  wire::FaultCode take_report() {
    for (const wire::FaultCode code : wire::kFaultCodes) {
      const std::uint32_t bit = bit_of(code);
      if ((to_report_ & bit) == 0) continue;
      to_report_ &= ~bit;
      return code;
    }
    return wire::FaultCode::None;
  }

 private:
  static constexpr std::uint32_t bit_of(wire::FaultCode code) {
    static_assert(wire::kFaultCodes.size() <= 32);
    const std::uint8_t index = wire::index_of(code);
    return index == 0 ? 0U : std::uint32_t{1} << index;
  }
  std::uint32_t active_ = 0;
  std::uint32_t to_report_ = 0;
};

}  // namespace pinjaw::core

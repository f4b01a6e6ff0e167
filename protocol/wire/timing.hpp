#pragma once

#include <algorithm>
#include <cstdint>

/// Times of the protocol. Each freshness limit is three periods plus the worst bus delay of 8 nodes at 500
/// kbit/s (docs/timing.md).
namespace pinjaw::wire {

inline constexpr std::uint16_t kPeerFresh_ms = 70;   ///< 3 x 20 ms + 8.3 ms + slack
inline constexpr std::uint16_t kHostFresh_ms = 200;  ///< 3 x 50 ms + 11.0 ms + slack
inline constexpr std::uint16_t kHostHeartbeat_ms = 50;
inline constexpr std::uint16_t kAcknowledge_ms = 50;  ///< without ACK for so long, the host repeats
inline constexpr std::uint16_t kStatePeriod_ms = 20;
inline constexpr std::uint16_t kForceOffset_ms = 10;  ///< FORCE follows STATE by half a period
inline constexpr std::uint16_t kCustodyHandoff_ms = 20;
inline constexpr std::uint16_t kCustodyIdle_ms = 100;
inline constexpr std::uint16_t kFaultPeriod_ms = 100;
inline constexpr std::uint16_t kPneumaticsPeriod_ms = 100;
inline constexpr std::uint16_t kLayoutStatusPeriod_ms = 500;
inline constexpr std::uint16_t kIdentityPeriod_ms = 1000;
inline constexpr std::uint16_t kTimePeriod_ms = 1000;
inline constexpr std::uint16_t kGlobalHoldSpacing_ms = 5;
inline constexpr std::uint8_t kGlobalHoldRepeats = 3;

/// A timer as the time that remains, so that whoever holds the state may fire it.
class Countdown {
 public:
  constexpr void start(std::uint16_t ms) { left_ms_ = ms; }
  constexpr void stop() { left_ms_ = 0; }
  constexpr void advance(std::uint16_t elapsed_ms) {
    left_ms_ = static_cast<std::uint16_t>(left_ms_ - std::min(left_ms_, elapsed_ms));
  }
  [[nodiscard]] constexpr bool running() const { return left_ms_ > 0; }
  [[nodiscard]] constexpr std::uint16_t left_ms() const { return left_ms_; }
  friend constexpr bool operator==(const Countdown&, const Countdown&) = default;

 private:
  std::uint16_t left_ms_ = 0;
};

}  // namespace pinjaw::wire

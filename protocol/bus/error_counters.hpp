#pragma once

#include <algorithm>

namespace pinjaw::bus {

/// Fault confinement of one CAN controller (ISO 11898-1:2015, 10.9 and 12.1.4): what its own errors cost it.
class ErrorCounters {
 public:
  /// A frame of its own was destroyed by an error.
  void sending_failed() { sending_ += 8; }
  /// Nobody acknowledged a frame of its own: an error-passive sender does not count it, so that the last one
  /// on a bus waits for company and does not switch itself off.
  void unacknowledged() {
    if (!passive()) sending_ += 8;
  }
  void sent() { sending_ = std::max(sending_ - 1, 0); }
  /// A frame of another was destroyed.
  void receiving_failed() { receiving_ = std::min(receiving_ + 1, kPassive); }
  void received() { receiving_ = receiving_ >= kPassive ? kAfterPassive : std::max(receiving_ - 1, 0); }
  void reset() { sending_ = receiving_ = 0; }

  /// Sends no dominant error flags any more, and waits longer between frames.
  [[nodiscard]] bool passive() const { return !off() && (sending_ >= kPassive || receiving_ >= kPassive); }
  /// Takes no part in the bus.
  [[nodiscard]] bool off() const { return sending_ >= kOff; }
  [[nodiscard]] int sending() const { return sending_; }
  [[nodiscard]] int receiving() const { return receiving_; }

 private:
  static constexpr int kPassive = 128;
  static constexpr int kAfterPassive = 127;  // the standard: a value from 119 to 127
  static constexpr int kOff = 256;
  int sending_ = 0;
  int receiving_ = 0;
};

}  // namespace pinjaw::bus

#pragma once

#include <array>
#include <cstdint>

#include "firmware_sim/core/io.hpp"
#include "protocol/wire/timing.hpp"

namespace pinjaw::core {

/// What a controller does about bus-off (docs/reliability.md 2.5): it holds at once, recovers by itself three
/// times in 10 s at most, and after that stays off, holding, until power is switched off and on.
class BusLink {
 public:
  /// Takes in one step's health.
  void observe(const BusHealth& health, std::uint16_t elapsed_ms);

  [[nodiscard]] bool off() const { return off_; }
  /// Bus-off began in this step.
  [[nodiscard]] bool fell_off() const { return off_ && !was_off_; }
  /// Bus-off ended in this step: whoever was heard before must qualify again.
  [[nodiscard]] bool recovered() const { return was_off_ && !off_; }
  [[nodiscard]] bool passive() const { return passive_; }
  /// Frames were lost for want of room in this step.
  [[nodiscard]] bool overran() const { return overran_; }
  /// The CAN controller may recover now.
  [[nodiscard]] bool restart() const { return restart_; }

 private:
  bool take_recovery();

  bool off_ = false;
  bool was_off_ = false;
  bool passive_ = false;
  bool overran_ = false;
  bool restart_ = false;
  bool given_up_ = false;
  std::uint32_t overruns_ = 0;
  std::array<wire::Countdown, 3> recent_{};  ///< recoveries of the last 10 s
};

}  // namespace pinjaw::core

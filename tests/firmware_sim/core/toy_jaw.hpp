#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "firmware_sim/core/core.hpp"

namespace pinjaw::core::test {

/// A jaw in whole numbers, one step a millisecond: enough air, friction and contact to close the loop around
/// the core. It is no model of anything real; the plant is.
struct ToyJaw {
  bool passive = false;
  std::int32_t supply_mbar = 6000;
  std::int32_t close_mbar = 0;
  std::int32_t open_mbar = 0;
  std::int32_t regulator_mbar = 0;
  std::int32_t separation_10um = 6000;
  std::optional<std::int32_t> part_10um;  ///< separation at which the pins touch the part; nothing: no part
  bool part_on_seats = false;
  bool local_enable = false;
  bool regulator_stuck_open = false;
  std::int32_t leak_permille = 0;
  std::int32_t offset_a_mbar = 0;  ///< error of close sensor A

  [[nodiscard]] std::int32_t push_dn() const { return (close_mbar - open_mbar * 85 / 100) * 259 / 1000; }
  [[nodiscard]] bool touches() const { return part_10um && separation_10um <= *part_10um; }
  /// True squeeze on the part.
  [[nodiscard]] std::int32_t squeeze_dn() const { return touches() ? std::max(push_dn(), 0) : 0; }

  [[nodiscard]] Sensors read() const {
    return {.close_mbar = {close_mbar + offset_a_mbar, close_mbar},
            .open_mbar = {open_mbar, open_mbar},
            .supply_mbar = supply_mbar,
            .separation_10um = separation_10um,
            .seats = static_cast<std::uint8_t>(part_on_seats ? 7 : 0),
            .local_enable = local_enable};
  }

  void step(const Valves& valves) {
    if (passive) return;
    step_air(valves);
    constexpr std::int32_t kFriction_dn = 60;
    if (push_dn() > kFriction_dn && !touches()) {
      separation_10um = std::max({separation_10um - 12, 0, part_10um.value_or(0)});
      if (valves.spool == Spool::Hold) close_mbar -= 4;  // shut in, the air expands
    } else if (push_dn() < -kFriction_dn) {
      separation_10um = std::min(separation_10um + 20, 6000);
    }
  }

 private:
  void step_air(const Valves& valves) {
    const std::int32_t wanted_mbar =
        regulator_stuck_open ? supply_mbar : std::min(valves.close_set_mbar, supply_mbar);
    regulator_mbar += (wanted_mbar - regulator_mbar) / 10;
    if (valves.spool == Spool::Close) {
      const std::int32_t source_mbar = valves.relax ? regulator_mbar : regulator_mbar - 200;
      if (source_mbar > close_mbar && !valves.supply_cut) {
        close_mbar += std::min((source_mbar - close_mbar + 9) / 10, 17);
      } else if (valves.relax && source_mbar < close_mbar) {
        close_mbar -= (close_mbar - source_mbar + 9) / 10;
      }
    }
    if (valves.spool == Spool::Open) {
      close_mbar -= (close_mbar + 9) / 10;
      open_mbar += (supply_mbar - open_mbar) / 10;
    } else {
      open_mbar -= (open_mbar + 19) / (valves.pre_vent ? 10 : 20);
    }
    close_mbar -= close_mbar * leak_permille / 1000;
  }
};

}  // namespace pinjaw::core::test

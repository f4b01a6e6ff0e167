#pragma once

#include <array>
#include <cstdint>

#include "firmware_sim/core/config.hpp"
#include "firmware_sim/core/io.hpp"

namespace pinjaw::core {

/// Squeeze as pressure tells it: the truth lies in [low, high], friction and sensor errors included.
struct Squeeze {
  std::int32_t measured_dn = 0;
  std::int32_t low_dn = 0;
  std::int32_t high_dn = 0;
  friend bool operator==(const Squeeze&, const Squeeze&) = default;
};

/// What is wrong with the sensors; the first that is found.
enum class SensorTrouble : std::uint8_t { None, PressureRange, Disagreement, Position };

/// Filtered sensors, and what a few milliseconds of them say.
struct Measurement {
  bool started = false;
  std::array<std::int32_t, 2> close_ubar{};  ///< filtered, per sensor
  std::int32_t open_ubar = 0;                ///< filtered mean of both
  Squeeze squeeze;
  std::int32_t separation_10um = 0;
  std::int32_t lagging_um = 0;     ///< separation as it was some 16 ms ago
  std::int32_t closing_mm_s = 0;   ///< speed at which the separation shrinks, over those ms
  std::int32_t still_at_10um = 0;  ///< where the jaws were when `still_ms` began
  std::uint16_t still_ms = 0;      ///< how long they have not moved
  std::uint16_t troubled_ms = 0;   ///< how long something has been wrong with the sensors
  SensorTrouble suspected = SensorTrouble::None;
  SensorTrouble trouble = SensorTrouble::None;  ///< `suspected`, after 3 ms (I5)
  std::uint16_t supply_low_ms = 0;
  bool supply_low = false;
  bool seated = false;       ///< every seat switch of a passive station is on
  bool seats_clear = false;  ///< every one is off
  bool local_enable = false;
  std::int32_t supply_mbar = 0;
};

/// How long something has been going on that had been for `ms` before this step; a minute stands for more,
/// and a step counts a second at most.
std::uint16_t counted(std::uint16_t ms, bool going_on, std::uint32_t elapsed_ms);

/// Takes in one step's readings.
void observe(const Config& config, const Sensors& sensors, std::uint32_t elapsed_ms,
             Measurement& measurement);

/// Squeeze that `close_ubar` would make with `open_ubar` behind it.
std::int32_t squeeze_dn(const Config& config, std::int32_t close_ubar, std::int32_t open_ubar);

/// Close pressure that makes `force_dn` with `open_mbar` behind it; at least 0.
std::int32_t pressure_mbar(const Config& config, std::int32_t force_dn, std::int32_t open_mbar);

}  // namespace pinjaw::core

#include "firmware_sim/core/measure.hpp"

#include <algorithm>

namespace pinjaw::core {
namespace {

constexpr std::int32_t kFilter_ms =
    8;  // chosen: 5 mbar of noise become 0.03 N; lag far under a ramp's 150 ms
constexpr std::int32_t kStill_10um = 3;      // chosen: over the sensor's step, under 0.1 mm
constexpr std::uint16_t kTrouble_ms = 3;     // I5
constexpr std::uint16_t kSupplyLow_ms = 50;  // chosen: a droop of a neighbour's move is not a loss
constexpr std::int32_t kPressureLeast_mbar = -700;
constexpr std::int32_t kPressureMost_mbar = 9900;  // the sensors' full scale is 10 bar
constexpr std::int32_t kOverTravel_10um = 200;

constexpr std::int32_t kSpeed_ms = 16;  // chosen: the sensor's step of 10 um is 0.6 mm/s

/// `step_ms`: kFilter_ms at most.
std::int32_t filtered(std::int32_t old_ubar, std::int32_t reading_mbar, std::int32_t step_ms) {
  return old_ubar + (reading_mbar * 1000 - old_ubar) / kFilter_ms * step_ms;
}

SensorTrouble trouble_of(const Config& config, const Sensors& sensors) {
  if (config.passive) return SensorTrouble::None;
  for (const std::int32_t reading_mbar :
       {sensors.close_mbar[0], sensors.close_mbar[1], sensors.open_mbar[0], sensors.open_mbar[1]}) {
    if (reading_mbar < kPressureLeast_mbar || reading_mbar > kPressureMost_mbar) {
      return SensorTrouble::PressureRange;
    }
  }
  for (const std::array<std::int32_t, 2>& pair_mbar : {sensors.close_mbar, sensors.open_mbar}) {
    const std::int32_t apart_mbar = pair_mbar[0] - pair_mbar[1];
    if (apart_mbar > config.sensor_disagreement_mbar || apart_mbar < -config.sensor_disagreement_mbar) {
      return SensorTrouble::Disagreement;
    }
  }
  if (sensors.separation_10um < config.separation_min_10um - kOverTravel_10um ||
      sensors.separation_10um > config.separation_max_10um + kOverTravel_10um) {
    return SensorTrouble::Position;
  }
  return SensorTrouble::None;
}

void observe_pressures(const Config& config, const Sensors& sensors, std::int32_t step_ms, Measurement& m) {
  const auto in_range = [](std::int32_t mbar) { return std::clamp<std::int32_t>(mbar, -1000, 20000); };
  const std::int32_t open_mbar = (in_range(sensors.open_mbar[0]) + in_range(sensors.open_mbar[1])) / 2;
  if (!m.started) {
    for (std::size_t i = 0; i < 2; ++i) m.close_ubar[i] = in_range(sensors.close_mbar[i]) * 1000;
    m.open_ubar = open_mbar * 1000;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    m.close_ubar[i] = filtered(m.close_ubar[i], in_range(sensors.close_mbar[i]), step_ms);
  }
  m.open_ubar = filtered(m.open_ubar, open_mbar, step_ms);
  m.squeeze.measured_dn = squeeze_dn(config, (m.close_ubar[0] + m.close_ubar[1]) / 2, m.open_ubar);
  m.squeeze.low_dn = m.squeeze.measured_dn - config.uncertainty_dn;
  m.squeeze.high_dn = m.squeeze.measured_dn + config.uncertainty_dn;
}

void observe_speed(std::int32_t elapsed_ms, Measurement& m) {
  const std::int32_t separation_um = m.separation_10um * 10;
  if (!m.started) m.lagging_um = separation_um;
  m.lagging_um += (separation_um - m.lagging_um) * elapsed_ms / kSpeed_ms;
  m.closing_mm_s = (m.lagging_um - separation_um) / kSpeed_ms;
}

}  // namespace

std::uint16_t counted(std::uint16_t ms, bool going_on, std::uint32_t elapsed_ms) {
  if (!going_on) return 0;
  return static_cast<std::uint16_t>(
      std::min<std::uint32_t>(ms + std::min<std::uint32_t>(elapsed_ms, 1000), 60000));
}

void observe(const Config& config, const Sensors& sensors, std::uint32_t elapsed_ms, Measurement& m) {
  observe_pressures(config, sensors,
                    static_cast<std::int32_t>(std::min<std::uint32_t>(elapsed_ms, kFilter_ms)), m);

  const std::int32_t moved_10um = sensors.separation_10um - m.still_at_10um;
  const bool still = m.started && moved_10um <= kStill_10um && moved_10um >= -kStill_10um;
  if (!still) m.still_at_10um = sensors.separation_10um;
  m.still_ms = counted(m.still_ms, still, elapsed_ms);
  m.separation_10um = sensors.separation_10um;
  observe_speed(static_cast<std::int32_t>(std::min<std::uint32_t>(elapsed_ms, kSpeed_ms)), m);

  const SensorTrouble trouble = trouble_of(config, sensors);
  m.troubled_ms = counted(m.troubled_ms, trouble != SensorTrouble::None, elapsed_ms);
  m.suspected = trouble;
  m.trouble = m.troubled_ms >= kTrouble_ms ? trouble : SensorTrouble::None;

  m.supply_mbar = sensors.supply_mbar;
  const bool low = !config.passive && sensors.supply_mbar < config.supply_low_mbar;
  m.supply_low_ms = counted(m.supply_low_ms, low, elapsed_ms);
  m.supply_low = m.supply_low_ms >= kSupplyLow_ms;

  m.seated = (sensors.seats & config.seat_switches) == config.seat_switches;
  m.seats_clear = (sensors.seats & config.seat_switches) == 0;
  m.local_enable = sensors.local_enable;
  m.started = true;
}

std::int32_t squeeze_dn(const Config& config, std::int32_t close_ubar, std::int32_t open_ubar) {
  const std::int64_t net_ubar =
      std::int64_t{close_ubar} - std::int64_t{open_ubar} * config.open_ratio_permille / 1000;
  const std::int64_t force_dn = net_ubar * config.area_udn_per_mbar / 1'000'000'000;
  return config.passive ? 0 : static_cast<std::int32_t>(force_dn) + config.spring_dn;
}

std::int32_t pressure_mbar(const Config& config, std::int32_t force_dn, std::int32_t open_mbar) {
  const std::int64_t net_mbar = std::int64_t{force_dn - config.spring_dn} * 1'000'000 /
                                std::max<std::int32_t>(config.area_udn_per_mbar, 1);
  const std::int64_t behind_mbar =
      std::int64_t{std::max<std::int32_t>(open_mbar, 0)} * config.open_ratio_permille / 1000;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(net_mbar + behind_mbar, 0, 20000));
}

}  // namespace pinjaw::core

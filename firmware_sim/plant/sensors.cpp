#include "firmware_sim/plant/sensors.hpp"

#include <algorithm>
#include <cmath>

#include "firmware_sim/plant/regulator.hpp"

namespace pinjaw::plant {
namespace {

constexpr double kPositionEnd_m = 0.010;  // chosen: a broken wire reads this far past fully open

double rounded_to(double value, double step) {
  return std::round(value / step) * step;
}

/// A reading of one pressure sensor: offset, noise, the converter's steps and range.
double sense_pa(const SensorParameters& sensors, double filtered_pa, double offset_pa, Noise& noise) {
  const double analog_pa = filtered_pa + offset_pa + sensors.pressure_noise_pa * noise.normal();
  return std::clamp(rounded_to(analog_pa, sensors.pressure_step_pa), -0.1 * sensors.pressure_range_pa,
                    sensors.pressure_range_pa);
}

double sense_position_m(const Parameters& parameters, const SensorFault& fault, const State& state) {
  const double open_m = parameters.jaw.max_separation_m;
  if (fault.lost) return open_m + kPositionEnd_m;
  const double sensed_m = open_m - 2 * state.sensed_position_m + fault.offset + state.position_drift_m;
  return rounded_to(sensed_m, parameters.sensors.position_step_m);
}

}  // namespace

void step_sensors(const Parameters& parameters, const Faults& faults, double dt_s, State& state) {
  const double close_pa = state.close_pa - kAtmosphere_Pa;
  const double open_pa = state.open_pa - kAtmosphere_Pa;
  const std::array<double, 4> pressures_pa = {close_pa, close_pa, open_pa, open_pa};
  const double share = std::min(1.0, dt_s / parameters.sensors.pressure_lag_s);
  for (std::size_t i = 0; i < pressures_pa.size(); ++i) {
    const SensorFault& fault = faults.pressure[i];
    state.sensor_drift_pa[i] += fault.drift_per_s * dt_s;
    if (!fault.stuck) state.sensed_pa[i] += (pressures_pa[i] - state.sensed_pa[i]) * share;
  }
  state.position_drift_m += faults.position.drift_per_s * dt_s;
  if (!faults.position.stuck) state.sensed_position_m = state.displacement_m;
}

Readings read(const Parameters& parameters, const Faults& faults, State& state) {
  const SensorParameters& sensors = parameters.sensors;
  std::array<double, 4> pressures_pa{};
  for (std::size_t i : {0U, 2U, 1U, 3U}) {
    const SensorFault& fault = faults.pressure.at(i);
    const double offset_pa = state.sensor_offset_pa.at(i) + fault.offset + state.sensor_drift_pa.at(i);
    const double sensed_pa = sense_pa(sensors, state.sensed_pa.at(i), offset_pa, state.noise);
    pressures_pa.at(i) = fault.lost ? sensors.pressure_range_pa : sensed_pa;
  }
  return {.close_pa = {pressures_pa[0], pressures_pa[1]},
          .open_pa = {pressures_pa[2], pressures_pa[3]},
          .supply_pa = sense_pa(sensors, supply_pa(state) - kAtmosphere_Pa, 0.0, state.noise),
          .separation_m = sense_position_m(parameters, faults.position, state)};
}

}  // namespace pinjaw::plant

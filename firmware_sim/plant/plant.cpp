#include "firmware_sim/plant/plant.hpp"

#include <algorithm>
#include <cmath>

#include "firmware_sim/plant/regulator.hpp"

namespace pinjaw::plant {
namespace {

/// The main spool follows its solenoids late, and the spring later.
void step_spool(const SpoolParameters& spool, const Inputs& inputs, double dt_s, State& state) {
  if (inputs.actuation.spool != state.spool_goal) {
    state.spool_goal = inputs.actuation.spool;
    state.spool_wait_s = state.spool_goal == Spool::Hold ? spool.off_delay_s : spool.on_delay_s;
  }
  state.spool_wait_s = std::max(0.0, state.spool_wait_s - dt_s);
  if (state.spool_wait_s <= 0.0 && !inputs.faults.spool_stuck) state.spool = state.spool_goal;
}

/// Mass flow into the close chamber, kg/s.
double close_flow(const AirParameters& air, const Inputs& inputs, const State& state) {
  double flow = -mass_flow(inputs.faults.close_leak, state.close_pa, kAtmosphere_Pa) -
                mass_flow(air.close_leak, state.close_pa, kAtmosphere_Pa);
  const double over_pa = state.close_pa - kAtmosphere_Pa - air.relief_pa;
  if (over_pa > 0.0) {
    Restriction relief = air.relief;
    relief.conductance_m3_s_pa *= std::min(1.0, over_pa / (air.relief_span * air.relief_pa));
    flow -= mass_flow(relief, state.close_pa, kAtmosphere_Pa);
  }
  if (state.spool == Spool::Open) flow -= mass_flow(air.relax, state.close_pa, kAtmosphere_Pa);
  if (state.spool != Spool::Close) return flow;

  const double outlet_pa = regulator_outlet_pa(inputs, state);
  const double cracking_pa = inputs.actuation.relax ? 0.0 : air.check_cracking_pa;
  if (outlet_pa - cracking_pa > state.close_pa) {
    if (!inputs.actuation.supply_cut) flow += mass_flow(air.fill, outlet_pa - cracking_pa, state.close_pa);
  } else if (inputs.actuation.relax) {
    flow -= mass_flow(air.relax, state.close_pa, std::min(outlet_pa, state.close_pa));
  }
  return flow;
}

/// Mass flow into the open chamber, kg/s.
double open_flow(const AirParameters& air, const Inputs& inputs, const State& state) {
  double flow = 0.0;
  if (state.spool == Spool::Open) {
    if (!inputs.actuation.supply_cut) flow += mass_flow(air.open_fill, supply_pa(state), state.open_pa);
  } else {
    flow -= mass_flow(air.meter_out, state.open_pa, kAtmosphere_Pa);
  }
  if (inputs.actuation.vent_open) flow -= mass_flow(air.relax, state.open_pa, kAtmosphere_Pa);
  return flow;
}

void step_chambers(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state) {
  const AirParameters& air = parameters.air;
  const double close_volume_m3 = air.dead_volume_m3 + air.close_area_m2 * state.displacement_m;
  const double open_volume_m3 =
      air.dead_volume_m3 + air.open_area_m2 * (parameters.jaw.stroke_m - state.displacement_m);
  const double into_close = close_flow(air, inputs, state);
  const double into_open = open_flow(air, inputs, state);
  constexpr double kGas = kAirConstant * kTemperature_K;
  state.close_pa += air.polytropic / close_volume_m3 * dt_s *
                    (kGas * into_close - state.close_pa * air.close_area_m2 * state.speed_m_s);
  state.open_pa += air.polytropic / open_volume_m3 * dt_s *
                   (kGas * into_open + state.open_pa * air.open_area_m2 * state.speed_m_s);
  state.mass_in_kg += (into_close + into_open) * dt_s;
}

/// Spring and damper that only push.
double push_n(double depth_m, double depth_rate_m_s, double stiffness_n_m, double damping_n_s_m) {
  if (depth_m <= 0.0) return 0.0;
  return std::max(0.0, stiffness_n_m * depth_m + damping_n_s_m * depth_rate_m_s);
}

/// Sets the true contact forces; each jaw has half of the pair's stiffness.
void press_part(const JawParameters& jaw, const Contact& contact, State& state) {
  state.left_n = 0.0;
  state.right_n = 0.0;
  if (!contact.present) return;
  const double depth_m = (contact.separation_m - jaw.max_separation_m) / 2 + state.displacement_m;
  const double offset_m = contact.fixed ? contact.offset_m : 0.0;
  const double stiffness = jaw.contact_n_m / 2;
  const double damping = jaw.contact_damping_n_s_m / 2;
  state.left_n = push_n(depth_m - offset_m, state.speed_m_s, stiffness, damping);
  state.right_n = push_n(depth_m + offset_m, state.speed_m_s, stiffness, damping);
}

/// Force of the end stops, positive towards closing.
double end_stop_n(const JawParameters& jaw, const State& state) {
  const double opened =
      push_n(-state.displacement_m, -state.speed_m_s, jaw.end_stop_n_m, jaw.end_stop_damping_n_s_m);
  const double closed = push_n(state.displacement_m - jaw.stroke_m, state.speed_m_s, jaw.end_stop_n_m,
                               jaw.end_stop_damping_n_s_m);
  return opened - closed;
}

void step_jaws(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state) {
  const AirParameters& air = parameters.air;
  press_part(parameters.jaw, inputs.contact, state);
  const double air_n = air.close_area_m2 * (state.close_pa - kAtmosphere_Pa) -
                       air.open_area_m2 * (state.open_pa - kAtmosphere_Pa) + air.spring_n;
  const double friction_n = friction_force_n(parameters.friction, state.speed_m_s, dt_s, state.friction);
  const double force_n = air_n - friction_n - squeeze_n(state) + end_stop_n(parameters.jaw, state);
  state.speed_m_s += force_n / parameters.jaw.moving_mass_kg * dt_s;
  state.displacement_m += state.speed_m_s * dt_s;
}

std::array<double, 4> true_pressures_pa(const State& state) {
  const double close_pa = state.close_pa - kAtmosphere_Pa;
  const double open_pa = state.open_pa - kAtmosphere_Pa;
  return {close_pa, close_pa, open_pa, open_pa};
}

void step_sensors(const SensorParameters& sensors, const Faults& faults, double dt_s, State& state) {
  const std::array<double, 4> pressures_pa = true_pressures_pa(state);
  for (std::size_t i = 0; i < pressures_pa.size(); ++i) {
    state.sensed_pa.at(i) += (pressures_pa.at(i) - state.sensed_pa.at(i)) * dt_s / sensors.pressure_lag_s;
  }
  if (!faults.position_stuck) state.sensed_position_m = state.displacement_m;
}

/// A reading of one pressure sensor: offset, noise, the converter's steps and range.
double sense_pa(const SensorParameters& sensors, double filtered_pa, double offset_pa, Noise& noise) {
  const double analog_pa = filtered_pa + offset_pa + sensors.pressure_noise_pa * noise.normal();
  const double stepped_pa = std::round(analog_pa / sensors.pressure_step_pa) * sensors.pressure_step_pa;
  return std::clamp(stepped_pa, -0.1 * sensors.pressure_range_pa, sensors.pressure_range_pa);
}

}  // namespace

State initial_state(const Parameters& parameters, std::uint64_t seed, double separation_m) {
  State state;
  state.noise.state = seed;
  state.regulator_gain_error = parameters.regulator.linearity * state.noise.symmetric();
  for (double& offset_pa : state.sensor_offset_pa) {
    offset_pa = parameters.sensors.pressure_offset_pa * state.noise.symmetric();
  }
  state.displacement_m = (parameters.jaw.max_separation_m - separation_m) / 2;
  state.sensed_position_m = state.displacement_m;
  state.supply_pa = kAtmosphere_Pa + parameters.supply.nominal_pa;
  return state;
}

void step(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state) {
  step_spool(parameters.spool, inputs, dt_s, state);
  step_regulator(parameters, inputs, dt_s, state);
  step_chambers(parameters, inputs, dt_s, state);
  step_jaws(parameters, inputs, dt_s, state);
  step_sensors(parameters.sensors, inputs.faults, dt_s, state);
}

double separation_m(const Parameters& parameters, const State& state) {
  return parameters.jaw.max_separation_m - 2 * state.displacement_m;
}

Readings read(const Parameters& parameters, const Faults& faults, State& state) {
  const SensorParameters& sensors = parameters.sensors;
  Readings readings;
  for (std::size_t i = 0; i < 2; ++i) {
    const double close_offset_pa = state.sensor_offset_pa.at(i) + faults.close_sensor_offset_pa.at(i);
    readings.close_pa.at(i) = sense_pa(sensors, state.sensed_pa.at(i), close_offset_pa, state.noise);
    readings.open_pa.at(i) =
        sense_pa(sensors, state.sensed_pa.at(i + 2), state.sensor_offset_pa.at(i + 2), state.noise);
  }
  readings.supply_pa = sense_pa(sensors, supply_pa(state) - kAtmosphere_Pa, 0.0, state.noise);
  const double sensed_m = parameters.jaw.max_separation_m - 2 * state.sensed_position_m;
  readings.separation_m = std::round(sensed_m / sensors.position_step_m) * sensors.position_step_m;
  return readings;
}

}  // namespace pinjaw::plant

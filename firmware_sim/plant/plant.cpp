#include "firmware_sim/plant/plant.hpp"

#include <algorithm>
#include <cmath>

#include "firmware_sim/plant/chambers.hpp"
#include "firmware_sim/plant/regulator.hpp"
#include "firmware_sim/plant/sensors.hpp"

namespace pinjaw::plant {
namespace {

constexpr double kRest_m_s = 1e-7;  // chosen: 0.1 um/s, a step of the position sensor in 100 s
constexpr double kRest_n = 2e-3;    // chosen: what the creep of the bristles leaves after a second

/// The main spool follows its solenoids late, and the spring later.
void step_spool(const SpoolParameters& spool, const Inputs& inputs, double dt_s, State& state) {
  if (inputs.actuation.spool != state.spool_goal) {
    state.spool_goal = inputs.actuation.spool;
    state.spool_wait_s = state.spool_goal == Spool::Hold ? spool.off_delay_s : spool.on_delay_s;
  }
  state.spool_wait_s = std::max(0.0, state.spool_wait_s - dt_s);
  const bool stuck = inputs.faults.spool_stuck || inputs.faults.spool_sticks_at == state.spool;
  if (state.spool_wait_s <= 0.0 && !stuck) state.spool = state.spool_goal;
}

/// Spring and damper that only push.
double push_n(double depth_m, double depth_rate_m_s, double stiffness_n_m, double damping_n_s_m) {
  if (depth_m <= 0.0) return 0.0;
  return std::max(0.0, stiffness_n_m * depth_m + damping_n_s_m * depth_rate_m_s);
}

/// Contact force on each jaw, left then right; each has half of the pair's stiffness.
std::array<double, 2> contact_n(const JawParameters& jaw, const Contact& contact, const State& state) {
  if (!contact.present) return {0.0, 0.0};
  const double depth_m = (contact.separation_m - jaw.max_separation_m) / 2 + state.displacement_m;
  const double offset_m = contact.fixed ? contact.offset_m : 0.0;
  const double stiffness = jaw.contact_n_m / 2;
  const double damping = jaw.contact_damping_n_s_m / 2;
  return {push_n(depth_m - offset_m, state.speed_m_s, stiffness, damping),
          push_n(depth_m + offset_m, state.speed_m_s, stiffness, damping)};
}

void press_part(const JawParameters& jaw, const Contact& contact, State& state) {
  const auto [left_n, right_n] = contact_n(jaw, contact, state);
  state.left_n = left_n;
  state.right_n = right_n;
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
  press_part(parameters.jaw, inputs.contact, state);
  const double friction_n = friction_force_n(parameters.friction, state.speed_m_s, dt_s, state.friction);
  const double stops_n = squeeze_n(state) - end_stop_n(parameters.jaw, state);
  const double force_n = air_force_n(parameters, state) - friction_n - stops_n;
  state.speed_m_s += force_n / parameters.jaw.moving_mass_kg * dt_s;
  const double stroke_m = state.speed_m_s * dt_s;
  state.displacement_m += stroke_m;
  state.ledger.friction_j += friction_n * stroke_m;
  state.ledger.stops_j += stops_n * stroke_m;
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
  const double from_m = state.displacement_m;
  step_jaws(parameters, inputs, dt_s, state);
  take_stroke(parameters, from_m, state);
  step_sensors(parameters, inputs.faults, dt_s, state);
}

bool at_rest(const Parameters& parameters, const Inputs& inputs, const State& state) {
  const bool spool_rests = state.spool_goal == Spool::Hold && inputs.actuation.spool == Spool::Hold;
  if (!spool_rests || std::abs(state.speed_m_s) > kRest_m_s || !shut_in(parameters, inputs, state)) {
    return false;
  }
  // The contact may have changed under jaws that stood still.
  const auto [left_n, right_n] = contact_n(parameters.jaw, inputs.contact, state);
  const double net_n = air_force_n(parameters, state) - left_n - right_n + end_stop_n(parameters.jaw, state) -
                       parameters.friction.bristle_n_m * state.friction.bristle_m;
  return std::abs(net_n) < kRest_n;
}

void coast(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state) {
  step_spool(parameters.spool, inputs, dt_s, state);
  step_regulator(parameters, inputs, dt_s, state);
  state.speed_m_s = 0;
  press_part(parameters.jaw, inputs.contact, state);
  state.friction.rest_s += dt_s;
  step_sensors(parameters, inputs.faults, dt_s, state);
}

double separation_m(const Parameters& parameters, const State& state) {
  return parameters.jaw.max_separation_m - 2 * state.displacement_m;
}

}  // namespace pinjaw::plant

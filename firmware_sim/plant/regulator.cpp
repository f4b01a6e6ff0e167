#include "firmware_sim/plant/regulator.hpp"

#include <algorithm>
#include <cmath>

namespace pinjaw::plant {
namespace {

constexpr double kHistoryStep_s = 0.001;  // the dead time is kept in whole ms

/// Set point of `delay_s` ago.
double delayed_set_pa(const RegulatorParameters& regulator, double set_pa, double dt_s, State& state) {
  state.set_age_s += dt_s;
  if (state.set_age_s >= kHistoryStep_s) {
    state.set_age_s -= kHistoryStep_s;
    state.set_newest = (state.set_newest + 1) % state.set_history_pa.size();
  }
  state.set_history_pa.at(state.set_newest) = set_pa;
  const std::size_t size = state.set_history_pa.size();
  const auto back =
      std::min(size - 1, static_cast<std::size_t>(std::lround(regulator.delay_s / kHistoryStep_s)));
  return state.set_history_pa.at((state.set_newest + size - back) % size);
}

void step_supply(const SupplyParameters& supply, const Inputs& inputs, double dt_s, State& state) {
  if (inputs.faults.supply_lost) {
    state.supply_pa += (kAtmosphere_Pa - state.supply_pa) * dt_s / supply.loss_lag_s;
  } else {
    state.supply_pa += (kAtmosphere_Pa + supply.nominal_pa - state.supply_pa) * dt_s / supply.droop_lag_s;
  }
  const double droop_pa = inputs.neighbour_moves ? supply.droop_pa : 0.0;
  state.droop_pa += (droop_pa - state.droop_pa) * dt_s / supply.droop_lag_s;
}

}  // namespace

void step_regulator(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state) {
  step_supply(parameters.supply, inputs, dt_s, state);
  const RegulatorParameters& regulator = parameters.regulator;
  const double told_pa = std::clamp(inputs.actuation.close_set_pa, 0.0, regulator.full_scale_pa);
  const double stepped_pa = std::round(told_pa / regulator.resolution_pa) * regulator.resolution_pa;
  const double set_pa = delayed_set_pa(regulator, stepped_pa, dt_s, state);
  if (std::abs(set_pa - state.followed_set_pa) > regulator.hysteresis_pa) {
    const double side = set_pa > state.followed_set_pa ? -1.0 : 1.0;
    state.followed_set_pa = set_pa + side * regulator.hysteresis_pa;
  }
  if (set_pa <= 0.0) state.followed_set_pa = 0.0;
  if (inputs.faults.regulator == RegulatorFault::Stuck) return;
  const double goal_pa = state.followed_set_pa * (1.0 + state.regulator_gain_error);
  state.regulator_inner_pa += (goal_pa - state.regulator_inner_pa) * dt_s / regulator.first_lag_s;
  state.regulator_pa += (state.regulator_inner_pa - state.regulator_pa) * dt_s / regulator.second_lag_s;
}

double supply_pa(const State& state) {
  return std::max(kAtmosphere_Pa, state.supply_pa - state.droop_pa);
}

double regulator_outlet_pa(const Inputs& inputs, const State& state) {
  const double reached_pa = supply_pa(state);
  if (inputs.faults.regulator == RegulatorFault::Open) return reached_pa;
  if (inputs.faults.regulator == RegulatorFault::Closed) return kAtmosphere_Pa;
  return std::min(reached_pa, kAtmosphere_Pa + state.regulator_pa);
}

}  // namespace pinjaw::plant

#pragma once

#include "firmware_sim/plant/plant.hpp"

namespace pinjaw::plant {

/// Advances the supply and the proportional regulator by `dt_s`; the outlet is then `regulator_outlet_pa`.
void step_regulator(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state);

/// Absolute pressure behind the regulator: what it was told, as far as the supply reaches.
double regulator_outlet_pa(const Inputs& inputs, const State& state);

/// Absolute pressure of the supply, after droop.
double supply_pa(const State& state);

}  // namespace pinjaw::plant

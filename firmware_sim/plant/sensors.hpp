#pragma once

#include "firmware_sim/plant/plant.hpp"

namespace pinjaw::plant {

/// Lets the sensors' filters follow, and what drifts drift, for `dt_s`.
void step_sensors(const Parameters& parameters, const Faults& faults, double dt_s, State& state);

}  // namespace pinjaw::plant

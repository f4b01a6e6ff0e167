#pragma once

#include "firmware_sim/plant/plant.hpp"

/// The air in the two cylinder chambers: what flows, and what it does to pressure and temperature.
namespace pinjaw::plant {

/// What the valves do: what they were told, less what sticks.
Actuation actual_valves(const Inputs& inputs);

/// Lets air flow through the ports for `dt_s`, with the jaws where they are. The polytropic law also takes in
/// the jaws' speed; the energy balance waits for `take_stroke`.
void step_chambers(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state);

/// Books the stroke since `from_m`: with the energy balance the air pays for the work that it did.
void take_stroke(const Parameters& parameters, double from_m, State& state);

/// Force of the air on the jaws, towards closing, and of the keeper where it is engaged.
double air_force_n(const Parameters& parameters, const State& state);

double close_volume_m3(const Parameters& parameters, const State& state);
double open_volume_m3(const Parameters& parameters, const State& state);

/// No port of either chamber passes air, and the air is as warm as the walls.
bool shut_in(const Parameters& parameters, const Inputs& inputs, const State& state);

}  // namespace pinjaw::plant

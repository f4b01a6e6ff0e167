#pragma once

#include "firmware_sim/core/config.hpp"
#include "firmware_sim/core/io.hpp"
#include "firmware_sim/core/state.hpp"

/// The controller's firmware: a pure function of its state and inputs, stepped every millisecond.
///
/// It holds no clock, no heap and no hardware: whoever steps it reads sensors and frames before, and carries
/// out valves, frames and non-volatile writes after. The state is a plain value; a copy is a snapshot.
///
///     State state = power_on(config, image_from_memory);
///     each ms: Outputs outputs = step(state, {.elapsed_ms = 1, .received = frames, .sensors = ..., .nvm =
///     ...});
namespace pinjaw::core {

/// State after a reset; the valves stay de-energised until the first steps have looked at sensors and record.
/// With a custody record the controller comes up holding, never open.
State power_on(const Config& config, const NvmImage& image);
/// The same in place, for who has no stack to spare. `state` is one as its default makes it.
void power_on(const Config& config, const NvmImage& image, State& state);

/// One step. Equal state and inputs give equal outputs and next state.
Outputs step(State& state, const Inputs& inputs);
/// The same in place: `outputs` is overwritten, but for frames beyond its size.
void step(State& state, const Inputs& inputs, Outputs& outputs);

}  // namespace pinjaw::core

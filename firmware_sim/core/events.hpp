#pragma once

#include <optional>

#include "firmware_sim/core/state.hpp"

/// What sensors, timers and the bus amount to.
namespace pinjaw::core {

/// Lets the conditions age on which events depend: how long a hold is stable, a peer good, a hold too weak;
/// and sets or clears the faults that are conditions.
void track(State& state, std::uint16_t elapsed_ms);

/// The most urgent thing that the present state has to react to, if any. Pure.
std::optional<Event> next_event(const State& state);

}  // namespace pinjaw::core

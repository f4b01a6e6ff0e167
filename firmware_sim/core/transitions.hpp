#pragma once

#include "firmware_sim/core/state.hpp"

namespace pinjaw::core {

inline constexpr std::uint16_t kPeerGood_ms = 60;  // three cycles of 20 ms

/// What the table makes of `event` in the present state, done: the change of state with its actions, or the
/// note of an event that changes none. False where the table ignores or refuses it; then nothing but a
/// counter changes.
bool apply(State& state, Event event);

/// Sets a fault; None is none. One for which the node must hold ends the session.
void raise(State& state, wire::FaultCode code);

/// Closes the session: whatever is dangerous needs a new ARM.
void end_session(State& state);

}  // namespace pinjaw::core

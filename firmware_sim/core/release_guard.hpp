#pragma once

#include "firmware_sim/core/state.hpp"

namespace pinjaw::core {

/// The gate before the opening valve: opens only what both the state machine and this permit. It looks at the
/// stored custody record and not at the state: with a part of its own, a node opens only once its decision is
/// safely stored.
bool release_permitted(const State& state);

/// `wanted` without any opening that is not permitted.
Valves release_guarded(const State& state, const Valves& wanted);

}  // namespace pinjaw::core

#pragma once

#include "firmware_sim/core/state.hpp"

namespace pinjaw::core {

/// Sends what a node says by itself: STATE, FORCE, CUSTODY, PNEU, LAYSTAT, IDENT on time, CUSTODY and FAULT
/// on change too (docs/reliability.md 2.3). `said_before` is the fact announced when the step began.
void report(State& state, std::uint16_t elapsed_ms, const Valves& valves, const Announcement& said_before,
            SendQueue& queue);

}  // namespace pinjaw::core

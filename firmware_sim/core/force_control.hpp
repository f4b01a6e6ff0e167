#pragma once

#include <cstdint>

#include "firmware_sim/core/state.hpp"

/// The pressure loop (docs/reliability.md 3, Control): pre-vent, approach at F_light, ramp at 0.5
/// N/ms with feed-forward and a slow integral, hold with a dead band and the check valve shut.
namespace pinjaw::core {

/// F_set of the present state: 0 where nothing is to be squeezed. F_set + u never exceeds F_lim_eff (I1).
std::int32_t force_set_dn(const State& state);

/// What the state machine wants of the valves in this step, before the guards.
Valves wanted_valves(State& state, std::uint32_t elapsed_ms);

}  // namespace pinjaw::core

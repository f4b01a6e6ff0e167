#include "tests/fuzz/invariants.hpp"

#include <algorithm>
#include <string>

#include "firmware_sim/core/custody.hpp"
#include "firmware_sim/core/force_control.hpp"
#include "firmware_sim/core/guards.hpp"
#include "protocol/wire/names.hpp"
#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {

void keeps_its_invariants(const core::test::Station& station) {
  const core::State& state = station.core;
  must(static_cast<std::size_t>(state.id) < core::kStates, "no state");
  const core::Custody custody = state.store.record.custody;
  if (station.outputs.valves.spool == core::Spool::Open) {
    const bool decided = custody == core::Custody::Decided && station.memory.record &&
                         station.memory.record->custody == core::Custody::Decided;
    must(decided || !core::has_custody(custody),
         std::string("opens with a part of its own, in ") + wire::to_string(state.id));
    must(!core::holds(state.id), "opens in a state that holds");
  }
  const std::int32_t limit_dn = core::force_limit_dn(state);
  const std::int32_t wanted_dn = core::force_set_dn(state);
  must(wanted_dn + state.config.uncertainty_dn <= std::max(limit_dn, state.config.uncertainty_dn),
       "asks for a force over its limit");
  must(limit_dn <= state.config.hardware_limit_dn, "a limit over the hardware's");
  must(station.outputs.send.size <= core::SendQueue::kCapacity, "more frames than there is room for");
}

}  // namespace pinjaw::fuzz

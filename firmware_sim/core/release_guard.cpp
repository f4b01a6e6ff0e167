#include "firmware_sim/core/release_guard.hpp"

namespace pinjaw::core {

bool release_permitted(const State& state) {
  switch (state.store.record.custody) {
    case Custody::Empty:
    case Custody::Released:
      return true;
    case Custody::Decided:
      return state.store.durable();
    default:
      return false;
  }
}

Valves release_guarded(const State& state, const Valves& wanted) {
  return wanted.spool == Spool::Open && !release_permitted(state) ? Valves{} : wanted;
}

}  // namespace pinjaw::core

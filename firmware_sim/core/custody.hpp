#pragma once

#include <optional>

#include "firmware_sim/core/state.hpp"

/// The custody record and what is said of it (docs/reliability.md 2.5). The order is everywhere the
/// same: first the record is stored, then the bus hears the fact, then the valves follow.
namespace pinjaw::core {

/// The record, for a change that is to be stored with this step. Changed in its place: a copy is an eighth of
/// a controller's stack.
NvmRecord& to_store(Store& store);

/// Takes in how far storing has come.
void acknowledge(Store& store, const NvmStatus& status);

/// Puts into `write` what must be stored now, if anything; to be called once a step.
void flush(Store& store, const wire::Layout& committed, std::optional<NvmWrite>& write);

/// Says the fact that the record now stands for, if it may be said: a fact is announced only when its record
/// is safe, and TAKE and RETAIN only once the own hold was good (R2, R5).
void announce(State& state);

/// `token` was given by `giver` later than every one accepted before (R8; compared in a half window, R7).
bool token_is_new(const NvmRecord& record, std::uint8_t giver, std::uint16_t token);

/// Remembers the token of an accepted offer (R8).
void remember_token(NvmRecord& record, std::uint8_t giver, std::uint16_t token);

/// The record says that a part is, or may be, in the jaws.
constexpr bool has_custody(Custody custody) {
  return custody != Custody::Empty && custody != Custody::Released;
}

}  // namespace pinjaw::core

#include "tests/firmware_sim/model_check/state_set.hpp"

namespace pinjaw::core::model {
namespace {

/// Murmur3's finaliser over both words.
std::uint64_t hash_of(const Global& state) {
  std::uint64_t h =
      state.nodes * 0x9E3779B97F4A7C15U ^ (state.said + 0x7F4A7C159E3779B9U) * 0xC2B2AE3D27D4EB4FU;
  h ^= h >> 33;
  h *= 0xFF51AFD7ED558CCDU;
  h ^= h >> 33;
  h *= 0xC4CEB9FE1A85EC53U;
  return h ^ h >> 33;
}

}  // namespace

std::size_t StateSet::slot_of(const Global& state) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = hash_of(state) & mask;
  while (table_[slot] != kNone && !(states_[table_[slot]] == state)) slot = (slot + 1) & mask;
  return slot;
}

void StateSet::grow() {
  table_.assign(table_.size() * 2, kNone);
  for (std::uint32_t number = 0; number < states_.size(); ++number) table_[slot_of(states_[number])] = number;
}

StateSet::Place StateSet::insert(const Global& state, std::uint32_t parent) {
  const std::size_t slot = slot_of(state);
  if (table_[slot] != kNone) return {table_[slot], false};
  const auto number = static_cast<std::uint32_t>(states_.size());
  table_[slot] = number;
  states_.push_back(state);
  parents_.push_back(parent);
  if (3 * states_.size() > 2 * table_.size()) grow();
  return {number, true};
}

std::uint32_t StateSet::find(const Global& state) const {
  return table_[slot_of(state)];
}

}  // namespace pinjaw::core::model

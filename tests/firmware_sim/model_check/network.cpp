#include "tests/firmware_sim/model_check/network.hpp"

#include <stdexcept>

#include "tests/firmware_sim/model_check/layouts.hpp"
#include "tests/firmware_sim/model_check/words.hpp"

namespace pinjaw::core::model {
namespace {

bool is_of_handoff(wire::Fact fact) {
  return fact == wire::Fact::Offer || fact == wire::Fact::Take || fact == wire::Fact::Released ||
         fact == wire::Fact::Retain;
}

/// F_LOW is no part of a fact.
bool same_fact(const wire::Custody& one, const wire::Custody& other) {
  return one.fact == other.fact && one.peer == other.peer && one.token == other.token &&
         one.pair == other.pair && one.past() == other.past();
}

}  // namespace

int Network::add(const Saying& saying) {
  if (sayings_.size() == 64) throw std::length_error("more than 64 different frames");
  const auto bit = static_cast<int>(sayings_.size());
  sayings_.push_back(saying);
  if (!saying.holds_well && saying.custody.fact == wire::Fact::Take) takes_ |= Said{1} << bit;
  if (saying.holds_well) {
    holding_[saying.node] = Said{1} << bit;
  } else {
    for (std::uint8_t node = 1; node <= kMostNodes; ++node) {
      if (node != saying.node) facts_for_[node] |= Said{1} << bit;
    }
  }
  return bit;
}

std::optional<int> Network::heard(std::uint8_t node, const wire::Custody& custody) {
  if (!is_of_handoff(custody.fact)) return std::nullopt;
  for (std::size_t i = 0; i < sayings_.size(); ++i) {
    const Saying& known = sayings_[i];
    if (!known.holds_well && known.node == node && same_fact(known.custody, custody))
      return static_cast<int>(i);
  }
  return add({.node = node, .custody = custody});
}

std::optional<int> Network::heard(std::uint8_t node, const wire::NodeState& state) {
  const bool holds_well = state.state == wire::State::Taken && state.hold_stable;
  if (!holds_well) return std::nullopt;
  for (std::size_t i = 0; i < sayings_.size(); ++i) {
    if (sayings_[i].holds_well && sayings_[i].node == node) return static_cast<int>(i);
  }
  return add({.node = node, .holds_well = true, .state = state});
}

Said Network::released(std::uint8_t giver, std::uint8_t receiver, std::uint16_t token) const {
  for (std::size_t i = 0; i < sayings_.size(); ++i) {
    const Saying& known = sayings_[i];
    if (!known.holds_well && known.node == giver && known.custody.fact == wire::Fact::Released &&
        known.custody.peer == receiver && known.custody.token == token)
      return Said{1} << i;
  }
  return 0;
}

std::string Network::name(int bit) const {
  const Saying& saying = at(bit);
  if (saying.holds_well) return station(saying.node) + "'s STATE: TAKEN, holds well";
  return station(saying.node) + (saying.custody.past() ? "'s past " : "'s ") +
         fact_name(saying.custody.fact) + "(" + std::to_string(saying.custody.token) + ") to " +
         station(saying.custody.peer);
}

}  // namespace pinjaw::core::model

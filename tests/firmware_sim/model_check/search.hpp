#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/firmware_sim/model_check/node_model.hpp"

/// Breadth-first search over all nodes, their memories and jaws and the network, with an exact set of visited
/// states.
namespace pinjaw::core::model {

/// What must never be; as bits.
enum Invariant : std::uint8_t {
  kHeld = 1,          ///< I2: some node grips with F_req and answers for the part
  kOneCustodian = 2,  ///< I2b, of what is stored and of what the cores believe
  kOpensDecided = 4,  ///< R6: no opening valve without a stored decision, or with a part of the node's own
  kTakesLatched = 8,  ///< R1: no TAKE without its stored latch
  kWayBack = 16,      ///< I2c: a quiescent state can be reached without further mishap
  kAllInvariants = 31,
  kGripped = 32,  ///< what is left of I2 where the first channel is mistaken: some jaws grip, whoever answers
};

std::string name_of(Invariant invariant);

struct Scenario {
  std::vector<std::uint8_t> nodes{kArm, kPedestal};
  std::uint8_t loaded = kArm;  ///< it has the part in the beginning
  std::uint16_t tokens = 1;    ///< offers of each node
  bool release_guard = true;
  const StateTable* table = &kStateTable;
  std::uint8_t misfit = 0;  ///< a node whose committed layout is that of another part: its grip holds nothing
  std::vector<Saying> history{};  ///< frames said before, of handoffs long over
};

struct Bounds {
  std::size_t most_states = 4'000'000;
  std::uint8_t invariants = kAllInvariants;
  bool merge_equals = false;  ///< equal states of a node count as one: pays where the search is long
  bool progress = false;      ///< a line on stderr now and then
};

struct Violation {
  Invariant invariant{};
  std::string trace;  ///< the shortest way to it, a line a step
};

struct Findings {
  std::optional<Violation> violation;
  bool complete = false;  ///< nothing was left out for `most_states`
  std::size_t states = 0;
  std::uint64_t transitions = 0;
  std::size_t resting = 0;               ///< quiescent states
  std::size_t node_states = 0;           ///< different states of single nodes
  std::size_t distinct_node_states = 0;  ///< of these, where equals count as one
  std::uint64_t steps = 0;               ///< calls of core::step()
  double cpu_s = 0;
  std::size_t memory_bytes = 0;  ///< of states, parents and the set
};

Findings search(const Scenario& scenario, const Bounds& bounds);

}  // namespace pinjaw::core::model

#pragma once

#include <memory>
#include <vector>

#include "tests/firmware_sim/model_check/node_model.hpp"

/// Fewer states of a node to search, without leaving anything out: those that neither an invariant nor any
/// other node could ever tell apart count as one.
namespace pinjaw::core::model {

/// Works out each automaton under every frame that any of them may ever say, in every state.
void work_out_all(const std::vector<std::unique_ptr<NodeModel>>& models, const Network& network);

/// For each state of `model`, which `work_out_all` knows whole, the first that is equal to it: the same in
/// what the invariants ask, and with a move to an equal state, saying the same, for each move of the other. A
/// move that leads to an equal state in silence is none. It is the coarsest such partition, by refinement
/// (Kanellakis and Smolka, 1990).
std::vector<LocalId> first_equals(NodeModel& model, const Network& network);

}  // namespace pinjaw::core::model

#pragma once

#include <cstdint>
#include <vector>

#include "host/cell/pairs.hpp"

namespace pinjaw::cell {

/// The stations of a cell as a tree of handoffs: a star (arm between pallet and pedestal) or a chain.
struct HandoffTree {
  struct Link {
    std::size_t near = 0;  ///< station nearer the root
    std::size_t far = 0;
    std::size_t handoff = 0;  ///< its place among the cell's handoffs
  };
  std::size_t root = 0;
  std::vector<Link> links;  ///< each station is reached before it is left
};

/// A handoff between two stations, by their places in the cell.
struct StationPair {
  std::size_t giver = 0;
  std::size_t receiver = 0;
};

enum class TreeFault {
  None,
  NotConnected,  ///< some station takes part in no handoff, or not with the others
  Cycle,         ///< handoffs form a ring, or one is listed twice
};

/// Orders the handoffs from the station of most handoffs outwards (of equals the last of those in `first`),
/// the stations in `first` as early as may be.
struct TreeOutcome {
  TreeFault fault = TreeFault::None;
  HandoffTree tree;
};
TreeOutcome handoff_tree(std::size_t stations, const std::vector<StationPair>& handoffs,
                         const std::vector<std::size_t>& first);

/// One design, in one stance, for each station of the cell.
struct Choice {
  std::vector<Partner> stations;  ///< in the cell's order
  double score_n = 0;             ///< larger squeeze of the stations that grip
};

/// What the join works on; all by reference, kept by the caller.
struct JoinInput {
  const std::vector<StationSetups>* stations = nullptr;
  const HandoffTree* tree = nullptr;
  const std::vector<Partners>* partners = nullptr;  ///< one for each link
  References references;
};

struct JoinResult {
  std::int64_t count =
      0;  ///< all choices in which every handoff is possible and one place of the part suits all
  std::vector<Choice> best;  ///< smallest score first, then by the designs' order in their stations
};

/// Joins pairs into designs for the whole cell (BB 4.1) without holding them: a choice counts once, in
/// however many stances it is possible, and is listed in those that move pins least. Counted by product where
/// stations do not depend on each other, the best `top` by a bounded search.
JoinResult join(const JoinInput& input, std::size_t top);

}  // namespace pinjaw::cell

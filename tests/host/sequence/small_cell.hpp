#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/cell/cell_plan.hpp"
#include "host/model/sequence.hpp"
#include "host/planner/plan/scene.hpp"
#include "host/sequence/run.hpp"

/// A block handed from pallet to arm to pedestal: a cell small enough to be planned in the tests, and runs of
/// it with real controllers on the in-process bus.
namespace pinjaw::sequence::testing {

struct SmallCell {
  model::Cell cell;
  planner::Scene scene;
  cell::CellDesign design;  ///< the best
};

/// Read and planned once a program.
const SmallCell& small_cell();

/// Both sides of the block are sprayed, between handoffs to and fro: every kind of step.
model::Sequence cleaning();

/// What may be different in a run.
struct Conditions {
  std::uint64_t seed = 1;
  double controller_limit_n = 140;  ///< of the arm's hardware
};

struct Played {
  RunReport report;
  std::optional<Trouble> trouble;
  std::string log;  ///< candump's format
  std::string json;
};

/// Plays a sequence of the small cell in virtual time.
Played play(const model::Sequence& sequence, const Conditions& conditions = {});

}  // namespace pinjaw::sequence::testing

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/planner/plan/plan.hpp"

/// What came nearest to being a design in each phase, and by how much it failed.
namespace pinjaw::planner {

enum class Unit { Millimetre, Newton, Ratio };

/// The nearest of all that a phase left out for one reason, in the terms of the test it failed.
struct NearMiss {
  std::string phase;       ///< features, planar, heights, loading or force
  std::string reason;      ///< as in the plan's losses
  std::int64_t count = 0;  ///< how many were left out for it
  std::string quantity;    ///< what was tested: "pin radius"
  Unit unit = Unit::Millimetre;
  /// Nothing where no value of this quantity alone would let one through.
  struct Gap {
    double has = 0;
    double needs = 0;  ///< the limit: at least where it is above `has`, at most where it is below
  };
  std::optional<Gap> gap{};
  std::string where{};  ///< the pins or features concerned; may be empty
};

/// The nearest misses of every phase of `plan` (made from `task` in `scene` with `options`), in the order of
/// the phases. Features are told of only where none is left, planar fixtures where none was found. What is
/// tested of a part is exact; limits found by halving are good to a thousandth of their quantity. Stopped by
/// `options.stop`: those found so far.
std::vector<NearMiss> nearest_misses(const model::Task& task, const Scene& scene, const Plan& plan,
                                     const PlanOptions& options, const ProgressSink& progress = {});

}  // namespace pinjaw::planner

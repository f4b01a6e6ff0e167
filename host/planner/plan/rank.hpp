#pragma once

#include <cstddef>

#include "host/planner/plan/plan.hpp"
#include "host/planner/robust/robust.hpp"

namespace pinjaw::planner {

/// The case that robust_at() and robust_of() take, kept alive with what it refers to.
struct RobustScene {
  RobustScene(const Plan& plan, const Scene& scene, const model::Ranges& ranges);
  RobustScene(const RobustScene&) = delete;
  RobustScene& operator=(const RobustScene&) = delete;

  std::vector<model::Feature> features;
  std::vector<model::Wrench> wrenches;
  RobustCase of;
};

enum class Rank {
  Nominal,  ///< smallest required squeeze first
  Robust,   ///< smallest worst squeeze over the ranges first
};

struct RobustOptions {
  std::size_t count = 10;  ///< designs that tell how robust they are
  Rank rank = Rank::Nominal;
  std::size_t top = 0;  ///< designs kept in the plan; 0 keeps all
};

/// Tells of the first `count` designs how robust they are. With Rank::Robust those are the designs with the
/// least worst squeeze of all in the plan, and they move to its front: since no worst squeeze is under the
/// nominal one, the designs are worked through in nominal order only until that passes the count-th least
/// worst found. Precondition: the designs come smallest required squeeze first. The result does not depend on
/// the number of threads.
void tell_robustness(Plan& plan, const Scene& scene, const model::Ranges& ranges,
                     const RobustOptions& options, const ProgressSink& progress = {});

}  // namespace pinjaw::planner

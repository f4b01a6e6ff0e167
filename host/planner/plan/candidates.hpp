#pragma once

#include <vector>

#include "host/model/design.hpp"
#include "host/planner/plan/plan.hpp"
#include "host/planner/plan/scene.hpp"

namespace pinjaw::planner {

/// What phases 1 to 4 leave: designs that are geometrically sound, without squeeze and id.
struct Candidates {
  std::vector<model::Design> designs;
  Funnel funnel;  ///< features, planar, heights and loadable
  Losses losses;
};

/// Phases 1 to 4 for the pins of `task`'s kit on its part.
base::Expected<Candidates> find_candidates(const model::Task& task, const Scene& scene,
                                           const PlanOptions& options, const ProgressSink& progress);

}  // namespace pinjaw::planner

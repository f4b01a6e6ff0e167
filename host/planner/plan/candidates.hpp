#pragma once

#include <functional>
#include <vector>

#include "host/model/design.hpp"
#include "host/planner/plan/plan.hpp"
#include "host/planner/plan/scene.hpp"

namespace pinjaw::planner {

/// How many fixtures phases 1 to 4 leave, and how the others were lost.
struct CandidateCounts {
  Funnel funnel;  ///< features, planar, heights and loadable
  Losses losses;
};

/// Takes designs that are geometrically sound, without squeeze and id.
using CandidateSink = std::function<void(std::vector<model::Design>)>;

/// Phases 1 to 4 for the pins of `task`'s kit on its part. Designs go to `take` in the order of their planar
/// fixtures, some thousands at a time, from the calling thread, so that no more than these are held at once.
base::Expected<CandidateCounts> find_candidates(const model::Task& task, const Scene& scene,
                                                const PlanOptions& options, const ProgressSink& progress,
                                                const CandidateSink& take);

}  // namespace pinjaw::planner

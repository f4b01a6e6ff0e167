#pragma once

#include <vector>

#include "host/planner/heights/heights.hpp"
#include "host/planner/loading/loading.hpp"
#include "host/planner/plan/plan.hpp"

/// What phases 3 and 4 leave out, kept so that it can be asked why. Private to the search for near misses.
namespace pinjaw::planner {

/// A fixture without heights.
struct LostStanding {
  PlanarFixture fixture;
  HeightLoss reason = HeightLoss::NoEngagement;  ///< of its first pin that has none
};

/// A fixture with heights that does not load.
struct LostLoading {
  PlanarFixture fixture;
  std::array<PinToLoad, 4> pins;
  LoadingLoss reason = LoadingLoss::NoShift;
};

/// Where every planar fixture went.
struct Sorted {
  std::vector<LostStanding> not_standing;
  std::vector<LostLoading> not_loading;
  std::vector<model::Design> loading;  ///< named; without squeeze
};

/// What the pins must not touch, with the solids it speaks of.
struct Around {
  std::vector<geometry::Surface> others;
  double plate_top_mm = 0;
};
Around around(const model::Kit& kit, const Scene& scene);

LoadingOptions loading_options(const PlanOptions& options);

/// Phase 2 as a plan runs it.
std::vector<PlanarFixture> planar_fixtures(const std::vector<model::Feature>& features, const model::Kit& kit,
                                           const Scene& scene, const PlanOptions& options);

/// The features that its pins touch, in words.
std::string feet_of(const PlanarFixture& fixture);

/// Phases 1 to 4 once more, keeping what they lose.
Sorted sorted_fixtures(const model::Task& task, const Scene& scene, const PlanOptions& options,
                       const ProgressSink& progress);

}  // namespace pinjaw::planner

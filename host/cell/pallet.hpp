#pragma once

#include <array>
#include <vector>

#include "host/planner/plan/plan.hpp"
#include "host/planner/planar/planar_fixture.hpp"

namespace pinjaw::cell {

/// A planar fixture of three pins on one jaw and one on the other, of which the three stay: half a vise.
struct PalletFixture {
  planner::PlanarFixture fixture;
  std::array<std::size_t, 3> pins{};  ///< places of the three in the fixture's pins
};

/// The different pallets among planar fixtures: each set of three pins in the part frame once, the first
/// fixture that has it standing for all (DESIGN 3.1 no. 9). 2+2 fixtures are none.
std::vector<PalletFixture> pallets_of(const std::vector<planner::PlanarFixture>& fixtures,
                                      double pin_radius_mm);

/// Phases 1 to 4 for a station that does not grip (DESIGN 3): three pins on which the part comes down along
/// z; nothing squeezes, so the funnel's force phases equal `loadable`. Designs in the order of their planar
/// fixtures.
base::Expected<planner::Plan> make_pallet_plan(const model::Task& task, const planner::Scene& scene,
                                               const planner::PlanOptions& options,
                                               const planner::ProgressSink& progress);

}  // namespace pinjaw::cell

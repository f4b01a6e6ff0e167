#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/planner/force/grasp.hpp"
#include "host/planner/force/ray_program.hpp"

/// The grasps and loads that the squeeze bench measures on: each 8 contacts and 302 loads.
namespace pinjaw::bench {

inline constexpr int kLoads = 302;  ///< BB's 300 sprays and 2 accelerations

/// Between the rows of Case::loads.
inline constexpr int kStride =
    (kLoads + planner::kernel::kLanes - 1) / planner::kernel::kLanes * planner::kernel::kLanes;

struct alignas(64) LoadBlock {
  double b[planner::kernel::kLanes] = {};
};

/// One grasp's program and its loads, as every solver gets them.
struct Case {
  planner::Grasp grasp;
  planner::kernel::Program program{};
  planner::RayProgram rays;
  std::vector<model::Wrench> wrenches;
  std::vector<planner::RightHandSide> right;
  std::vector<LoadBlock> loads;  ///< `right` as the kernel takes it
};
using Cases = std::vector<std::unique_ptr<Case>>;

/// Designs that the planner finds for the shipped valve housing, under 300 sprays on its surface and its
/// inertia up and down.
Cases planned_cases(int count);

/// Planar form-closed grasps of upright prisms on random convex polygons of some 50 mm, pins at two heights,
/// under sprays of 8.4 N along the facets' normals and 11 N up and down at the centroid.
Cases convex_part_cases(int count);

/// Random form-closed grasps under forces of 8.4 N in any direction anywhere: loads that have little in
/// common.
Cases random_wrench_cases(int count);

}  // namespace pinjaw::bench

#pragma once

#include <vector>

#include "host/planner/features/features.hpp"

/// The part's edges and walls in plan. Private to phase 1.
namespace pinjaw::planner {

/// A candidate for a feature: where it comes from and its curve in plan, direction without meaning.
struct PlanCurve {
  geometry::Curve curve;
  int source = 0;  ///< number of the edge, or of the wall's face
  bool is_wall = false;
  bool approximate = false;
};

struct Projection {
  std::vector<PlanCurve> curves;
  /// Edges that are no candidates, chorded: they still split the others.
  std::vector<std::vector<geometry::Vector2d>> others;
};

/// All edges and walls of `part` in plan; fills the counts of candidates and of edges left out.
Projection projected(const part::Part& part, FeatureCounts& counts);

}  // namespace pinjaw::planner

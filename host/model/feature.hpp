#pragma once

#include <vector>

#include "host/geometry/plane.hpp"
#include "host/model/tolerance.hpp"

namespace pinjaw::model {

/// On which side of an arc the material lies. A segment always has its material on the left of travel.
enum class Bulge {
  Convex,   ///< material on the centre's side: a boss; a pin touches from outside
  Concave,  ///< material away from the centre: a bore; a pin touches from inside
};

/// An edge of the part, in plan view, that a pin can touch (DESIGN 3, phase 1).
///
/// `curve` is a segment directed so that its free side is on the right, or an arc (always counter-clockwise)
/// whose free side `bulge` tells; `bulge` of a segment is Convex.
struct Feature {
  int id = 0;    ///< position in the list of features
  int loop = 0;  ///< loop of a profile; on a CAD part 0
  int edge = 0;  ///< edge of that loop; on a CAD part the number of the source edge or face
  geometry::Curve curve;
  Bulge bulge = Bulge::Convex;
  double error_mm =
      0;  ///< how far the part's own edge may lie from the curve; 0 where it is the curve itself
  /// Parts of the curve, as arc lengths in [0, length], that a closed pin can reach; sorted and disjoint.
  /// The whole curve on a profile, where the planar phase itself keeps pins out of the outline.
  std::vector<geometry::Interval> reach_mm;
};

/// Whether the curve was fitted (freeform edge, silhouette, mesh) and differs from the part's own edge.
[[nodiscard]] inline bool is_approximate(const Feature& feature) {
  return feature.error_mm > kExactMm;
}

/// Unit normal at `along_mm`, from the material to the free side.
geometry::Vector2d outward_normal_at(const Feature& feature, double along_mm);

}  // namespace pinjaw::model

#pragma once

#include <vector>

#include "host/geometry/mesh.hpp"
#include "host/part/mesh_rounding.hpp"
#include "host/part/part.hpp"

/// Where the surface of a mesh folds or turns over, as curves in plan. Private to host/part.
namespace pinjaw::part {

struct MeshContours {
  std::vector<Contour> contours;
  std::vector<Rim> rims;  ///< the arcs among them, and their chords
  ContourCounts counts;
};

/// The creases and silhouettes of a mesh that stands upright, chained, and fitted in plan by segments and
/// arcs, so that the chords of a cylinder's rim are one arc.
///
/// A facet faces down, faces up or is upright (leans by at most kUprightSine). An edge is a crease where an
/// upright facet ends, where facets meet at more than geometry::kMostStepRad and one of them is steep (leans
/// by at most kSteepSine: a pin's edge needs a jump in height, and that needs a steep side), and where there
/// is one facet alone or more than two. It is a silhouette where a facet that faces down meets one that faces
/// up. Edges on the way of one curve are chained, also through vertices where others meet.
///
/// A chain follows the file's own corners to within kCornerMm, so its fit is tight. Only a silhouette of a
/// smooth face, which runs between the facets, is fitted as loosely as those facets bulge, up to eps, and
/// only where that halves the number of curves; what is shorter than a few of its bulges is left out as
/// jagged. Each contour's `error_mm` is how far the edges that it stands for lie from it, chords and bulge
/// included.
MeshContours contours_of(const geometry::TriangleMesh& mesh);

/// How far a corner in a file may be off the curve it was sampled from. Chosen: single precision at 10 m, and
/// what exporters round to.
inline constexpr double kCornerMm = 1.5e-3;

/// Farthest that a chord may lie from its arc: coarse exports bulge by 0.1 mm; a polygon that bulges less is
/// taken for a circle. Chosen.
inline constexpr double kMostSagittaMm = 0.15;

/// Sine of the lean up to which a side can make a step of the part: 0.1 mm aside for each mm of height.
inline constexpr double kSteepSine = 0.1;

}  // namespace pinjaw::part

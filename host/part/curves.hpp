#pragma once

#include <variant>
#include <vector>

#include "host/geometry/plane.hpp"

/// The exact edges of a part in space, as plain values. Lengths in mm.
namespace pinjaw::part {

using geometry::Vector2d;
using geometry::Vector3d;

/// The straight piece from `a_mm` to `b_mm`.
struct Line3 {
  Vector3d a_mm = Vector3d::Zero();
  Vector3d b_mm = Vector3d::Zero();
};

/// A piece of a circle or ellipse: centre + cos(t) u + sin(t) v for t in [from, from + sweep], sweep in (0, 2
/// pi].
struct Ellipse3 {
  Vector3d center_mm = Vector3d::Zero();
  Vector3d u_mm = Vector3d::Zero();
  Vector3d v_mm = Vector3d::Zero();
  double from_rad = 0;
  double sweep_rad = 0;
};

/// Any other curve, chorded.
struct Polyline3 {
  std::vector<Vector3d> points_mm;
};

using Curve3 = std::variant<Line3, Ellipse3, Polyline3>;

/// One edge of the part.
struct EdgeCurve {
  int edge = 0;  ///< number of the edge in the file, from 1
  Curve3 curve;
  double error_mm =
      0;  ///< how far the file's curve may lie from `curve`, where a line or circle was recognised in it
  std::vector<int> faces{};  ///< numbers of the faces it bounds, as in the mesh's `face_of`
};

/// An upright plane or cylinder of the part in plan: a source of features of its own (DESIGN 3.1 no. 3).
struct Wall {
  int face = 0;           ///< as in the mesh's `face_of`
  geometry::Curve curve;  ///< its whole extent in plan; direction without meaning
  geometry::Interval z_mm;
};

/// A curve in plan that stands for edges of a mesh: a crease, or a silhouette, where a smooth face turns
/// over. A source of features of its own.
struct Contour {
  int number = 0;                  ///< from 1
  geometry::Curve curve;           ///< direction without meaning
  double error_mm = 0;             ///< how far, in plan, the edges may lie from the curve
  std::vector<Vector3d> trace_mm;  ///< the edges' ends, in order
};

}  // namespace pinjaw::part

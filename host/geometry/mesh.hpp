#pragma once

#include <array>
#include <vector>

#include "host/geometry/plane.hpp"

namespace pinjaw::geometry {

/// A line of a curved surface along which its normal is horizontal and turns from down to up: there the
/// surface ends when it is seen along z (an occluding contour).
struct Silhouette {
  int face = 0;
  std::vector<Vector3d>
      points_mm;  ///< along the line, on the true surface; a closed line repeats its first point
  std::vector<double>
      radius_mm;  ///< at each point, of the surface's upright section; +inf where that is straight
};

/// Triangles of a surface, outward normals by the right-hand rule. Lengths in mm.
struct TriangleMesh {
  std::vector<Vector3d> vertices_mm;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> face_of;               ///< source face of each triangle, as many as triangles
  std::vector<Silhouette> silhouettes{};  ///< of the surface that the triangles stand for
  /// Of the smooth surface the triangles stand for, unit and outward, one a vertex, zero where it has none (a
  /// cone's tip); empty where nothing but the triangles is known.
  std::vector<Vector3d> normals{};
};

}  // namespace pinjaw::geometry

#pragma once

#include <array>
#include <vector>

#include "host/geometry/plane.hpp"

namespace pinjaw::geometry {

/// Triangles of a surface, outward normals by the right-hand rule. Lengths in mm.
struct TriangleMesh {
  std::vector<Vector3d> vertices_mm;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> face_of;  ///< source face of each triangle, as many as triangles
};

}  // namespace pinjaw::geometry

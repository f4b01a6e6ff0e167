#pragma once

#include <vector>

#include "host/geometry/mesh.hpp"

namespace pinjaw::part {

/// The edges of a mesh where a facet that faces down meets one that does not, or none: whatever the surface
/// is, its shadow in plan ends on them. Chained; a closed line repeats its first point. Faces meshed one by
/// one are joined where their vertices lie together but for rounding.
std::vector<std::vector<geometry::Vector3d>> turning_lines(const geometry::TriangleMesh& mesh);

}  // namespace pinjaw::part

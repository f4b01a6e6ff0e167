#pragma once

#include <span>
#include <vector>

#include "host/geometry/plane.hpp"

/// Points that are one but for rounding. Private to host/part.
namespace pinjaw::part {

using geometry::Vector3d;

struct Welded {
  std::vector<Vector3d> vertices_mm;
  std::vector<int> vertex_of;  ///< of each point
};

/// Each point takes the first vertex within kWeldSteps of its rounding, axis by axis; where there is none it
/// becomes one. Linear in the points for any input.
Welded weld(std::span<const Vector3d> points_mm);

/// How many steps of single precision, at the farthest coordinate, two writings of one corner may differ by.
inline constexpr double kWeldSteps = 4;

}  // namespace pinjaw::part

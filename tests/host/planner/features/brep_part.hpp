#pragma once

#include <string>
#include <vector>

#include "host/part/brep.hpp"
#include "host/part/part.hpp"

/// Parts made for tests, straight from OpenCASCADE's solids.
namespace pinjaw::planner {

using geometry::Vector2d;
using geometry::Vector3d;

struct Box3 {
  Vector3d lo_mm;
  Vector3d hi_mm;
};

/// A part of a shape as read_part would make it, with `rotation` applied.
part::Part part_of(const part::Shape& shape, const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());

/// Boxes fused into one solid.
part::Shape boxes(const std::vector<Box3>& parts);

/// `shape` less an upright cylinder from `z_mm.lo` to `z_mm.hi`.
part::Shape drilled(const part::Shape& shape, const Vector2d& center_mm, double radius_mm,
                    const geometry::Interval& z_mm);

/// A box with its four bottom edges chamfered or filleted.
part::Shape chamfered_box(const Box3& box, double size_mm);
part::Shape filleted_box(const Box3& box, double radius_mm);

/// A shipped part's only solid, as read from its file.
part::Shape shipped_shape(const std::string& name);

}  // namespace pinjaw::planner

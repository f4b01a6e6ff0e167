#pragma once

#include "host/model/profile.hpp"
#include "host/part/brep.hpp"
#include "host/part/curves.hpp"

/// From the values that OpenCASCADE told to a part that stands upright. Private to host/part.
namespace pinjaw::part {

using Eigen::Matrix3d;

/// Sine of the lean below which a plane, cylinder or facet counts as upright: 0.01 mm over a 10 mm wall.
inline constexpr double kUprightSine = 1e-3;

Curve3 rotated(const Curve3& curve, const Matrix3d& rotation);
geometry::TriangleMesh rotated(geometry::TriangleMesh mesh, const Matrix3d& rotation);

/// Each edge of the profile mirrored in place, so that its number stays.
model::Profile mirrored(model::Profile profile, int axis);

/// The upright ones of `faces` in plan, as far as `mesh` reaches; both in the same frame as `rotation` leaves
/// them.
std::vector<Wall> walls_of(const std::vector<WallFace>& faces, const Matrix3d& rotation,
                           const geometry::TriangleMesh& rotated_mesh);

/// The part of these values after `rotation`, with all that they tell; its name, file, mass and profile are
/// left to the caller.
Part placed(BrepValues values, const Matrix3d& rotation);

}  // namespace pinjaw::part

#pragma once

#include "host/geometry/plane.hpp"

namespace pinjaw::geometry {

/// The arc length from the curve's start to its point nearest to `p_mm`; of an arc by the angle alone, its
/// nearer end where the angle lies beyond it.
double nearest_along_mm(const Curve& curve, const Vector2d& p_mm);

/// From the point at `along_mm` to the nearer end; a full circle has none, and half of it counts.
double end_margin_mm(const Curve& curve, double along_mm);

}  // namespace pinjaw::geometry

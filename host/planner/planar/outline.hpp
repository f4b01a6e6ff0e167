#pragma once

#include <vector>

#include "host/planner/planar/contact_curve.hpp"

namespace pinjaw::planner::planar {

/// How deep a pin may stand in the outline: a distance, since near a convex corner the gap grows only with
/// the square of the way along the edge. The value of the known cases.
inline constexpr double kPenetrationTolerance_mm = 1e-6;

/// Distance from `p_mm` to the outline's nearest edge, graspable or not.
double outline_distance_mm(const model::Profile& outline, const Vector2d& p_mm);

/// Parts of `curve.range` where a pin on the curve stays out of the outline; the whole range where there is
/// none. Exact: the ends are crossings of the curve with the outline's edges offset by the pin's radius.
std::vector<geometry::Interval> free_pieces(const ContactCurve& curve, double pin_radius_mm,
                                            const model::Profile* outline);

}  // namespace pinjaw::planner::planar

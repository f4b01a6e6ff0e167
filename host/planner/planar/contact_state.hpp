#pragma once

#include <array>
#include <span>

#include "host/planner/planar/contact_curve.hpp"

namespace pinjaw::planner::planar {

/// A pin that touches: its curve, its hole counted outwards from the innermost used column of its own jaw and
/// upwards from a common row, and where that is: x from that column, y from that row.
struct Touch {
  const ContactCurve* curve = nullptr;
  bool left = true;
  int column = 0;
  int row = 0;
  Vector2d hole_mm = Vector2d::Zero();
};
Touch touch_of(const ContactCurve& curve, bool left, int column, int row, double spacing_mm);

/// Where the part is: its origin's y above the common row, its x from each jaw's innermost used column.
/// The span D = x_left_mm - x_right_mm.
struct Placement {
  double theta_rad = 0;
  double y_mm = 0;
  double x_left_mm = 0;
  double x_right_mm = 0;
};

/// A contact at a placement. The pin need not touch exactly.
struct ContactState {
  double miss_mm = 0;                    ///< distance of the pin centre from its curve, outwards positive
  Vector2d lever_mm = Vector2d::Zero();  ///< pin centre from the part origin, gripper axes
  Vector2d normal = Vector2d::Zero();    ///< outward, gripper axes
};
ContactState contact_at(const Touch& touch, const Placement& placement);

/// x of the part origin, from the innermost used column of the pin's jaw, at which the pin touches on the
/// side that lets it push inwards; y and theta given. Not finite where it cannot touch.
double x_where_it_touches(const Touch& touch, double theta_rad, double y_mm);

/// Newton's method on the contact equations: four touches move theta, y and both x, three touches of the left
/// jaw all but x_right. True when every miss is under 1e-10 mm within finite steps that stay near the start.
bool polish(std::span<const Touch> touches, Placement& placement);

/// Multipliers of the four inward contact forces that balance in the plane, scaled so that their absolute
/// values sum to 1 and the greatest is positive: strict form closure when the least is above 0. All 0 where
/// the contact lines meet in one point or are parallel, so that nothing is told of them.
std::array<double, 4> closure_multipliers(const std::array<ContactState, 4>& contacts);

}  // namespace pinjaw::planner::planar

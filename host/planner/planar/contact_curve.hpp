#pragma once

#include <array>
#include <vector>

#include "host/model/feature.hpp"
#include "host/model/kit.hpp"
#include "host/model/profile.hpp"

namespace pinjaw::planner::planar {

using geometry::Vector2d;

/// The curve that the centre of a pin follows, in the part frame, while the pin touches one reachable piece
/// of a feature: the feature offset by the pin's radius to its free side.
///
/// Line: points q with normal . q = offset_mm, tangent coordinate tangent . q in `range`.
/// Arc: q = center + rho (cos a, sin a), a - range.lo in [0, range.length()]; the outward normal is
/// kappa (cos a, sin a), kappa = +1 on a convex feature and -1 in a bore.
struct ContactCurve {
  int feature = 0;  ///< position in the list of features
  bool arc = false;
  bool full = false;                      ///< an arc all the way round
  Vector2d normal = Vector2d::UnitX();    ///< line: outward normal
  double normal_rad = 0;                  ///< line: its angle
  double offset_mm = 0;                   ///< line
  Vector2d tangent = Vector2d::UnitY();   ///< line: direction of travel
  Vector2d center_mm = Vector2d::Zero();  ///< arc
  double rho_mm = 0;                      ///< arc
  double kappa = 1;                       ///< arc
  geometry::Interval range;               ///< line: mm; arc: rad
  std::array<Vector2d, 2> ends_mm;        ///< pin centres at the ends of the slightly widened range
};

/// How much wider than its range a curve is searched, so that feet exactly at an end are not lost to
/// rounding; the answer is checked against the range itself with kFootTolerance_mm.
inline constexpr double kSearchWidening_mm = 2e-7;
inline constexpr double kFootTolerance_mm = 1e-7;

/// One curve for each reachable piece of each feature; bores no wider than the pin and pieces without length
/// have none. With `outline`, pieces where the pin would be inside the outline by over 1e-6 mm are cut away.
std::vector<ContactCurve> contact_curves(const std::vector<model::Feature>& features, double pin_radius_mm,
                                         const model::Profile* outline);

/// Pin centre at parameter `at` (line: tangent coordinate in mm; arc: angle in rad).
Vector2d centre_at(const ContactCurve& curve, double at);

/// Whether the pin centre `q_mm` (on the curve or its continuation) lies in the range, within `tolerance_mm`.
bool in_range(const ContactCurve& curve, const Vector2d& q_mm, double tolerance_mm);

/// Outward normal at the pin centre `q_mm`.
Vector2d normal_at(const ContactCurve& curve, const Vector2d& q_mm);

}  // namespace pinjaw::planner::planar

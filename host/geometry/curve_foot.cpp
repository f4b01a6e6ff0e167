#include "host/geometry/curve_foot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pinjaw::geometry {

double nearest_along_mm(const Curve& curve, const Vector2d& p_mm) {
  const double length = length_mm(curve);
  if (const auto* segment = std::get_if<Segment>(&curve))
    return std::clamp((p_mm - segment->a_mm).dot((segment->b_mm - segment->a_mm).normalized()), 0.0, length);
  const auto& arc = std::get<Arc>(curve);
  const Vector2d radial = p_mm - arc.center_mm;
  const double along = arc.radius_mm * wrapped_rad(std::atan2(radial.y(), radial.x()) - arc.from_rad);
  if (along <= length) return along;
  const double beyond = along - length;
  return 2 * std::numbers::pi * arc.radius_mm - along < beyond ? 0 : length;
}

double end_margin_mm(const Curve& curve, double along_mm) {
  const double length = length_mm(curve);
  const auto* arc = std::get_if<Arc>(&curve);
  constexpr double kFullTurn = 2 * std::numbers::pi - 1e-9;
  if (arc != nullptr && arc->sweep_rad > kFullTurn) return length / 2;
  return std::min(along_mm, length - along_mm);
}

}  // namespace pinjaw::geometry

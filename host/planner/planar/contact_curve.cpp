#include "host/planner/planar/contact_curve.hpp"

#include <algorithm>
#include <cmath>

#include "host/planner/planar/constants.hpp"
#include "host/planner/planar/outline.hpp"

namespace pinjaw::planner::planar {
namespace {

constexpr double kLeastLength_mm = 1e-9;  // chosen: no pin can be told to stand on less
constexpr double kFullTurn_rad = kTurn - 1e-9;

ContactCurve line_of(const model::Feature& feature, const geometry::Segment& segment, double pin_radius_mm,
                     const geometry::Interval& reach_mm) {
  ContactCurve curve;
  curve.tangent = (segment.b_mm - segment.a_mm).normalized();
  curve.normal = {curve.tangent.y(), -curve.tangent.x()};
  curve.normal_rad = std::atan2(curve.normal.y(), curve.normal.x());
  curve.offset_mm = curve.normal.dot(segment.a_mm) + pin_radius_mm;
  const double start_mm = curve.tangent.dot(segment.a_mm);
  curve.range = {start_mm + reach_mm.lo, start_mm + reach_mm.hi};
  curve.feature = feature.id;
  return curve;
}

ContactCurve arc_of(const model::Feature& feature, const geometry::Arc& arc, double pin_radius_mm,
                    const geometry::Interval& reach_mm) {
  ContactCurve curve;
  curve.arc = true;
  curve.kappa = feature.bulge == model::Bulge::Convex ? 1 : -1;
  curve.center_mm = arc.center_mm;
  curve.rho_mm = arc.radius_mm + curve.kappa * pin_radius_mm;
  curve.range = {arc.from_rad + reach_mm.lo / arc.radius_mm, arc.from_rad + reach_mm.hi / arc.radius_mm};
  curve.full = curve.range.length() >= kFullTurn_rad;
  curve.feature = feature.id;
  return curve;
}

void set_ends(ContactCurve& curve) {
  const double widening = curve.arc ? kSearchWidening_mm / curve.rho_mm : kSearchWidening_mm;
  curve.ends_mm = {centre_at(curve, curve.range.lo - widening), centre_at(curve, curve.range.hi + widening)};
}

}  // namespace

std::vector<ContactCurve> contact_curves(const std::vector<model::Feature>& features, double pin_radius_mm,
                                         const model::Profile* outline) {
  std::vector<ContactCurve> curves;
  for (std::size_t index = 0; index < features.size(); ++index) {
    const model::Feature& feature = features[index];
    for (const geometry::Interval& reach_mm : feature.reach_mm) {
      if (reach_mm.length() < kLeastLength_mm) continue;
      ContactCurve curve;
      if (const auto* segment = std::get_if<geometry::Segment>(&feature.curve)) {
        curve = line_of(feature, *segment, pin_radius_mm, reach_mm);
      } else {
        curve = arc_of(feature, std::get<geometry::Arc>(feature.curve), pin_radius_mm, reach_mm);
        if (curve.rho_mm < kLeastLength_mm) continue;
      }
      curve.feature = static_cast<int>(index);
      for (const geometry::Interval& free : free_pieces(curve, pin_radius_mm, outline)) {
        ContactCurve piece = curve;
        piece.range = free;
        piece.full = curve.full && free.length() >= kFullTurn_rad;
        set_ends(piece);
        curves.push_back(piece);
      }
    }
  }
  return curves;
}

Vector2d centre_at(const ContactCurve& curve, double at) {
  if (curve.arc) return curve.center_mm + curve.rho_mm * geometry::direction(at);
  return curve.offset_mm * curve.normal + at * curve.tangent;
}

bool in_range(const ContactCurve& curve, const Vector2d& q_mm, double tolerance_mm) {
  if (!curve.arc) {
    const double at_mm = curve.tangent.dot(q_mm);
    return at_mm >= curve.range.lo - tolerance_mm && at_mm <= curve.range.hi + tolerance_mm;
  }
  if (curve.full) return true;
  const double tolerance_rad = tolerance_mm / curve.rho_mm;
  const Vector2d radial = q_mm - curve.center_mm;
  const double beyond_rad =
      geometry::wrapped_rad(std::atan2(radial.y(), radial.x()) - curve.range.lo + tolerance_rad);
  return beyond_rad <= curve.range.length() + 2 * tolerance_rad;
}

Vector2d normal_at(const ContactCurve& curve, const Vector2d& q_mm) {
  if (!curve.arc) return curve.normal;
  return curve.kappa * (q_mm - curve.center_mm).normalized();
}

}  // namespace pinjaw::planner::planar

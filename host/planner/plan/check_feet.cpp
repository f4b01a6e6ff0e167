#include "host/planner/plan/check_feet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/planner/features/features.hpp"
#include "host/planner/plan/pin_places.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;

constexpr double kFootTol_mm = 1e-6;  // chosen: poses lose some 1e-13

/// Where on the curve the point is nearest, as an arc length.
double nearest_along_mm(const geometry::Curve& curve, const Vector2d& p_mm) {
  const double length = geometry::length_mm(curve);
  if (const auto* segment = std::get_if<geometry::Segment>(&curve))
    return std::clamp((p_mm - segment->a_mm).dot((segment->b_mm - segment->a_mm).normalized()), 0.0, length);
  const auto& arc = std::get<geometry::Arc>(curve);
  const Vector2d radial = p_mm - arc.center_mm;
  const double along =
      arc.radius_mm * geometry::wrapped_rad(std::atan2(radial.y(), radial.x()) - arc.from_rad);
  if (along <= length) return along;
  const double beyond = along - length;
  return 2 * std::numbers::pi * arc.radius_mm - along < beyond ? 0 : length;
}

/// From the point to the nearer end; a full circle has none, and half of it counts.
double margin_mm(const geometry::Curve& curve, double along_mm) {
  const double length = geometry::length_mm(curve);
  const auto* arc = std::get_if<geometry::Arc>(&curve);
  constexpr double kFullTurn = 2 * std::numbers::pi - 1e-9;
  if (arc != nullptr && arc->sweep_rad > kFullTurn) return length / 2;
  return std::min(along_mm, length - along_mm);
}

}  // namespace

std::vector<Claim> check_feet(const Plan& plan, const Scene& scene,
                              std::span<const model::Design* const> designs) {
  std::vector<Claim> claims;
  if (designs.empty()) return claims;
  const std::vector<model::Feature> features = find_features(scene.turned, plan.kit.pins).features;
  const auto claim = [&](const std::string& subject, std::string what, bool holds, std::string found) {
    claims.push_back({subject, std::move(what), holds, holds ? std::string() : std::move(found)});
  };
  for (const model::Design* design : designs) {
    for (const model::PinDesign& pin : design->pins) {
      const std::string name = "pin " + name_of(pin.hole);
      const std::string on_feature = name + " stands on its feature";
      if (pin.feature < 0 || static_cast<std::size_t>(pin.feature) >= features.size()) {
        claim(design->id, on_feature, false, fmt::format("the part has {} features", features.size()));
        continue;
      }
      const geometry::Curve& curve = features[static_cast<std::size_t>(pin.feature)].curve;
      const Vector2d foot_mm = foot_in_part_mm(*design, pin);
      const double along_mm = nearest_along_mm(curve, foot_mm);
      const double off_mm = (geometry::point_at(curve, along_mm) - foot_mm).norm();
      claim(design->id, on_feature, off_mm <= kFootTol_mm, fmt::format("it stands {:.6f} mm beside", off_mm));
      const double margin = margin_mm(curve, along_mm);
      claim(design->id, name + " foot margin", std::abs(margin - pin.foot_margin_mm) <= kFootTol_mm,
            fmt::format("stated {:.9g}, recomputed {:.9g}", pin.foot_margin_mm, margin));
    }
  }
  return claims;
}

}  // namespace pinjaw::planner

#include "host/planner/plan/check_feet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "host/geometry/curve_foot.hpp"
#include "host/planner/features/features.hpp"
#include "host/planner/plan/claim_list.hpp"
#include "host/planner/plan/pin_places.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;

constexpr double kFootTol_mm = 1e-6;  // chosen: poses lose some 1e-13

}  // namespace

std::vector<Claim> check_feet(const Plan& plan, const Scene& scene,
                              std::span<const model::Design* const> designs) {
  std::vector<Claim> claims;
  if (designs.empty()) return claims;
  const std::vector<model::Feature> features = find_features(scene.turned, plan.kit.pins).features;
  for (const model::Design* design : designs) {
    ClaimList of_design(design->id);
    for (const model::PinDesign& pin : design->pins) {
      const std::string name = "pin " + name_of(pin.hole);
      const std::string on_feature = name + " stands on its feature";
      if (pin.feature < 0 || static_cast<std::size_t>(pin.feature) >= features.size()) {
        of_design.claim(on_feature, false, fmt::format("the part has {} features", features.size()));
        continue;
      }
      const geometry::Curve& curve = features[static_cast<std::size_t>(pin.feature)].curve;
      const Vector2d foot_mm = foot_in_part_mm(*design, pin);
      const double along_mm = geometry::nearest_along_mm(curve, foot_mm);
      const double off_mm = (geometry::point_at(curve, along_mm) - foot_mm).norm();
      of_design.claim(on_feature, off_mm <= kFootTol_mm, fmt::format("it stands {:.6f} mm beside", off_mm));
      of_design.equal(name + " foot margin", pin.foot_margin_mm, geometry::end_margin_mm(curve, along_mm),
                      kFootTol_mm);
    }
    std::ranges::move(of_design.take(), std::back_inserter(claims));
  }
  return claims;
}

}  // namespace pinjaw::planner

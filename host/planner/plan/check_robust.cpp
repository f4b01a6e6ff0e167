#include "host/planner/plan/check_robust.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "host/planner/plan/check_tolerances.hpp"
#include "host/planner/plan/claim_list.hpp"
#include "host/planner/plan/rank.hpp"

namespace pinjaw::planner {

namespace {

constexpr double kPlaceTol = 1e-9;  // mm and degrees

}  // namespace

std::vector<Claim> check_robust(const Plan& plan, const Scene& scene, const model::Design& design) {
  if (!design.robust) return {};
  ClaimList claims(design.id);
  claims.claim("the plan tells the ranges of its robustness", plan.ranges.has_value(), "it does not");
  if (!plan.ranges) return claims.take();

  const model::Robust& stated = *design.robust;
  const RobustScene robust(plan, scene, *plan.ranges);
  const RobustPoint worst = robust_at(robust.of, design, stated.friction, stated.pins);
  claims.claim("it fails in its ranges as stated", worst.failure == stated.failure,
               fmt::format("stated \"{}\", recomputed \"{}\"", stated.failure, worst.failure));
  if (worst.required_n && stated.worst_required_n) {
    claims.equal("squeeze at the worst point of its ranges", *stated.worst_required_n, *worst.required_n,
                 kForceTolN);
    claims.claim("no less than the nominal squeeze",
                 *stated.worst_required_n >= design.squeeze.required_n - kForceTolN,
                 fmt::format("{:.9g} N", *stated.worst_required_n));
    claims.equal("margin at the worst point", stated.margin_n, stated.usable_n - *worst.required_n,
                 kForceTolN);
  }
  const model::Actuator& actuator = plan.kit.actuator;
  claims.equal("usable squeeze at the least air pressure", stated.usable_n,
               plan.ranges->air_pressure.lo * actuator.max_squeeze_n - 2 * actuator.force_uncertainty_n,
               kForceTolN);

  const LocationError error = location_error(robust.of, design);
  claims.equal("location error of the corners, mm", stated.location_error_mm, error.moved_mm, kPlaceTol);
  claims.equal("location error of the corners, degrees", stated.location_error_deg, error.turned_deg,
               kPlaceTol);
  const auto bound = Closing(design, robust.features, plan.kit, robust.of.centroid_P_mm).bound(*plan.ranges);
  claims.claim("its place is bounded as stated", bound.has_value() == stated.location_bound_mm.has_value(),
               bound ? "a bound is not told" : "no bound was found");
  if (!bound || !stated.location_bound_mm) return claims.take();
  claims.equal("bound of its place", *stated.location_bound_mm, bound->moved_mm, kPlaceTol);
  claims.equal("bound of its turn", stated.location_bound_deg.value_or(-1),
               bound->turned_rad * 180 / std::numbers::pi, kPlaceTol);
  return claims.take();
}

}  // namespace pinjaw::planner

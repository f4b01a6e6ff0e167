#include "host/planner/plan/check_certified.hpp"

#include <algorithm>
#include <cmath>

#include "host/planner/plan/certify.hpp"
#include "host/planner/plan/check_tolerances.hpp"
#include "host/planner/plan/claim_list.hpp"

namespace pinjaw::planner {
namespace {

/// Whether the name is that of the jet, alone or with what acts with it.
bool tells(const std::string& name, const Jet& jet) {
  return name == jet.name || name.starts_with(jet.name + " with ");
}

}  // namespace

std::vector<Claim> check_certified(const Plan& plan, const Scene& scene, const model::Design& design) {
  if (!design.certified) return {};
  const model::Certified& stated = *design.certified;
  ClaimList claims(design.id);
  const bool units =
      std::abs(stated.normal.norm() - 1) <= kUnitTol && std::abs(stated.from.norm() - 1) <= kUnitTol;
  claims.claim("the worst spray's directions are of length 1", units, "one is not");

  claims.claim("no sampled spray needs more than the worst one",
               stated.low_n >= stated.sampled_n - kForceTolN, "one does");

  double needs_n = -1;
  bool reached = false;
  SqueezeSolver solver(grasp_of(design, plan.friction));
  for (const Jet& jet : plan.jets) {
    if (!units || !tells(stated.spray, jet)) continue;
    reached = reached || (may_come_from(jet.spray, stated.from) &&
                          jet_meets_first(scene.part.surface, stated.at_mm, stated.from));
    needs_n = std::max(
        needs_n, jet_need(solver, jet, stated.at_mm, stated.normal, plan.side, plan.friction_model).force_n);
  }
  claims.claim("a jet reaches the worst spray's point first", reached, "none from there does");
  claims.equal("squeeze that the worst spray needs", stated.low_n, needs_n, kForceTolN);

  WorstSpray search = worst_spray_of(plan, scene);
  const auto found = certified(plan, search, design);
  claims.claim("a new search finds a worst spray", found.has_value(), "it finds none");
  if (!found) return claims.take();
  claims.equal("least that the worst spray needs", stated.low_n, found->low_n, kForceTolN);
  claims.equal("most that any spray needs", stated.high_n, found->high_n, kForceTolN);
  claims.equal("most that a sampled spray needs", stated.sampled_n, found->sampled_n, kForceTolN);
  claims.claim("the worst spray acts along the surface's normal",
               (found->normal - stated.normal).norm() <= kUnitTol, "the search finds another");
  claims.claim("kind of face that the worst spray hits", found->curved == stated.curved,
               found->curved ? "it is curved" : "it is flat");
  claims.claim("whether the bracket is closed", found->closed == stated.closed,
               found->closed ? "it is" : "it is not");
  return claims.take();
}

}  // namespace pinjaw::planner

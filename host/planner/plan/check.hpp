#pragma once

#include <string>
#include <vector>

#include "host/planner/plan/plan.hpp"
#include "host/planner/plan/scene.hpp"

namespace pinjaw::planner {

/// One thing that a plan says, and whether it is so.
struct Claim {
  std::string subject;  ///< id of the design; empty for the plan as a whole
  std::string claim;
  bool holds = false;
  std::string found;  ///< what was found instead; empty where it holds
};

/// Recomputes what the plan says as a whole: the part's bytes, the order of the designs, the funnel.
std::vector<Claim> check_plan(const Plan& plan, const Scene& scene);

/// Recomputes every claim of one design from its stated numbers: holes, contacts, closure, heights, loading,
/// force.
std::vector<Claim> check_design(const Plan& plan, const Scene& scene, const model::Design& design);

}  // namespace pinjaw::planner

#pragma once

#include <span>
#include <vector>

#include "host/planner/plan/check.hpp"

namespace pinjaw::planner {

/// Recomputes on which feature of the part each pin's foot stands, and how far from the feature's nearer end.
/// The features are found anew, once for all the designs.
std::vector<Claim> check_feet(const Plan& plan, const Scene& scene,
                              std::span<const model::Design* const> designs);

}  // namespace pinjaw::planner

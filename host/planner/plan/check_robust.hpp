#pragma once

#include <vector>

#include "host/planner/plan/check.hpp"

namespace pinjaw::planner {

/// The claims of one design about its ranges: the squeeze at the stated worst point, the location error of
/// all corners, the bounds. None where the design tells no robustness. Private to check.
std::vector<Claim> check_robust(const Plan& plan, const Scene& scene, const model::Design& design);

}  // namespace pinjaw::planner

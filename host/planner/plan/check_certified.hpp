#pragma once

#include <vector>

#include "host/planner/plan/check.hpp"

namespace pinjaw::planner {

/// Recomputes what a design says of its worst spray: that a jet reaches its point from where it says, that it
/// needs what it says there, that a new search finds the same bracket, and what the samples need. No claims
/// where the design tells none.
std::vector<Claim> check_certified(const Plan& plan, const Scene& scene, const model::Design& design);

}  // namespace pinjaw::planner

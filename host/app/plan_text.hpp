#pragma once

#include <string>

#include "host/planner/plan/exact.hpp"
#include "host/planner/plan/plan.hpp"

/// What people read of a plan on a terminal.
namespace pinjaw::app {

/// One line a phase: how many fixtures are left after it.
std::string funnel_text(const planner::Funnel& funnel);

/// The funnel with the reasons of each loss, for `why`.
std::string losses_text(const planner::Plan& plan);

/// The best designs, one line each.
std::string designs_text(const planner::Plan& plan, std::size_t at_most);

/// The worst spray of each certified design, and a warning where it needs more than the usable force; empty
/// where none is certified.
std::string certified_text(const planner::Plan& plan);

/// How the designs that tell it fare over the ranges; empty where none does.
std::string robust_text(const planner::Plan& plan);

/// What the designs that tell it come to on the part's exact faces; empty where none does.
std::string exact_text(const planner::Plan& plan);

/// Each figure that differs from the triangles' by enough to be told, and a line about them all. `asked` is
/// how many designs were to be re-checked.
std::string exact_text(const planner::ExactReport& report, std::size_t asked);

/// Least difference between triangles and exact faces that is told. Chosen: a quarter of the chord error.
inline constexpr double kToldDifference_mm = 1e-3;

}  // namespace pinjaw::app

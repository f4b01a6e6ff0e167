#pragma once

#include <numbers>

namespace pinjaw::planner::slow {

inline constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace pinjaw::planner::slow

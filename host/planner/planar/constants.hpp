#pragma once

#include <numbers>

namespace pinjaw::planner::planar {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTurn = 2 * kPi;
inline constexpr double kOverlap_mm = 1e-9;  ///< pins that overlap by less only touch

}  // namespace pinjaw::planner::planar

#pragma once

/// How far what is recomputed may be from what a plan says. Private to check.
namespace pinjaw::planner {

inline constexpr double kForceTolN = 1e-6;  // chosen: the solver certifies 1e-9 relative
inline constexpr double kUnitTol = 1e-9;    // of the length and the place of a unit vector

}  // namespace pinjaw::planner

#pragma once

#include <array>
#include <vector>

#include "host/model/disturbance.hpp"
#include "host/planner/force/grasp.hpp"
#include "host/planner/force/kernel.hpp"

namespace pinjaw::planner {

/// A grasp brought to the coordinates of its linear program: torques about the contacts' mean, divided by the
/// contacts' root mean square distance from it. F_sq does not change; the numbers are all of order one.
struct GraspFrame {
  Vector3d p_PMean_mm = Vector3d::Zero();
  double length_mm = 1;

  /// The right-hand side -F_D of W c + F_D = 0 for a wrench about the part frame's origin.
  [[nodiscard]] std::array<double, kernel::kRows> right_hand_side(const model::Wrench& wrench) const;
};

GraspFrame frame_of(const Grasp& grasp);

/// The four edges of a contact's friction pyramid: n + h (s1 t + s2 z), t = z x n, h the half-width (BB:
/// mu/sqrt 2).
std::array<Vector3d, 4> pyramid_rays(const PointContact& contact, double half_width);

/// Ray form of BB's linear program: column 4 i + k is edge k of contact i, its cost the ray's squeeze.
void fill_program(const Grasp& grasp, const GraspFrame& frame, double half_width, kernel::Program& program);

}  // namespace pinjaw::planner

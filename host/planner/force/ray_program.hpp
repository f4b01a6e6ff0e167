#pragma once

#include <array>
#include <vector>

#include "host/model/disturbance.hpp"
#include "host/planner/force/grasp.hpp"
#include "host/planner/force/kernel.hpp"

namespace pinjaw::planner {

using RightHandSide = std::array<double, kernel::kRows>;

/// A grasp brought to the coordinates of its linear program: torques about the contacts' mean, divided by the
/// contacts' root mean square distance from it. F_sq does not change; the numbers are all of order one.
struct GraspFrame {
  Vector3d p_PMean_mm = Vector3d::Zero();
  double length_mm = 1;

  /// The right-hand side -F_D of W c + F_D = 0 for a wrench about the part frame's origin.
  [[nodiscard]] RightHandSide right_hand_side(const model::Wrench& wrench) const;
};

GraspFrame frame_of(const Grasp& grasp);

/// The four edges of a contact's friction pyramid: n + h (s1 t + s2 z), t = z x n, h the half-width (BB:
/// mu/sqrt 2).
std::array<Vector3d, 4> pyramid_rays(const PointContact& contact, double half_width);

/// The kernel's form of BB's linear program: plan ray 2 i + k of contact i is the sum of edges k and k + 2.
void fill_program(const Grasp& grasp, const GraspFrame& frame, double half_width, kernel::Program& program);

/// The plain form: min c'x, A x = b, x >= 0, column 4 i + k edge k of contact i, its cost the ray's squeeze.
struct RayProgram {
  std::vector<std::array<double, kernel::kRows>> columns;
  std::vector<double> cost;
};
/// How much of a ray of RayProgram.
struct RayAmount {
  int column = 0;
  double amount = 0;
};
/// The rays of an optimum at a vertex of the kernel, at most 6 and independent, that balance `b`.
std::vector<RayAmount> balancing_rays(const kernel::Program& program, const kernel::Vertex& vertex,
                                      const RightHandSide& b);

RayProgram ray_program_of(const Grasp& grasp, const GraspFrame& frame, double half_width);

}  // namespace pinjaw::planner

#include "host/planner/force/ray_program.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pinjaw::planner {

GraspFrame frame_of(const Grasp& grasp) {
  GraspFrame frame;
  for (const PointContact& contact : grasp.contacts) frame.p_PMean_mm += contact.p_P_mm;
  const auto count = static_cast<double>(grasp.contacts.size());
  frame.p_PMean_mm /= count;
  double square_mm2 = 0;
  for (const PointContact& contact : grasp.contacts)
    square_mm2 += (contact.p_P_mm - frame.p_PMean_mm).squaredNorm();
  constexpr double kLeastLength_mm =
      1e-3;  // chosen: one contact, or all at one point, has no extent to scale by
  frame.length_mm = std::max(kLeastLength_mm, std::sqrt(square_mm2 / count));
  return frame;
}

std::array<double, kernel::kRows> GraspFrame::right_hand_side(const model::Wrench& wrench) const {
  const double fx = wrench[0];
  const double fy = wrench[1];
  const double fz = wrench[2];
  const Vector3d& p = p_PMean_mm;
  const double scale = 1 / length_mm;
  return {-fx,
          -fy,
          -fz,
          -(wrench[3] - (p.y() * fz - p.z() * fy)) * scale,
          -(wrench[4] - (p.z() * fx - p.x() * fz)) * scale,
          -(wrench[5] - (p.x() * fy - p.y() * fx)) * scale};
}

std::array<Vector3d, 4> pyramid_rays(const PointContact& contact, double half_width) {
  const Vector2d& n = contact.n_P;
  std::array<Vector3d, 4> rays;
  for (std::size_t k = 0; k < 4; ++k) {
    const double s1 = (k & 1U) != 0 ? half_width : -half_width;
    const double s2 = (k & 2U) != 0 ? half_width : -half_width;
    rays[k] = {n.x() - s1 * n.y(), n.y() + s1 * n.x(), s2};
  }
  return rays;
}

void fill_program(const Grasp& grasp, const GraspFrame& frame, double half_width, kernel::Program& program) {
  program = {};
  std::fill(std::begin(program.cost), std::end(program.cost), 1.0);
  program.least_cost = std::numeric_limits<double>::infinity();
  int column = 0;
  for (const PointContact& contact : grasp.contacts) {
    const Vector3d arm = (contact.p_P_mm - frame.p_PMean_mm) / frame.length_mm;
    for (const Vector3d& ray : pyramid_rays(contact, half_width)) {
      const Vector3d moment = arm.cross(ray);
      for (int k = 0; k < 3; ++k) {
        program.at[column][k] = ray[k];
        program.at[column][3 + k] = moment[k];
      }
      for (int k = 0; k < kernel::kRows; ++k) program.a[k][column] = program.at[column][k];
      program.cost[column] = squeeze_share(grasp, contact, ray);
      program.least_cost = std::min(program.least_cost, program.cost[column]);
      ++column;
    }
  }
}

}  // namespace pinjaw::planner

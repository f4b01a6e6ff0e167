#include "host/planner/force/ray_program.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

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

RightHandSide GraspFrame::right_hand_side(const model::Wrench& wrench) const {
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

namespace {

using Column = std::array<double, kernel::kRows>;

Column column_of(const Vector3d& arm, const Vector3d& force) {
  const Vector3d moment = arm.cross(force);
  return {force.x(), force.y(), force.z(), moment.x(), moment.y(), moment.z()};
}

void put(const Column& column, double scale, double* out) {
  for (std::size_t k = 0; k < column.size(); ++k) out[k] = scale * column[k];
}

/// The pin of each contact: contacts one above the other that press alike share one.
std::vector<int> pins_of(const Grasp& grasp) {
  std::vector<int> pins;
  int count = 0;
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const PointContact& contact = grasp.contacts[i];
    int pin = -1;
    for (std::size_t other = 0; other < i && pin < 0; ++other) {
      const PointContact& of = grasp.contacts[other];
      if (of.p_P_mm.head<2>() == contact.p_P_mm.head<2>() && of.n_P == contact.n_P && of.jaw == contact.jaw)
        pin = pins[other];
    }
    pins.push_back(pin < 0 ? count++ : pin);
  }
  return pins;
}

void put_pin(int pin, const Vector3d& arm, double half_width, kernel::Program& program) {
  const Column up = column_of(arm, Vector3d::UnitZ());
  put(up, half_width, program.column[kernel::kUpwards + pin]);
  put(up, -half_width, program.column[kernel::kDownwards + pin]);
}

void put_plan_ray(int ray, int pin, const Vector3d& arm, const Vector3d& force, double half_width,
                  kernel::Program& program) {
  const Column middle = column_of(arm, force);
  const Column up = column_of(arm, half_width * Vector3d::UnitZ());
  for (int k = 0; k < 3; ++k) {
    program.plan[k + 2][ray] = middle[static_cast<std::size_t>(k + 3)];
    program.lift[k][ray] = up[static_cast<std::size_t>(k + 2)];
  }
  program.plan[0][ray] = middle[0];
  program.plan[1][ray] = middle[1];
  put(middle, 1, program.column[kernel::kMiddle + ray]);
  for (int k = 0; k < kernel::kRows; ++k) {
    const auto row = static_cast<std::size_t>(k);
    program.column[ray][k] = middle[row] + up[row];
    program.column[ray + kernel::kPlanRays][k] = middle[row] - up[row];
  }
  program.pin_of_ray[ray] = static_cast<std::uint8_t>(pin);
  program.rays_of_pin[pin] |= 1U << ray;
}

/// Shares spread evenly from -1 to 1, no two alike.
double set_apart(double cost, int ray) {
  const double share = 2 * std::fmod((ray + 1) / std::numbers::phi, 1.0) - 1;
  return cost * (1 + kernel::kApart * share);
}

}  // namespace

void fill_program(const Grasp& grasp, const GraspFrame& frame, double half_width, kernel::Program& program) {
  program = {};
  std::fill(std::begin(program.cost), std::end(program.cost), 1.0);
  program.least_cost = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kernel::kRows; ++k) program.column[kernel::kUnit + k][k] = 1;
  const std::vector<int> pins = pins_of(grasp);
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const PointContact& contact = grasp.contacts[i];
    const Vector3d arm = (contact.p_P_mm - frame.p_PMean_mm) / frame.length_mm;
    put_pin(pins[i], arm, half_width, program);
    const std::array<Vector3d, 4> edges = pyramid_rays(contact, half_width);
    for (int k = 0; k < 2; ++k) {
      const int ray = 2 * static_cast<int>(i) + k;
      const Vector2d flat = edges[static_cast<std::size_t>(k)].head<2>();
      put_plan_ray(ray, pins[i], arm, {flat.x(), flat.y(), 0}, half_width, program);
      program.cost[ray] = set_apart(squeeze_share(grasp, contact, edges[static_cast<std::size_t>(k)]), ray);
      program.least_cost = std::min(program.least_cost, program.cost[ray]);
    }
  }
}

RayProgram ray_program_of(const Grasp& grasp, const GraspFrame& frame, double half_width) {
  RayProgram program;
  for (const PointContact& contact : grasp.contacts) {
    const Vector3d arm = (contact.p_P_mm - frame.p_PMean_mm) / frame.length_mm;
    for (const Vector3d& ray : pyramid_rays(contact, half_width)) {
      program.columns.push_back(column_of(arm, ray));
      program.cost.push_back(squeeze_share(grasp, contact, ray));
    }
  }
  return program;
}

namespace {

/// Column of RayProgram for plan ray `ray` with the vertical force up or down.
int ray_column(int ray, bool up) {
  return ray / 2 * 4 + ray % 2 + (up ? 2 : 0);
}

}  // namespace

std::vector<RayAmount> balancing_rays(const kernel::Program& program, const kernel::Vertex& vertex,
                                      const RightHandSide& b) {
  std::array<double, kernel::kPlanRays> of_ray{};
  std::array<double, kernel::kMaxPins> up{};
  std::array<double, kernel::kMaxPins> down{};
  for (int i = 0; i < kernel::kLanes; ++i) {
    double x = 0;
    for (int k = 0; k < kernel::kRows; ++k) x += vertex.inverse[k][i] * b[static_cast<std::size_t>(k)];
    const auto what = static_cast<std::size_t>(kernel::lane_of(vertex.lanes, i));
    if (what >= kernel::lane::kLogical) continue;
    if (what >= kernel::lane::kDown) {
      down[what - kernel::lane::kDown] = std::max(0.0, x);
    } else if (what >= kernel::lane::kUp) {
      up[what - kernel::lane::kUp] = std::max(0.0, x);
    } else {
      of_ray[what] = std::max(0.0, x);
    }
  }
  std::vector<RayAmount> rays;
  for (std::size_t pin = 0; pin < up.size(); ++pin) {
    const std::uint32_t tight_up = vertex.tight & program.rays_of_pin[pin];
    const std::uint32_t tight_down = (vertex.tight >> kernel::kPlanRays) & program.rays_of_pin[pin];
    const bool sticks = (tight_up & tight_down) != 0;
    const bool alone = sticks && std::has_single_bit(tight_up);
    // a sticking pin's rays point up as far as `up` goes; one is split, the rest point down
    double left = up[pin];
    bool split = false;
    for (int ray = 0; ray < kernel::kPlanRays; ++ray) {
      if ((((tight_up | tight_down) >> ray) & 1U) == 0) continue;
      const double amount = alone ? up[pin] + down[pin] : of_ray[static_cast<std::size_t>(ray)];
      if (!sticks) {
        rays.push_back({ray_column(ray, tight_up != 0), amount});
      } else if (!split && (amount < left) && (tight_up >> ray) > 1) {
        rays.push_back({ray_column(ray, true), amount});
        left -= amount;
      } else if (!split) {
        split = true;
        const double upwards = std::min(left, amount);
        rays.push_back({ray_column(ray, true), upwards});
        rays.push_back({ray_column(ray, false), amount - upwards});
      } else {
        rays.push_back({ray_column(ray, false), amount});
      }
    }
  }
  return rays;
}

}  // namespace pinjaw::planner

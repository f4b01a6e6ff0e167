#include "tests/bench/force/cases.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "host/base/random.hpp"
#include "host/config/read.hpp"
#include "host/planner/force/closure.hpp"
#include "host/planner/force/disturbances.hpp"
#include "host/planner/plan/plan.hpp"
#include "tests/host/planner/force/zoo.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::bench {
namespace {

using planner::Grasp;
using planner::PointContact;
using planner::Vector2d;
using planner::Vector3d;

std::unique_ptr<Case> case_of(const Grasp& grasp, std::vector<model::Wrench> wrenches) {
  auto one = std::make_unique<Case>();
  one->grasp = grasp;
  const planner::GraspFrame frame = planner::frame_of(grasp);
  const double half_width = grasp.mu / std::sqrt(2.0);
  planner::fill_program(grasp, frame, half_width, one->program);
  one->rays = planner::ray_program_of(grasp, frame, half_width);
  one->wrenches = std::move(wrenches);
  for (const model::Wrench& wrench : one->wrenches) one->right.push_back(frame.right_hand_side(wrench));
  constexpr auto kLanes = static_cast<std::size_t>(planner::kernel::kLanes);
  one->loads.resize(static_cast<std::size_t>(kStride) * planner::kernel::kRows / kLanes);
  for (std::size_t i = 0; i < one->right.size(); ++i) {
    for (std::size_t k = 0; k < one->right[i].size(); ++k)
      one->loads[(k * kStride + i) / kLanes].b[i % kLanes] = one->right[i][k];
  }
  return one;
}

bool usable(const Grasp& grasp) {
  return grasp.contacts.size() == Grasp::kMaxContacts && !planner::jamming_contact(grasp) &&
         !planner::wedging_jaw(grasp);
}

/// A convex polygon, counter-clockwise, as an upright prism on z = 0.
struct Prism {
  std::vector<Vector2d> corners_mm;
  double height_mm = 20;

  [[nodiscard]] Vector2d corner(std::size_t i) const { return corners_mm[i % corners_mm.size()]; }
  [[nodiscard]] Vector2d outward(std::size_t edge) const {
    const Vector2d along = (corner(edge + 1) - corner(edge)).normalized();
    return {along.y(), -along.x()};
  }
};

Prism random_prism(base::Random& random) {
  Prism prism;
  const int corners = 7 + static_cast<int>(random.uniform(0, 5));
  const double a_mm = random.uniform(22, 30);
  const double b_mm = random.uniform(18, 26);
  std::vector<double> angles_rad;
  for (int i = 0; i < corners; ++i)
    angles_rad.push_back(2 * std::numbers::pi * (i + random.uniform(-0.35, 0.35)) / corners);
  for (const double angle : angles_rad)
    prism.corners_mm.emplace_back(a_mm * std::cos(angle), b_mm * std::sin(angle));
  return prism;
}

model::Wrench force_at(const Vector3d& p_mm, const Vector3d& force_n) {
  model::Wrench wrench;
  wrench << force_n, p_mm.cross(force_n);
  return wrench;
}

/// The force of a spray along a random line, where the line meets the prism.
std::optional<model::Wrench> random_spray(const Prism& prism, base::Random& random) {
  Vector3d along(random.normal(), random.normal(), random.normal());
  along.normalize();
  const Vector3d from(random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-30, 50));
  double enter = -1e9;
  double leave = 1e9;
  Vector3d normal = Vector3d::Zero();
  const auto clip = [&](const Vector3d& outward, double offset_mm) {
    const double towards = outward.dot(along);
    const double distance_mm = offset_mm - outward.dot(from);
    if (towards < 0 && distance_mm / towards > enter) {
      enter = distance_mm / towards;
      normal = outward;
    }
    if (towards > 0) leave = std::min(leave, distance_mm / towards);
  };
  for (std::size_t edge = 0; edge < prism.corners_mm.size(); ++edge) {
    const Vector2d n = prism.outward(edge);
    clip({n.x(), n.y(), 0}, n.dot(prism.corner(edge)));
  }
  clip(Vector3d::UnitZ(), prism.height_mm);
  clip(-Vector3d::UnitZ(), 0);
  if (enter >= leave) return std::nullopt;
  constexpr double kSpray_n = 8.4;
  return force_at(from + enter * along, -kSpray_n * normal);
}

/// A pin on a random edge that the jaw can press; two points.
bool add_pin(const Prism& prism, model::JawSide jaw, int pin, base::Random& random, Grasp& grasp) {
  const auto edge = static_cast<std::size_t>(random.uniform(0, static_cast<double>(prism.corners_mm.size())));
  const Vector2d inward = -prism.outward(edge);
  const double closing = jaw == model::JawSide::Left ? inward.x() : -inward.x();
  if (closing < 0.25) return false;
  const Vector2d p_mm =
      prism.corner(edge) + random.uniform(0.1, 0.9) * (prism.corner(edge + 1) - prism.corner(edge));
  const double low_mm = random.uniform(0, 4);
  const double high_mm = random.uniform(9, 18);
  for (const double z_mm : {low_mm, high_mm})
    grasp.contacts.push_back({Vector3d(p_mm.x(), p_mm.y(), z_mm), inward, jaw, pin});
  return true;
}

std::optional<Grasp> random_grasp(const Prism& prism, base::Random& random) {
  Grasp grasp;
  grasp.mu = 0.2;
  const int left = 1 + static_cast<int>(random.uniform(0, 3));
  for (int pin = 0; pin < 4; ++pin) {
    if (!add_pin(prism, pin < left ? model::JawSide::Left : model::JawSide::Right, pin, random, grasp))
      return std::nullopt;
  }
  Eigen::Matrix<double, 3, 4> w;
  for (int i = 0; i < 4; ++i) {
    const PointContact& foot = grasp.contacts[2 * static_cast<std::size_t>(i)];
    w.col(i) << foot.n_P, (foot.p_P_mm.x() * foot.n_P.y() - foot.p_P_mm.y() * foot.n_P.x()) / 25;
  }
  const Eigen::FullPivLU<Eigen::Matrix<double, 3, 4>> lu(w);
  if (lu.rank() < 3) return std::nullopt;
  const Eigen::Vector4d null = lu.kernel().col(0).normalized();
  if (null.minCoeff() < 0.02 && null.maxCoeff() > -0.02) return std::nullopt;
  if (!usable(grasp)) return std::nullopt;
  return grasp;
}

}  // namespace

Cases planned_cases(int count) {
  auto task = config::read_task(test::source_dir("configs/tasks/valve-pedestal.yaml"));
  if (!task) throw std::runtime_error(base::render(task.error(), "no task"));
  const auto scene = planner::read_scene(*task);
  if (!scene) throw std::runtime_error(scene.error().message);
  const auto plan = planner::make_plan(*task, *scene, {.top = 0});
  if (!plan) throw std::runtime_error(plan.error().message);
  std::vector<model::Wrench> wrenches = planner::turned_wrenches(plan->disturbances, plan->side);
  const Vector3d lift_n(0, 0, 11);
  const Vector3d& centroid_mm = plan->part.centroid_mm;
  wrenches.resize(std::min<std::size_t>(wrenches.size(), kLoads - 2));
  while (wrenches.size() + 2 < kLoads) wrenches.push_back(wrenches[wrenches.size() % 7]);
  wrenches.push_back(force_at(centroid_mm, lift_n));
  wrenches.push_back(force_at(centroid_mm, -lift_n));
  Cases cases;
  const std::size_t step =
      std::max<std::size_t>(1, plan->designs.size() / static_cast<std::size_t>(3 * count));
  for (std::size_t i = 0; i < plan->designs.size() && static_cast<int>(cases.size()) < count; i += step) {
    const Grasp grasp = planner::grasp_of(plan->designs[i], plan->friction);
    if (usable(grasp)) cases.push_back(case_of(grasp, wrenches));
  }
  return cases;
}

Cases convex_part_cases(int count) {
  base::Random random(1);
  Cases cases;
  while (static_cast<int>(cases.size()) < count) {
    const Prism prism = random_prism(random);
    std::optional<Grasp> grasp;
    for (int attempt = 0; attempt < 5000 && !grasp; ++attempt) grasp = random_grasp(prism, random);
    if (!grasp) continue;
    std::vector<model::Wrench> wrenches;
    while (wrenches.size() + 2 < kLoads) {
      if (const auto spray = random_spray(prism, random)) wrenches.push_back(*spray);
    }
    for (const double lift_n : {11.0, -11.0})
      wrenches.push_back(force_at({0, 0, prism.height_mm / 2}, {0, 0, lift_n}));
    cases.push_back(case_of(*grasp, wrenches));
  }
  return cases;
}

Cases random_wrench_cases(int count) {
  using planner::zoo::Family;
  base::Random random(1);
  Cases cases;
  while (static_cast<int>(cases.size()) < count) {
    const Grasp grasp = planner::zoo::random_grasp(Family::FormClosed, random);
    if (!usable(grasp)) continue;
    std::vector<model::Wrench> wrenches;
    while (wrenches.size() < kLoads)
      wrenches.push_back(planner::zoo::random_wrench(Family::FormClosed, grasp, random));
    cases.push_back(case_of(grasp, wrenches));
  }
  return cases;
}

}  // namespace pinjaw::bench

#include "tests/host/planner/force/zoo.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>

namespace pinjaw::planner::zoo {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A pin's foot on a roundish part of some 50 mm, the normal up to `steepest_rad` from the closing axis.
PointContact random_foot(model::JawSide jaw, double steepest_rad, base::Random& random) {
  const double towards_rad = jaw == model::JawSide::Left ? 0 : std::numbers::pi;
  const double angle_rad = towards_rad + random.uniform(-steepest_rad, steepest_rad);
  const Vector2d n(std::cos(angle_rad), std::sin(angle_rad));
  const Vector2d t(-n.y(), n.x());
  const Vector2d p = -random.uniform(18, 27) * n + random.uniform(-12, 12) * t;
  return {{p.x(), p.y(), 0}, n, jaw, 0};
}

/// Strict planar form closure: the 3 x 4 normal wrenches have a null vector of one strict sign.
bool form_closed(const std::array<PointContact, 4>& feet) {
  Eigen::Matrix<double, 3, 4> w;
  for (int i = 0; i < 4; ++i) {
    const PointContact& foot = feet[static_cast<std::size_t>(i)];
    const double torque = foot.p_P_mm.x() * foot.n_P.y() - foot.p_P_mm.y() * foot.n_P.x();
    w.col(i) << foot.n_P.x(), foot.n_P.y(), torque / 25;
  }
  const Eigen::Vector4d null = Eigen::FullPivLU<Eigen::Matrix<double, 3, 4>>(w).kernel().col(0).normalized();
  return null.minCoeff() > 0.02 || null.maxCoeff() < -0.02;
}

std::array<PointContact, 4> random_feet(double steepest_rad, bool want_closed, base::Random& random) {
  while (true) {
    const int split = static_cast<int>(random.uniform(0, 3));  // 2+2, 3+1, 1+3
    const int left = split == 0 ? 2 : split == 1 ? 3 : 1;
    std::array<PointContact, 4> feet;
    for (int i = 0; i < 4; ++i) {
      auto& foot = feet[static_cast<std::size_t>(i)];
      foot = random_foot(i < left ? model::JawSide::Left : model::JawSide::Right, steepest_rad, random);
      foot.pin = i;
    }
    if (!want_closed || form_closed(feet)) return feet;
  }
}

/// Each foot at one height or two, `apart_mm` apart (below 0: 4 to 15 mm).
void raise(Grasp& grasp, const std::array<PointContact, 4>& feet, double two_points, double apart_mm,
           base::Random& random) {
  for (PointContact foot : feet) {
    foot.p_P_mm.z() = random.uniform(0, 8);
    grasp.contacts.push_back(foot);
    if (random.uniform() >= two_points) continue;
    foot.p_P_mm.z() += apart_mm < 0 ? random.uniform(4, 15) : apart_mm;
    grasp.contacts.push_back(foot);
  }
}

Grasp symmetric_box() {
  Grasp grasp;
  grasp.mu = 0.2;
  int pin = 0;
  for (const double x : {-20.0, 20.0}) {
    for (const double y : {-10.0, 10.0}) {
      for (const double z : {-5.0, 5.0}) {
        const model::JawSide jaw = x < 0 ? model::JawSide::Left : model::JawSide::Right;
        grasp.contacts.push_back({{x, y, z}, Vector2d(x < 0 ? 1 : -1, 0), jaw, pin});
      }
      ++pin;
    }
  }
  return grasp;
}

Grasp two_contacts(base::Random& random) {
  Grasp grasp;
  grasp.mu = 0.3;
  const double offset = random.uniform(-2, 2);
  grasp.contacts = {{{-20, offset, random.uniform(-1, 1)}, Vector2d(1, 0), model::JawSide::Left, 0},
                    {{20, offset + random.uniform(-1, 1), 0}, Vector2d(-1, 0), model::JawSide::Right, 1}};
  return grasp;
}

void turn_and_move(Grasp& grasp, double angle_rad, const Vector3d& t_mm) {
  const geometry::Pose2 turn{angle_rad, Vector2d::Zero()};
  grasp.x_P = turn.turned(grasp.x_P);
  for (PointContact& contact : grasp.contacts) {
    contact.n_P = turn.turned(contact.n_P);
    contact.p_P_mm.head<2>() = turn * Vector2d(contact.p_P_mm.head<2>());
    contact.p_P_mm += t_mm;
  }
}

}  // namespace

std::vector<Family> all_families() {
  return {Family::FormClosed,   Family::Mixed,      Family::NotFormClosed,  Family::OnePointAPin,
          Family::TwoContacts,  Family::NoFriction, Family::LittleFriction, Family::HardlyAnyFriction,
          Family::SymmetricBox, Family::Doubled,    Family::Steep,          Family::NearCoincident,
          Family::FarFromOrigin};
}

std::string name_of(Family family) {
  static const std::array<const char*, 13> names{
      "form_closed", "mixed",           "not_form_closed",     "one_point_a_pin", "two_contacts",
      "no_friction", "little_friction", "hardly_any_friction", "symmetric_box",   "doubled",
      "steep",       "near_coincident", "far_from_origin"};
  return names.at(static_cast<std::size_t>(family));
}

Grasp random_grasp(Family family, base::Random& random) {
  if (family == Family::SymmetricBox) return symmetric_box();
  if (family == Family::TwoContacts) return two_contacts(random);
  Grasp grasp;
  grasp.mu = 0.2;
  if (family == Family::NoFriction) grasp.mu = 0;
  if (family == Family::LittleFriction) grasp.mu = 1e-4;
  if (family == Family::HardlyAnyFriction) grasp.mu = 1e-6;
  const double steepest_rad = (family == Family::Steep ? 100 : 75) * kDegree;
  const auto feet = random_feet(steepest_rad, family != Family::NotFormClosed, random);
  switch (family) {
    case Family::Mixed:
      raise(grasp, feet, 0.5, -1, random);
      break;
    case Family::OnePointAPin:
    case Family::Doubled:
      raise(grasp, feet, 0, -1, random);
      break;
    case Family::NearCoincident:
      raise(grasp, feet, 1, std::pow(10, random.uniform(-9, -6)), random);
      break;
    default:
      raise(grasp, feet, 1, -1, random);
      break;
  }
  if (family == Family::Doubled) {
    const std::vector<PointContact> once = grasp.contacts;
    grasp.contacts.insert(grasp.contacts.end(), once.begin(), once.end());
  }
  const Vector3d t_mm = family == Family::FarFromOrigin ? Vector3d(2000, -1500, 800) : Vector3d::Zero();
  turn_and_move(grasp, random.uniform(0, 2 * std::numbers::pi), t_mm);
  return grasp;
}

model::Wrench random_wrench(Family family, const Grasp& grasp, base::Random& random) {
  model::Wrench wrench = model::Wrench::Zero();
  if (family == Family::SymmetricBox) {
    wrench[static_cast<int>(random.uniform(0, 6))] = random.uniform() < 0.5 ? 10 : -10;
    return wrench;
  }
  Vector3d force(random.normal(), random.normal(), random.normal());
  if (random.uniform() < 0.3) force.z() = 0;  // in the plane: no vertical force to share out
  force *= 8.4 / force.norm();
  Vector3d p_mm = grasp.contacts.front().p_P_mm;
  if (family != Family::FarFromOrigin) p_mm.setZero();
  for (int k = 0; k < 3; ++k) p_mm[k] += random.uniform(-20, 20);
  wrench << force, p_mm.cross(force);
  return wrench;
}

}  // namespace pinjaw::planner::zoo

#include "host/planner/planar/contact_state.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pinjaw::planner::planar {
namespace {

using geometry::cross;

constexpr double kSolved_mm = 1e-10;  // chosen: a thousandth of the foot tolerance
constexpr double kLeastMinors_mm =
    1e-6;                   // chosen: above rounding; where all contact lines meet the part can turn
constexpr int kSteps = 12;  // Newton doubles digits a step; seeds are good to 1e-4 mm
constexpr double kLargestTurn_rad = 0.05;  // chosen: further away is another root, which has its own seed

Vector2d turned(double c, double s, const Vector2d& v) {
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}
template <int Count>
bool polished(std::span<const Touch> touches, Placement& placement) {
  const double start_rad = placement.theta_rad;
  Eigen::Matrix<double, Count, Count> gradient;
  Eigen::Matrix<double, Count, 1> miss;
  bool again = true;
  for (int step = 0; step < kSteps; ++step) {
    for (int k = 0; k < Count; ++k) {
      const Touch& touch = touches[static_cast<std::size_t>(k)];
      const ContactState state = contact_at(touch, placement);
      miss(k) = state.miss_mm;
      gradient(k, 0) = cross(state.lever_mm, state.normal);
      gradient(k, 1) = state.normal.y();
      gradient(k, 2) = touch.left ? state.normal.x() : 0.0;
      if constexpr (Count == 4) gradient(k, 3) = touch.left ? 0.0 : state.normal.x();
    }
    const double worst_mm = miss.cwiseAbs().maxCoeff();
    if (!std::isfinite(worst_mm)) return false;
    if (worst_mm < kSolved_mm && !again) return true;
    again = worst_mm >= kSolved_mm;  // one more step after success takes the last digits
    const Eigen::Matrix<double, Count, 1> change = gradient.partialPivLu().solve(miss);
    placement.theta_rad += change(0);
    placement.y_mm += change(1);
    placement.x_left_mm += change(2);
    if constexpr (Count == 4) placement.x_right_mm += change(3);
    if (!(std::abs(placement.theta_rad - start_rad) < kLargestTurn_rad)) return false;
  }
  return false;
}

}  // namespace

Touch touch_of(const ContactCurve& curve, bool left, int column, int row, double spacing_mm) {
  return {&curve, left, column, row, spacing_mm * Vector2d(left ? -column : column, row)};
}

ContactState contact_at(const Touch& touch, const Placement& placement) {
  const ContactCurve& curve = *touch.curve;
  const double c = std::cos(placement.theta_rad);
  const double s = std::sin(placement.theta_rad);
  ContactState state;
  state.lever_mm =
      touch.hole_mm - Vector2d(touch.left ? placement.x_left_mm : placement.x_right_mm, placement.y_mm);
  if (!curve.arc) {
    state.normal = turned(c, s, curve.normal);
    state.miss_mm = state.normal.dot(state.lever_mm) - curve.offset_mm;
    return state;
  }
  const Vector2d radial = state.lever_mm - turned(c, s, curve.center_mm);
  const double length_mm = radial.norm();
  state.normal = curve.kappa / length_mm * radial;
  state.miss_mm = curve.kappa * (length_mm - curve.rho_mm);
  return state;
}

double x_where_it_touches(const Touch& touch, double theta_rad, double y_mm) {
  const ContactCurve& curve = *touch.curve;
  const double c = std::cos(theta_rad);
  const double s = std::sin(theta_rad);
  const double up_mm = touch.hole_mm.y() - y_mm;
  if (!curve.arc) {
    const Vector2d n = turned(c, s, curve.normal);
    return touch.hole_mm.x() - (curve.offset_mm - n.y() * up_mm) / n.x();
  }
  const Vector2d center = turned(c, s, curve.center_mm);
  const double rise_mm = up_mm - center.y();
  const double along_mm = std::sqrt(std::max(0.0, curve.rho_mm * curve.rho_mm - rise_mm * rise_mm));
  const double outwards = touch.left ? -curve.kappa : curve.kappa;
  return touch.hole_mm.x() - center.x() - outwards * along_mm;
}

bool polish(std::span<const Touch> touches, Placement& placement) {
  return touches.size() == 4 ? polished<4>(touches, placement) : polished<3>(touches, placement);
}

std::array<double, 4> closure_multipliers(const std::array<ContactState, 4>& contacts) {
  std::array<Vector2d, 4> force;
  std::array<double, 4> moment{};
  for (std::size_t k = 0; k < 4; ++k) {
    force[k] = -contacts[k].normal;
    moment[k] = cross(contacts[k].lever_mm, force[k]);
  }
  const auto minor = [&](std::size_t i, std::size_t j, std::size_t k) {
    return moment[i] * cross(force[j], force[k]) + moment[j] * cross(force[k], force[i]) +
           moment[k] * cross(force[i], force[j]);
  };
  std::array<double, 4> multipliers{minor(1, 2, 3), -minor(0, 2, 3), minor(0, 1, 3), -minor(0, 1, 2)};
  double sum = 0;
  double largest = 0;
  for (const double value : multipliers) {
    sum += std::abs(value);
    if (std::abs(value) > std::abs(largest)) largest = value;
  }
  if (sum < kLeastMinors_mm) return {0, 0, 0, 0};
  for (double& value : multipliers) value /= largest < 0 ? -sum : sum;
  return multipliers;
}

}  // namespace pinjaw::planner::planar

#include "host/planner/interference/adjustment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pinjaw::planner {
namespace {

using geometry::Interval;
using geometry::Pose2;
using geometry::Vector2d;
using model::Side;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kAngleTolerance = 1e-9;      ///< chosen: rounding of the closed forms that angles come from
constexpr double kOffsetTolerance_mm = 1e-6;  ///< the same for lengths

Vector2d mirrored(const Vector2d& v) {
  return {-v.x(), v.y()};
}

/// `hold` and `adjustment` as a gripper from below would say them: turning by pi about y mirrors x and the
/// sense of angles.
Pose2 from_below(const Hold& hold) {
  if (hold.side == Side::Below) return hold.part_pose;
  return {-hold.part_pose.theta_rad, mirrored(hold.part_pose.t_mm)};
}

/// Its own inverse.
Adjustment from_below(Side side, const Adjustment& adjustment) {
  if (side == Side::Below) return adjustment;
  return {-adjustment.theta_rad, mirrored(adjustment.offset_mm)};
}

double principal(double angle_rad) {
  const double wrapped = geometry::wrapped_rad(angle_rad);
  return wrapped > std::numbers::pi ? wrapped - kTurn : wrapped;
}

Vector2d turned(double angle_rad, const Vector2d& v) {
  return Pose2{angle_rad, Vector2d::Zero()}.turned(v);
}

Interval negated(const Interval& i) {
  return {-i.hi, -i.lo};
}

/// Bounds as a gripper from below would say them.
model::Adjust from_below(Side side, const model::Adjust& bounds) {
  if (side == Side::Below) return bounds;
  return {negated(bounds.x_mm), bounds.y_mm, negated(bounds.theta_rad)};
}

/// The value nearest to 0 in both `a` and `b` moved by `shift`; nothing where they are apart by more than
/// `tolerance`.
std::optional<double> least_common(const Interval& a, const Interval& b, double shift, double tolerance) {
  const double lo = std::max(a.lo, b.lo + shift);
  const double hi = std::min(a.hi, b.hi + shift);
  if (lo > hi + tolerance) return std::nullopt;
  return lo > hi ? (lo + hi) / 2 : std::clamp(0.0, lo, hi);
}

std::optional<double> least_common_angle(const Interval& a, const Interval& b, double shift) {
  std::optional<double> best;
  for (int turns = -3; turns <= 3; ++turns) {
    const auto angle = least_common(a, b, shift + turns * kTurn, kAngleTolerance);
    if (angle && (!best || std::abs(*angle) < std::abs(*best))) best = angle;
  }
  return best;
}

bool holds(const Interval& range, double value, double tolerance) {
  return range.lo - tolerance <= value && value <= range.hi + tolerance;
}

}  // namespace

Adjustment required_adjustment(const Hold& known_hold, const Adjustment& known, const Hold& hold) {
  const Pose2 there = from_below(known_hold);
  const Pose2 here = from_below(hold);
  const Adjustment at = from_below(known_hold.side, known);
  Adjustment needed;
  needed.theta_rad = at.theta_rad + there.theta_rad - here.theta_rad;
  needed.offset_mm = turned(at.theta_rad, there.t_mm) + at.offset_mm - turned(needed.theta_rad, here.t_mm);
  needed = from_below(hold.side, needed);
  needed.theta_rad = principal(needed.theta_rad);
  return needed;
}

bool within(const Adjustment& adjustment, const model::Adjust& bounds) {
  if (!holds(bounds.x_mm, adjustment.offset_mm.x(), kOffsetTolerance_mm)) return false;
  if (!holds(bounds.y_mm, adjustment.offset_mm.y(), kOffsetTolerance_mm)) return false;
  for (const int turns : {-1, 0, 1}) {
    if (holds(bounds.theta_rad, adjustment.theta_rad + turns * kTurn, kAngleTolerance)) return true;
  }
  return false;
}

std::optional<PairAdjustment> pair_adjustment(const Hold& giver, const model::Adjust& giver_bounds,
                                              const Hold& receiver, const model::Adjust& receiver_bounds) {
  const Pose2 give = from_below(giver);
  const Pose2 receive = from_below(receiver);
  const model::Adjust gives = from_below(giver.side, giver_bounds);
  const model::Adjust receives = from_below(receiver.side, receiver_bounds);
  const auto theta =
      least_common_angle(gives.theta_rad, receives.theta_rad, receive.theta_rad - give.theta_rad);
  if (!theta) return std::nullopt;
  const double receiver_theta = *theta + give.theta_rad - receive.theta_rad;
  const Vector2d shift_mm = turned(receiver_theta, receive.t_mm) - turned(*theta, give.t_mm);
  const auto x_mm = least_common(gives.x_mm, receives.x_mm, shift_mm.x(), kOffsetTolerance_mm);
  const auto y_mm = least_common(gives.y_mm, receives.y_mm, shift_mm.y(), kOffsetTolerance_mm);
  if (!x_mm || !y_mm) return std::nullopt;
  Adjustment of_giver = from_below(giver.side, {*theta, {*x_mm, *y_mm}});
  of_giver.theta_rad = principal(of_giver.theta_rad);
  return PairAdjustment{of_giver, required_adjustment(giver, of_giver, receiver)};
}

}  // namespace pinjaw::planner

#include "host/cell/hold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pinjaw::cell {
namespace {

using geometry::Interval;
using geometry::Pose2;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kAngleTolerance_rad = 1e-9;  // chosen: rounding of the closed forms that angles come from
constexpr double kOffsetTolerance_mm = 1e-6;  // the same for lengths

Vector2d mirrored(const Vector2d& v) {
  return {-v.x(), v.y()};
}
Interval negated(const Interval& range) {
  return {-range.hi, -range.lo};
}
Vector2d turned(double angle_rad, const Vector2d& v) {
  return Pose2{angle_rad, Vector2d::Zero()}.turned(v);
}
double nearest_to_zero(const Interval& range) {
  return std::clamp(0.0, range.lo, range.hi);
}

bool holds(const Interval& range, double value, double tolerance) {
  return range.lo - tolerance <= value && value <= range.hi + tolerance;
}

/// `angle_rad` moved by whole turns to the least value not under the range.
double lifted(double angle_rad, const Interval& range) {
  return range.lo - kAngleTolerance_rad + geometry::wrapped_rad(angle_rad - range.lo + kAngleTolerance_rad);
}

bool angle_in(const Interval& range, double angle_rad) {
  return lifted(angle_rad, range) <= range.hi + kAngleTolerance_rad;
}

/// Angles in which `v`, turned, may come into or leave the box.
std::vector<double> border_angles(const Vector2d& v, const Interval& x_mm, const Interval& y_mm) {
  std::vector<double> angles;
  const double length_mm = v.norm();
  const double phase_rad = std::atan2(v.y(), v.x());
  const auto add = [&](double level_mm, double axis_rad) {
    if (length_mm <= 0 || std::abs(level_mm) > length_mm) return;
    const double half_rad = std::acos(level_mm / length_mm);
    angles.push_back(axis_rad + half_rad - phase_rad);
    angles.push_back(axis_rad - half_rad - phase_rad);
  };
  for (const double level_mm : {x_mm.lo, x_mm.hi}) add(level_mm, 0);
  for (const double level_mm : {y_mm.lo, y_mm.hi}) add(level_mm, std::numbers::pi / 2);
  return angles;
}

/// Where a station that says where the part is stands.
Vector2d standing_mm(const PlanBounds& bounds) {
  return {nearest_to_zero(bounds.adjust.x_mm), nearest_to_zero(bounds.adjust.y_mm)};
}

bool turns_freely(const PlanBounds& bounds) {
  return bounds.adjust.theta_rad.length() >= kTurn - kAngleTolerance_rad;
}

}  // namespace

PlanHold::PlanHold(const planner::Hold& hold) : X_GP(hold.part_pose) {
  if (hold.side == model::Side::Above) X_GP = {-hold.part_pose.theta_rad, mirrored(hold.part_pose.t_mm)};
  origin_P_mm = X_GP.inverse().t_mm;
}

PlanBounds::PlanBounds(model::Side station_side, const model::Adjust& bounds)
    : side(station_side), adjust(bounds) {
  if (side == model::Side::Above) adjust = {negated(bounds.x_mm), bounds.y_mm, negated(bounds.theta_rad)};
}

bool adjustable(const PlanHold& giver, const PlanBounds& gives, const PlanHold& receiver,
                const PlanBounds& receives) {
  const model::Adjust& a = gives.adjust;
  const model::Adjust& b = receives.adjust;
  // With the giver at theta and 0, the receiver stands at theta + between and R(theta) v.
  const double between_rad = giver.X_GP.theta_rad - receiver.X_GP.theta_rad;
  const Vector2d v = giver.X_GP.turned(receiver.origin_P_mm - giver.origin_P_mm);
  const Interval x_mm{b.x_mm.lo - a.x_mm.hi, b.x_mm.hi - a.x_mm.lo};
  const Interval y_mm{b.y_mm.lo - a.y_mm.hi, b.y_mm.hi - a.y_mm.lo};
  const auto fits = [&](double theta_rad) {
    if (!angle_in(a.theta_rad, theta_rad) || !angle_in(b.theta_rad, theta_rad + between_rad)) return false;
    const Vector2d offset_mm = turned(theta_rad, v);
    return holds(x_mm, offset_mm.x(), kOffsetTolerance_mm) && holds(y_mm, offset_mm.y(), kOffsetTolerance_mm);
  };
  for (const double theta_rad :
       {a.theta_rad.lo, a.theta_rad.hi, b.theta_rad.lo - between_rad, b.theta_rad.hi - between_rad}) {
    if (fits(theta_rad)) return true;
  }
  return std::ranges::any_of(border_angles(v, x_mm, y_mm), fits);
}

References references_of(std::span<const PlanBounds> bounds) {
  References references;
  for (std::size_t i = 1; i < bounds.size(); ++i) {
    const model::Adjust& adjust = bounds[i].adjust;
    const model::Adjust& least_turn = bounds[references.theta].adjust;
    const model::Adjust& least_move = bounds[references.offset].adjust;
    if (adjust.theta_rad.length() < least_turn.theta_rad.length()) references.theta = i;
    if (adjust.x_mm.length() + adjust.y_mm.length() < least_move.x_mm.length() + least_move.y_mm.length()) {
      references.offset = i;
    }
  }
  return references;
}

Pose2 part_in_handoff_frame(const PlanHold& turns_least, const PlanBounds& theta_bounds,
                            const PlanHold& moves_least, const PlanBounds& offset_bounds) {
  const double part_rad = nearest_to_zero(theta_bounds.adjust.theta_rad) + turns_least.X_GP.theta_rad;
  const Vector2d origin_mm = standing_mm(offset_bounds);
  return {part_rad, origin_mm - turned(part_rad, moves_least.origin_P_mm)};
}

planner::Adjustment adjustment_for(const PlanHold& hold, model::Side side, const Pose2& X_HP) {
  planner::Adjustment adjustment;
  adjustment.theta_rad = std::remainder(X_HP.theta_rad - hold.X_GP.theta_rad, kTurn);
  adjustment.offset_mm = X_HP * hold.origin_P_mm;
  if (side == model::Side::Above) {
    adjustment.theta_rad = -adjustment.theta_rad;
    adjustment.offset_mm = mirrored(adjustment.offset_mm);
  }
  return adjustment;
}

TurnsInReach turns_in_reach(const PlanHold& hold, const PlanBounds& bounds, const PlanHold& moves_least,
                            const PlanBounds& offset_bounds) {
  // The station's offset turns with the part on a circle about where `moves_least` stands.
  const double radius_mm = (hold.origin_P_mm - moves_least.origin_P_mm).norm();
  const Vector2d middle_mm = standing_mm(offset_bounds);
  const auto to_ends_mm = [](const Interval& range, double at_mm) {
    return std::array{at_mm - range.lo, range.hi - at_mm};
  };
  const auto x_mm = to_ends_mm(bounds.adjust.x_mm, middle_mm.x());
  const auto y_mm = to_ends_mm(bounds.adjust.y_mm, middle_mm.y());
  const double corner_mm = std::hypot(std::max(x_mm[0], x_mm[1]), std::max(y_mm[0], y_mm[1]));
  constexpr double kRoom_mm = 1e-3;
  if (radius_mm > corner_mm + kRoom_mm) return TurnsInReach::None;
  const bool around = radius_mm <= std::min({x_mm[0], x_mm[1], y_mm[0], y_mm[1]});
  return around && turns_freely(bounds) ? TurnsInReach::All : TurnsInReach::Some;
}

PartPlace::PartPlace(const Pose2& pose) : X_HP(pose), x_axis(geometry::direction(pose.theta_rad)) {}

bool reaches(const PlanHold& hold, const PlanBounds& bounds, const PartPlace& place) {
  const Vector2d& x = place.x_axis;
  const Vector2d& p = hold.origin_P_mm;
  const Vector2d offset_mm =
      place.X_HP.t_mm + Vector2d(x.x() * p.x() - x.y() * p.y(), x.y() * p.x() + x.x() * p.y());
  if (!holds(bounds.adjust.x_mm, offset_mm.x(), kOffsetTolerance_mm) ||
      !holds(bounds.adjust.y_mm, offset_mm.y(), kOffsetTolerance_mm)) {
    return false;
  }
  return turns_freely(bounds) ||
         angle_in(bounds.adjust.theta_rad, place.X_HP.theta_rad - hold.X_GP.theta_rad);
}

}  // namespace pinjaw::cell

#include "host/geometry/plane.hpp"

#include <cmath>
#include <numbers>

namespace pinjaw::geometry {

double length_mm(const Curve& curve) {
  if (const auto* segment = std::get_if<Segment>(&curve)) return (segment->b_mm - segment->a_mm).norm();
  const auto& arc = std::get<Arc>(curve);
  return arc.radius_mm * arc.sweep_rad;
}

Vector2d point_at(const Curve& curve, double along_mm) {
  if (const auto* segment = std::get_if<Segment>(&curve)) {
    return segment->a_mm + along_mm * (segment->b_mm - segment->a_mm).normalized();
  }
  const auto& arc = std::get<Arc>(curve);
  return arc.center_mm + arc.radius_mm * direction(arc.from_rad + along_mm / arc.radius_mm);
}

Vector2d tangent_at(const Curve& curve, double along_mm) {
  if (const auto* segment = std::get_if<Segment>(&curve)) return (segment->b_mm - segment->a_mm).normalized();
  const auto& arc = std::get<Arc>(curve);
  return direction(arc.from_rad + along_mm / arc.radius_mm + std::numbers::pi / 2);
}

Vector2d direction(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

double wrapped_rad(double angle_rad) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double wrapped = std::fmod(angle_rad, kTurn);
  if (wrapped >= 0) return wrapped;
  return wrapped + kTurn < kTurn ? wrapped + kTurn : 0.0;
}

Vector2d Pose2::turned(const Vector2d& v) const {
  const double c = std::cos(theta_rad);
  const double s = std::sin(theta_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

Vector2d Pose2::operator*(const Vector2d& p_mm) const {
  return turned(p_mm) + t_mm;
}

Pose2 Pose2::operator*(const Pose2& other) const {
  return {theta_rad + other.theta_rad, turned(other.t_mm) + t_mm};
}

Pose2 Pose2::inverse() const {
  const Pose2 back{-theta_rad, Vector2d::Zero()};
  return {-theta_rad, -back.turned(t_mm)};
}

}  // namespace pinjaw::geometry

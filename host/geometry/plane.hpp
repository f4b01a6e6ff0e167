#pragma once

#include <Eigen/Core>
#include <variant>

/// Primitives of the plan view. Lengths in mm, angles in radians.
namespace pinjaw::geometry {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A closed interval [lo, hi]; empty where lo > hi.
struct Interval {
  double lo = 0;
  double hi = 0;
  [[nodiscard]] constexpr bool contains(double value) const { return lo <= value && value <= hi; }
  [[nodiscard]] constexpr double length() const { return hi - lo; }
  friend bool operator==(const Interval&, const Interval&) = default;
};

/// The directed straight piece from `a_mm` to `b_mm`.
struct Segment {
  Vector2d a_mm = Vector2d::Zero();
  Vector2d b_mm = Vector2d::Zero();
};

/// The circular arc that starts at angle `from_rad` and turns counter-clockwise by `sweep_rad` in (0, 2 pi].
struct Arc {
  Vector2d center_mm = Vector2d::Zero();
  double radius_mm = 0;
  double from_rad = 0;
  double sweep_rad = 0;
};

using Curve = std::variant<Segment, Arc>;

/// Length of the curve in mm.
double length_mm(const Curve& curve);

/// The point at arc length `along_mm` in [0, length_mm(curve)] from the curve's start.
Vector2d point_at(const Curve& curve, double along_mm);

/// Unit tangent at `along_mm`, in the direction of travel.
Vector2d tangent_at(const Curve& curve, double along_mm);

/// The unit vector at angle `angle_rad` from +x.
Vector2d direction(double angle_rad);

/// `v` turned by a quarter, counter-clockwise.
inline Vector2d across(const Vector2d& v) {
  return {-v.y(), v.x()};
}

/// The z component of the cross product: positive where `b` points to the left of `a`.
inline double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// `angle_rad` brought into [0, 2 pi).
double wrapped_rad(double angle_rad);

/// A rigid motion of the plane, X_GB: p_GP = R(theta) p_BP + t.
struct Pose2 {
  double theta_rad = 0;
  Vector2d t_mm = Vector2d::Zero();

  [[nodiscard]] Vector2d operator*(const Vector2d& p_mm) const;
  [[nodiscard]] Pose2 operator*(const Pose2& other) const;
  [[nodiscard]] Pose2 inverse() const;
  /// `v` turned by theta, not moved.
  [[nodiscard]] Vector2d turned(const Vector2d& v) const;
};

}  // namespace pinjaw::geometry

#pragma once

#include "host/geometry/surface.hpp"

namespace pinjaw::geometry {

/// An axis-parallel box in space.
struct Box {
  Vector3d lo = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d hi = Vector3d::Constant(-std::numeric_limits<double>::infinity());

  void include(const Vector3d& p_mm) {
    lo = lo.cwiseMin(p_mm);
    hi = hi.cwiseMax(p_mm);
  }
  void include(const Box& other) {
    lo = lo.cwiseMin(other.lo);
    hi = hi.cwiseMax(other.hi);
  }
};

/// A convex plan region as surface queries need it: a stadium grown by kTouch_mm.
class Stadium {
 public:
  explicit Stadium(const Sweep& sweep);

  /// False only where the region and the box's shadow are apart.
  [[nodiscard]] bool may_meet(const Box& box) const;
  /// The part of the segment a + t (b - a), t in [0, 1], inside the region; empty where there is none.
  [[nodiscard]] Interval clip(const Vector2d& a_mm, const Vector2d& b_mm) const;
  /// A point of the region farthest along `direction` (any length; zero gives any point).
  [[nodiscard]] Vector2d support(const Vector2d& direction) const;

 private:
  Vector2d from_mm_;
  Vector2d to_mm_;
  double radius_mm_;
  double length_mm_;
  Vector2d along_;   ///< unit, from `from` to `to`; zero for a disc
  Vector2d across_;  ///< unit; zero for a disc
};

/// The same for a rectangle grown by kTouch_mm.
class Oblong {
 public:
  explicit Oblong(const Rectangle& rectangle);

  [[nodiscard]] bool may_meet(const Box& box) const;
  [[nodiscard]] Interval clip(const Vector2d& a_mm, const Vector2d& b_mm) const;
  [[nodiscard]] Vector2d support(const Vector2d& direction) const;

 private:
  Vector2d center_mm_;
  Vector2d along_;
  Vector2d across_;
  Vector2d half_mm_;
};

}  // namespace pinjaw::geometry

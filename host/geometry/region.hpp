#pragma once

#include <algorithm>
#include <array>
#include <cmath>

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

/// Gap from which two spans are apart beyond all rounding, though regions are grown by more than that.
inline constexpr double kApart_mm = kTouch_mm / 10;

/// Whether two spans along one unit vector lie apart.
inline bool apart(const Interval& a, const Interval& b) {
  return a.lo > b.hi + kApart_mm || b.lo > a.hi + kApart_mm;
}

/// Plan length under which a piece counts as upright: its whole length is over one point.
inline constexpr double kPoint_mm = 1e-12;

/// What a box's shadow spans along a unit vector.
inline Interval shadow_span(const Box& box, const Vector2d& axis) {
  const double middle = axis.x() * (box.lo.x() + box.hi.x()) + axis.y() * (box.lo.y() + box.hi.y());
  const double width =
      std::abs(axis.x()) * (box.hi.x() - box.lo.x()) + std::abs(axis.y()) * (box.hi.y() - box.lo.y());
  return {0.5 * (middle - width), 0.5 * (middle + width)};
}

/// One triangle of a surface, ready for queries.
struct Facet {
  std::array<Vector3d, 3> p_mm;
  Vector3d normal = Vector3d::Zero();  ///< unit, outward; zero where the triangle has no area
  int triangle = 0;                    ///< its place in the mesh

  [[nodiscard]] Box box() const {
    Box box;
    for (const Vector3d& p : p_mm) box.include(p);
    return box;
  }
};

/// What a facet's corners span in plan along `axis`.
inline Interval shadow_span(const Facet& facet, const Vector2d& axis) {
  const double a = axis.x() * facet.p_mm[0].x() + axis.y() * facet.p_mm[0].y();
  const double b = axis.x() * facet.p_mm[1].x() + axis.y() * facet.p_mm[1].y();
  const double c = axis.x() * facet.p_mm[2].x() + axis.y() * facet.p_mm[2].y();
  return {std::min(std::min(a, b), c), std::max(std::max(a, b), c)};
}

/// The corners of a region's bounding rectangle.
struct Reach {
  Vector2d lo_mm = Vector2d::Zero();
  Vector2d hi_mm = Vector2d::Zero();

  [[nodiscard]] bool overlaps(const Box& box) const {
    return box.lo.x() <= hi_mm.x() && box.hi.x() >= lo_mm.x() && box.lo.y() <= hi_mm.y() &&
           box.hi.y() >= lo_mm.y();
  }
};

/// A convex plan region as surface queries need it: a stadium grown by kTouch_mm.
class Stadium {
 public:
  explicit Stadium(const Sweep& sweep);

  /// False only where the region and the box's shadow are apart.
  [[nodiscard]] bool may_meet(const Box& box) const {
    if (!reach_.overlaps(box)) return false;
    if (length_mm_ >= kPoint_mm) {
      return !apart(shadow_span(box, along_), along_span_mm_) &&
             !apart(shadow_span(box, across_), across_span_mm_);
    }
    const double x_mm = std::max({box.lo.x() - from_mm_.x(), from_mm_.x() - box.hi.x(), 0.0});
    const double y_mm = std::max({box.lo.y() - from_mm_.y(), from_mm_.y() - box.hi.y(), 0.0});
    return x_mm * x_mm + y_mm * y_mm <= radius_mm_ * radius_mm_;
  }
  /// False only where the region and the facet's shadow are apart along one of the region's own axes.
  [[nodiscard]] bool may_meet(const Facet& facet) const {
    return length_mm_ < kPoint_mm || (!apart(shadow_span(facet, across_), across_span_mm_) &&
                                      !apart(shadow_span(facet, along_), along_span_mm_));
  }
  /// What the region spans along a unit vector.
  [[nodiscard]] Interval span(const Vector2d& axis) const {
    const double from = axis.dot(from_mm_);
    if (length_mm_ < kPoint_mm) return {from - radius_mm_, from + radius_mm_};
    const double to = axis.dot(to_mm_);
    return {std::min(from, to) - radius_mm_, std::max(from, to) + radius_mm_};
  }
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
  Interval along_span_mm_;
  Interval across_span_mm_;
  Reach reach_;
};

/// The same for a rectangle grown by kTouch_mm.
class Oblong {
 public:
  explicit Oblong(const Rectangle& rectangle);

  [[nodiscard]] bool may_meet(const Box& box) const {
    return reach_.overlaps(box) && !apart(shadow_span(box, along_), along_span_mm_) &&
           !apart(shadow_span(box, across_), across_span_mm_);
  }
  [[nodiscard]] bool may_meet(const Facet& facet) const {
    return !apart(shadow_span(facet, along_), along_span_mm_) &&
           !apart(shadow_span(facet, across_), across_span_mm_);
  }
  [[nodiscard]] Interval span(const Vector2d& axis) const {
    const double reach_mm =
        half_mm_.x() * std::abs(axis.dot(along_)) + half_mm_.y() * std::abs(axis.dot(across_));
    const double middle = axis.dot(center_mm_);
    return {middle - reach_mm, middle + reach_mm};
  }
  [[nodiscard]] Interval clip(const Vector2d& a_mm, const Vector2d& b_mm) const;
  [[nodiscard]] Vector2d support(const Vector2d& direction) const;

 private:
  Vector2d center_mm_;
  Vector2d along_;
  Vector2d across_;
  Vector2d half_mm_;
  Interval along_span_mm_;
  Interval across_span_mm_;
  Reach reach_;
};

}  // namespace pinjaw::geometry

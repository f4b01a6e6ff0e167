#pragma once

#include <array>
#include <vector>

#include "host/geometry/plane.hpp"

/// Along which stretches of a path a disc's centre comes near a convex polygon. Private to phase 1.
namespace pinjaw::planner {

/// A triangle cut by a plane has at most four corners.
struct ConvexPolygon {
  std::array<geometry::Vector2d, 4> corners_mm;
  int size = 0;
};

/// The path of a pin's centre: a line, or a circle about `origin_mm` with |radius_mm|, at angle from + s /
/// per_rad, turned by pi where radius_mm < 0. Positions s are those on the feature.
struct Path {
  bool round = false;
  geometry::Vector2d origin_mm = geometry::Vector2d::Zero();  ///< the circle's centre, or the point at s = 0
  geometry::Vector2d along = geometry::Vector2d::UnitX();
  double radius_mm = 0;
  double from_rad = 0;
  double mm_per_rad = 1;  ///< of the feature, not of the path
  [[nodiscard]] geometry::Vector2d point_at(double s_mm) const;
};

/// Appends the stretches of `within_mm` where the path is nearer than `distance_mm` to the polygon.
void add_near_stretches(const Path& path, const ConvexPolygon& polygon, double distance_mm,
                        const geometry::Interval& within_mm, std::vector<geometry::Interval>& stretches);

}  // namespace pinjaw::planner

#include "host/planner/features/clearing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pinjaw::planner {
namespace {

using geometry::cross;
using geometry::Interval;
using geometry::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Interval kEmpty{kInfinity, -kInfinity};

Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}
Interval common(const Interval& a, const Interval& b) {
  return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

/// Where |offset + s slope - middle| < half, on a line.
Interval band(double offset, double slope, const Interval& open) {
  if (slope == 0) return open.lo < offset && offset < open.hi ? Interval{-kInfinity, kInfinity} : kEmpty;
  const double a = (open.lo - offset) / slope;
  const double b = (open.hi - offset) / slope;
  return {std::min(a, b), std::max(a, b)};
}

Interval line_near_point(const Path& line, const Vector2d& p_mm, double distance_mm) {
  const Vector2d spoke = p_mm - line.origin_mm;
  const double aside_mm = cross(line.along, spoke);
  const double squared = distance_mm * distance_mm - aside_mm * aside_mm;
  if (squared <= 0) return kEmpty;
  const double middle_mm = line.along.dot(spoke);
  return {middle_mm - std::sqrt(squared), middle_mm + std::sqrt(squared)};
}

/// Where a line is nearer than the distance to the segment: its capsule is convex, so one interval.
Interval line_near_segment(const Path& line, const Vector2d& a_mm, const Vector2d& b_mm, double distance_mm) {
  Interval near_mm = hull(line_near_point(line, a_mm, distance_mm), line_near_point(line, b_mm, distance_mm));
  const double length_mm = (b_mm - a_mm).norm();
  if (length_mm == 0) return near_mm;
  const Vector2d u = (b_mm - a_mm) / length_mm;
  const Vector2d spoke = line.origin_mm - a_mm;
  const Interval strip = common(band(u.dot(spoke), u.dot(line.along), {0, length_mm}),
                                band(cross(u, spoke), cross(u, line.along), {-distance_mm, distance_mm}));
  if (strip.lo < strip.hi) near_mm = hull(near_mm, strip);
  return near_mm;
}

double distance_to_segment_mm(const Vector2d& p_mm, const Vector2d& a_mm, const Vector2d& b_mm) {
  const Vector2d ab = b_mm - a_mm;
  const double squared = ab.squaredNorm();
  const double t = squared > 0 ? std::clamp(ab.dot(p_mm - a_mm) / squared, 0.0, 1.0) : 0.0;
  return (p_mm - a_mm - t * ab).norm();
}

bool is_near(const Vector2d& p_mm, const ConvexPolygon& polygon, double distance_mm) {
  bool left = true;
  bool right = true;
  for (int i = 0; i < polygon.size; ++i) {
    const auto& a_mm = polygon.corners_mm[static_cast<std::size_t>(i)];
    const auto& b_mm = polygon.corners_mm[static_cast<std::size_t>((i + 1) % polygon.size)];
    if (distance_to_segment_mm(p_mm, a_mm, b_mm) < distance_mm) return true;
    const double side = cross(b_mm - a_mm, p_mm - a_mm);
    left = left && side > 0;
    right = right && side < 0;
  }
  return left || right;
}

/// Collects the positions on a round path where its distance to the polygon can cross `distance_mm`.
class Criticals {
 public:
  Criticals(const Path& path, const Interval& within_mm)
      : path_(path), positions_mm_{within_mm.lo, within_mm.hi} {}

  void at_circle(const Vector2d& p_mm, double distance_mm) {
    const Vector2d spoke = p_mm - path_.origin_mm;
    const double far_mm = spoke.norm();
    const double radius_mm = std::abs(path_.radius_mm);
    if (far_mm == 0) return;
    const double cosine =
        (radius_mm * radius_mm + far_mm * far_mm - distance_mm * distance_mm) / (2 * radius_mm * far_mm);
    add(std::atan2(spoke.y(), spoke.x()), cosine);
  }

  void at_offset_lines(const Vector2d& a_mm, const Vector2d& b_mm, double distance_mm) {
    const double length_mm = (b_mm - a_mm).norm();
    if (length_mm == 0) return;
    const Vector2d normal = Vector2d(a_mm.y() - b_mm.y(), b_mm.x() - a_mm.x()) / length_mm;
    const double offset_mm = normal.dot(a_mm - path_.origin_mm);
    for (const double line_mm : {offset_mm - distance_mm, offset_mm + distance_mm}) {
      add(std::atan2(normal.y(), normal.x()), line_mm / std::abs(path_.radius_mm));
    }
  }

  std::vector<double> sorted() {
    std::ranges::sort(positions_mm_);
    return positions_mm_;
  }

 private:
  void add(double middle_rad, double cosine) {
    if (std::abs(cosine) > 1) return;
    const double half_rad = std::acos(cosine);
    const double flip_rad = path_.radius_mm < 0 ? std::numbers::pi : 0;
    for (const double angle_rad : {middle_rad - half_rad, middle_rad + half_rad}) {
      const double s_mm = geometry::wrapped_rad(angle_rad - flip_rad - path_.from_rad) * path_.mm_per_rad;
      if (positions_mm_[0] < s_mm && s_mm < positions_mm_[1]) positions_mm_.push_back(s_mm);
    }
  }

  const Path& path_;
  std::vector<double> positions_mm_;
};

void add_round(const Path& path, const ConvexPolygon& polygon, double distance_mm, const Interval& within_mm,
               std::vector<Interval>& stretches) {
  Criticals criticals(path, within_mm);
  for (int i = 0; i < polygon.size; ++i) {
    const auto& a_mm = polygon.corners_mm[static_cast<std::size_t>(i)];
    criticals.at_circle(a_mm, distance_mm);
    criticals.at_offset_lines(a_mm, polygon.corners_mm[static_cast<std::size_t>((i + 1) % polygon.size)],
                              distance_mm);
  }
  const std::vector<double> positions_mm = criticals.sorted();
  for (std::size_t i = 1; i < positions_mm.size(); ++i) {
    const double middle_mm = (positions_mm[i - 1] + positions_mm[i]) / 2;
    if (is_near(path.point_at(middle_mm), polygon, distance_mm)) {
      stretches.push_back({positions_mm[i - 1], positions_mm[i]});
    }
  }
}

}  // namespace

Vector2d Path::point_at(double s_mm) const {
  if (!round) return origin_mm + s_mm * along;
  return origin_mm + radius_mm * geometry::direction(from_rad + s_mm / mm_per_rad);
}

void add_near_stretches(const Path& path, const ConvexPolygon& polygon, double distance_mm,
                        const Interval& within_mm, std::vector<Interval>& stretches) {
  if (path.round) {
    add_round(path, polygon, distance_mm, within_mm, stretches);
    return;
  }
  Interval near_mm = kEmpty;
  for (int i = 0; i < polygon.size; ++i) {
    const auto& a_mm = polygon.corners_mm[static_cast<std::size_t>(i)];
    const auto& b_mm = polygon.corners_mm[static_cast<std::size_t>((i + 1) % polygon.size)];
    near_mm = hull(near_mm, line_near_segment(path, a_mm, b_mm, distance_mm));
  }
  near_mm = common(near_mm, within_mm);
  if (near_mm.lo < near_mm.hi) stretches.push_back(near_mm);
}

}  // namespace pinjaw::planner

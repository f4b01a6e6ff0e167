#include "host/planner/features/reach.hpp"

#include <algorithm>
#include <cmath>

#include "host/planner/features/clearing.hpp"
#include "host/planner/features/features.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Interval;
using geometry::Vector2d;
using geometry::Vector3d;

constexpr double kStepMm = 0.25;        // chosen: how far z_edge is followed along a sloping edge
constexpr double kSameHeightMm = 1e-6;  // flat edges read the same height but for rounding
constexpr double kLeastReachMm = 1e-6;

Path path_of(const model::Feature& feature, double pin_radius_mm) {
  Path path;
  if (const auto* segment = std::get_if<geometry::Segment>(&feature.curve)) {
    path.origin_mm = segment->a_mm + pin_radius_mm * model::outward_normal_at(feature, 0);
    path.along = geometry::tangent_at(feature.curve, 0);
    return path;
  }
  const auto& arc = std::get<geometry::Arc>(feature.curve);
  const double outward = feature.bulge == model::Bulge::Convex ? 1 : -1;
  path.round = true;
  path.origin_mm = arc.center_mm;
  path.radius_mm = arc.radius_mm + outward * pin_radius_mm;
  path.from_rad = arc.from_rad;
  path.mm_per_rad = arc.radius_mm;
  return path;
}

/// A stretch of the feature along which z_edge is one value.
struct Level {
  Interval along_mm;
  double z_edge_mm;
};

/// As phase 3 has it: the lowest surface eps inside the foot, or the silhouette there (DESIGN 3.1 no. 2).
double z_edge_mm(const model::Feature& feature, double along_mm, const geometry::Surface& surface) {
  const Vector2d foot_mm = geometry::point_at(feature.curve, along_mm);
  const Vector2d inside_mm = foot_mm - model::kEps_mm * model::outward_normal_at(feature, along_mm);
  const auto hit = surface.lowest_above(inside_mm);
  if (!hit) return surface.z_range_mm().hi;
  return surface.silhouette_z_mm(foot_mm, hit->point_mm.z(), 2 * model::kEps_mm).value_or(hit->point_mm.z());
}

std::vector<Level> levels_of(const model::Feature& feature, const std::vector<double>& breaks_mm,
                             const geometry::Surface& surface) {
  const double length_mm = geometry::length_mm(feature.curve);
  std::vector<double> ends_mm{0, length_mm};
  for (const double at_mm : breaks_mm) {
    if (0 < at_mm && at_mm < length_mm) ends_mm.push_back(at_mm);
  }
  std::ranges::sort(ends_mm);
  std::vector<Level> levels;
  for (std::size_t i = 1; i < ends_mm.size(); ++i) {
    const Interval whole{ends_mm[i - 1], ends_mm[i]};
    const int steps = std::max(1, static_cast<int>(std::ceil(whole.length() / kStepMm)));
    for (int step = 0; step < steps; ++step) {
      const double lo_mm = whole.lo + step * whole.length() / steps;
      const double hi_mm = whole.lo + (step + 1) * whole.length() / steps;
      const double middle_mm = (lo_mm + hi_mm) / 2;
      const double z_mm = z_edge_mm(feature, middle_mm, surface);
      if (!levels.empty() && std::abs(levels.back().z_edge_mm - z_mm) < kSameHeightMm) {
        levels.back().along_mm.hi = hi_mm;
      } else {
        levels.push_back({{lo_mm, hi_mm}, z_mm});
      }
    }
  }
  return levels;
}

using Corners = std::array<Vector3d, 3>;

Corners corners_of(const geometry::TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices_mm[static_cast<std::size_t>(a)], mesh.vertices_mm[static_cast<std::size_t>(b)],
          mesh.vertices_mm[static_cast<std::size_t>(c)]};
}

double lowest_mm(const Corners& corners) {
  return std::min({corners[0].z(), corners[1].z(), corners[2].z()});
}

/// What of the triangle lies below `z_mm`, in plan.
ConvexPolygon below(const Corners& corners, double z_mm) {
  ConvexPolygon polygon;
  const auto add = [&](const Vector3d& p) {
    polygon.corners_mm[static_cast<std::size_t>(polygon.size++)] = p.head<2>();
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& p = corners[i];
    const Vector3d& q = corners[(i + 1) % 3];
    if (p.z() <= z_mm) add(p);
    if ((p.z() <= z_mm) != (q.z() <= z_mm)) add(p + (z_mm - p.z()) / (q.z() - p.z()) * (q - p));
  }
  return polygon;
}

struct Box {
  Vector2d lo_mm;
  Vector2d hi_mm;
};

/// The plan box of everything nearer than `distance_mm` to the path over `along_mm`.
Box box_about(const Path& path, const Interval& along_mm, double distance_mm) {
  const Vector2d a_mm = path.point_at(along_mm.lo);
  const Vector2d b_mm = path.point_at(along_mm.hi);
  double bulge_mm = 0;
  if (path.round) bulge_mm = std::abs(path.radius_mm) * std::min(2.0, along_mm.length() / path.mm_per_rad);
  const Vector2d margin_mm = Vector2d::Constant(distance_mm + bulge_mm);
  return {a_mm.cwiseMin(b_mm) - margin_mm, a_mm.cwiseMax(b_mm) + margin_mm};
}

bool apart(const Corners& corners, const Box& box) {
  const Vector3d lo_mm = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vector3d hi_mm = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  return (lo_mm.head<2>().array() > box.hi_mm.array()).any() ||
         (hi_mm.head<2>().array() < box.lo_mm.array()).any();
}

std::vector<Corners> triangles_near(const geometry::TriangleMesh& mesh, const Box& box, double under_mm) {
  std::vector<Corners> near;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners corners = corners_of(mesh, i);
    if (lowest_mm(corners) < under_mm && !apart(corners, box)) near.push_back(corners);
  }
  return near;
}

/// What of `whole` the stretches leave free, appended to `free` and joined to its end where they touch.
void add_complement(std::vector<Interval> blocked, const Interval& whole, std::vector<Interval>& free) {
  std::ranges::sort(blocked, {}, &Interval::lo);
  const auto add = [&](double lo_mm, double hi_mm) {
    if (hi_mm - lo_mm < kLeastReachMm) return;
    if (!free.empty() && lo_mm - free.back().hi < kLeastReachMm) {
      free.back().hi = hi_mm;
    } else {
      free.push_back({lo_mm, hi_mm});
    }
  };
  double from_mm = whole.lo;
  for (const Interval& stretch : blocked) {
    add(from_mm, stretch.lo);
    from_mm = std::max(from_mm, stretch.hi);
  }
  add(from_mm, whole.hi);
}

}  // namespace

std::vector<Interval> reach_of(const model::Feature& feature, const std::vector<double>& breaks_mm,
                               const geometry::Surface& surface, const model::PinStock& pins) {
  const Path path = path_of(feature, pins.radius_mm);
  const double disc_mm = pins.radius_mm - model::kEps_mm;
  const auto levels = levels_of(feature, breaks_mm, surface);
  const double highest_mm =
      std::ranges::max(levels, {}, &Level::z_edge_mm).z_edge_mm + pins.min_engagement_mm;
  const Interval whole{0, geometry::length_mm(feature.curve)};
  const auto near = triangles_near(surface.mesh(), box_about(path, whole, disc_mm), highest_mm);
  std::vector<Interval> free;
  std::vector<Interval> blocked;
  for (const Level& level : levels) {
    const double under_mm = level.z_edge_mm + pins.min_engagement_mm - kSameHeightMm;
    const Box box = box_about(path, level.along_mm, disc_mm);
    blocked.clear();
    for (const Corners& corners : near) {
      if (lowest_mm(corners) >= under_mm || apart(corners, box)) continue;
      add_near_stretches(path, below(corners, under_mm), disc_mm, level.along_mm, blocked);
    }
    add_complement(blocked, level.along_mm, free);
  }
  return free;
}

}  // namespace pinjaw::planner

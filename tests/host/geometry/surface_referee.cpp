#include "tests/host/geometry/surface_referee.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace pinjaw::geometry::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kSidesOfHalfCircle = 48;

using Polygon = std::vector<Vector3d>;

/// Keeps what lies where side(p) <= 0.
Polygon cut(const Polygon& polygon, const std::function<double(const Vector3d&)>& side) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& a = polygon[i];
    const Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double sa = side(a);
    const double sb = side(b);
    if (sa <= 0) kept.push_back(a);
    if ((sa < 0 && sb > 0) || (sa > 0 && sb < 0)) kept.push_back(a + (b - a) * (sa / (sa - sb)));
  }
  return kept;
}

/// Cuts to the tangents of the stadium grown by `growth`, at evenly spaced directions.
Polygon cut_to_stadium(Polygon polygon, const Sweep& region, double radius_mm) {
  const Vector2d d = region.to_mm - region.from_mm;
  const double start = d.norm() > 0 ? std::atan2(d.y(), d.x()) : 0;
  for (int i = 0; i < 2 * kSidesOfHalfCircle; ++i) {
    const Vector2d n = direction(start + std::numbers::pi * i / kSidesOfHalfCircle);
    const double reach = std::max(n.dot(region.from_mm), n.dot(region.to_mm)) + radius_mm;
    polygon = cut(polygon, [&](const Vector3d& p) { return n.dot(p.head<2>()) - reach; });
  }
  return polygon;
}

Interval z_range(const TriangleMesh& mesh, const Sweep& region, const Slab& slab, double radius_mm) {
  Interval z{kInfinity, -kInfinity};
  for (const auto& t : mesh.triangles) {
    Polygon polygon;
    for (const int corner : t) polygon.push_back(mesh.vertices_mm[static_cast<std::size_t>(corner)]);
    polygon = cut_to_stadium(polygon, region, radius_mm);
    polygon = cut(polygon, [&](const Vector3d& p) { return slab.lo_mm - p.z(); });
    polygon = cut(polygon, [&](const Vector3d& p) { return p.z() - slab.hi_mm; });
    for (const Vector3d& p : polygon) z = {std::min(z.lo, p.z()), std::max(z.hi, p.z())};
  }
  return z;
}

/// Radii whose tangent polygons hold the region, and are held by it.
double outer_radius_mm(const Sweep& region) {
  return region.radius_mm + 1e-7;
}
double inner_radius_mm(const Sweep& region) {
  return region.radius_mm * std::cos(std::numbers::pi / (2 * kSidesOfHalfCircle)) - 1e-7;
}

}  // namespace

Bracket lowest_bracket_mm(const TriangleMesh& mesh, const Sweep& region, const Slab& slab) {
  return {z_range(mesh, region, slab, outer_radius_mm(region)).lo,
          z_range(mesh, region, slab, inner_radius_mm(region)).lo};
}

Bracket highest_bracket_mm(const TriangleMesh& mesh, const Sweep& region, const Slab& slab) {
  return {z_range(mesh, region, slab, outer_radius_mm(region)).hi,
          z_range(mesh, region, slab, inner_radius_mm(region)).hi};
}

bool meets_rectangle(const TriangleMesh& mesh, const Rectangle& region, const Slab& slab, double grown_mm) {
  const Vector2d across{-region.direction.y(), region.direction.x()};
  for (const auto& t : mesh.triangles) {
    Polygon polygon;
    for (const int corner : t) polygon.push_back(mesh.vertices_mm[static_cast<std::size_t>(corner)]);
    for (const double sign : {-1.0, 1.0}) {
      const auto beyond = [&](const Vector2d& axis, double half_mm) {
        return [&region, axis, half_mm, sign, grown_mm](const Vector3d& p) {
          return sign * axis.dot(p.head<2>() - region.center_mm) - half_mm - grown_mm;
        };
      };
      polygon = cut(polygon, beyond(region.direction, region.half_mm.x()));
      polygon = cut(polygon, beyond(across, region.half_mm.y()));
    }
    polygon = cut(polygon, [&](const Vector3d& p) { return slab.lo_mm - grown_mm - p.z(); });
    polygon = cut(polygon, [&](const Vector3d& p) { return p.z() - slab.hi_mm - grown_mm; });
    if (!polygon.empty()) return true;
  }
  return false;
}

double first_hit_mm(const TriangleMesh& mesh, const Ray& ray) {
  double nearest = kInfinity;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices_mm[static_cast<std::size_t>(t[0])];
    const Vector3d e1 = mesh.vertices_mm[static_cast<std::size_t>(t[1])] - a;
    const Vector3d e2 = mesh.vertices_mm[static_cast<std::size_t>(t[2])] - a;
    const Vector3d p = ray.direction.cross(e2);
    const double determinant = e1.dot(p);
    if (std::abs(determinant) < 1e-14) continue;
    const Vector3d s = ray.origin_mm - a;
    const Vector3d q = s.cross(e1);
    const double u = s.dot(p) / determinant;
    const double v = ray.direction.dot(q) / determinant;
    const double distance = e2.dot(q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0) nearest = std::min(nearest, distance);
  }
  return nearest;
}

}  // namespace pinjaw::geometry::testing

#include "host/planner/force/jet_reach.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pinjaw::planner {
namespace {

using geometry::Ray;
using geometry::Surface;

constexpr double kSamePoint_mm = 1e-6;  // chosen: far above rounding of a ray, far below any feature
constexpr double kGrazing = 1e-3;       // least cosine of a jet to the normal: flatter ones are not tried
constexpr int kSpread = 400;            // chosen: a direction every 10 degrees or so

double within_rad(const model::Spray& spray) {
  return spray.from ? spray.within_rad.value_or(0) : std::numbers::pi;
}

Vector3d middle_of(const model::Spray& spray) {
  return spray.from ? Vector3d(spray.from->normalized()) : Vector3d(Vector3d::UnitZ());
}

/// Longer than any line through the part.
double beyond_mm(const Surface& surface) {
  const auto x = surface.x_range_mm();
  const auto y = surface.y_range_mm();
  const auto z = surface.z_range_mm();
  return 1 + 2 * Vector3d(x.hi - x.lo, y.hi - y.lo, z.hi - z.lo).norm();
}

/// Directions evenly over the cap, by the golden angle.
std::vector<Vector3d> spread_over(const Vector3d& axis, double half_angle_rad) {
  const Vector3d u = axis.unitOrthogonal();
  const Vector3d v = axis.cross(u);
  std::vector<Vector3d> directions = {axis};
  const double golden_rad = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kSpread; ++i) {
    const double along = 1 - (1 - std::cos(half_angle_rad)) * (i + 0.5) / kSpread;
    const double across = std::sqrt(std::max(0.0, 1 - along * along));
    directions.emplace_back(along * axis +
                            across * (std::cos(i * golden_rad) * u + std::sin(i * golden_rad) * v));
  }
  return directions;
}

/// The directions of the largest facets, both ways, and the frame's axes: holes and pockets open along them.
std::vector<Vector3d> likely_axes(const Surface& surface) {
  constexpr std::size_t kMost = 60;
  constexpr double kSame = 1 - 1e-6;
  std::vector<Vector3d> axes;
  const auto add = [&](const Vector3d& axis) {
    const auto is_same = [&](const Vector3d& other) { return other.dot(axis) > kSame; };
    if (axes.size() < kMost && std::none_of(axes.begin(), axes.end(), is_same)) axes.push_back(axis);
  };
  for (int k = 0; k < 3; ++k) {
    add(Vector3d::Unit(k));
    add(-Vector3d::Unit(k));
  }
  const geometry::TriangleMesh& mesh = surface.mesh();
  std::vector<std::pair<double, Vector3d>> by_area;
  for (const auto& corners : mesh.triangles) {
    const Vector3d& a = mesh.vertices_mm[static_cast<std::size_t>(corners[0])];
    const Vector3d normal = (mesh.vertices_mm[static_cast<std::size_t>(corners[1])] - a)
                                .cross(mesh.vertices_mm[static_cast<std::size_t>(corners[2])] - a);
    if (normal.norm() > 0) by_area.emplace_back(-normal.norm(), normal.normalized());
  }
  constexpr std::size_t kLargest = 400;
  const std::size_t largest = std::min(kLargest, by_area.size());
  std::partial_sort(by_area.begin(), by_area.begin() + static_cast<std::ptrdiff_t>(largest), by_area.end(),
                    [](const auto& one, const auto& other) { return one.first < other.first; });
  for (std::size_t i = 0; i < largest; ++i) {
    add(by_area[i].second);
    add(-by_area[i].second);
  }
  return axes;
}

}  // namespace

bool jet_meets_first(const Surface& surface, const Vector3d& p_mm, const Vector3d& from) {
  const auto hit = surface.first_hit(Ray{p_mm + beyond_mm(surface) * from, -from});
  return hit && hit->normal.dot(from) > 0 && (hit->point_mm - p_mm).norm() <= kSamePoint_mm;
}

bool may_come_from(const model::Spray& spray, const Vector3d& from) {
  constexpr double kRounding = 1e-9;
  return from.dot(middle_of(spray)) >= std::cos(within_rad(spray)) - kRounding;
}

JetReach::JetReach(const Surface& surface, const model::Spray& spray)
    : surface_(surface),
      spray_(spray),
      spread_(spread_over(middle_of(spray), within_rad(spray))),
      axes_(likely_axes(surface)) {}

Vector3d JetReach::normal_of(int triangle) const {
  const geometry::TriangleMesh& mesh = surface_.mesh();
  const auto& corners = mesh.triangles[static_cast<std::size_t>(triangle)];
  const Vector3d& a = mesh.vertices_mm[static_cast<std::size_t>(corners[0])];
  return (mesh.vertices_mm[static_cast<std::size_t>(corners[1])] - a)
      .cross(mesh.vertices_mm[static_cast<std::size_t>(corners[2])] - a)
      .normalized();
}

bool JetReach::faces_away(int triangle) const {
  const double cosine = std::clamp(normal_of(triangle).dot(middle_of(spray_)), -1.0, 1.0);
  return std::acos(cosine) >= std::numbers::pi / 2 + within_rad(spray_);
}

std::optional<Vector3d> JetReach::direction_to(const Vector3d& p_mm, int triangle) {
  const auto [found, is_new] = known_.try_emplace({triangle, {p_mm.x(), p_mm.y(), p_mm.z()}}, std::nullopt);
  if (is_new) found->second = search(p_mm, normal_of(triangle));
  return found->second;
}

bool JetReach::try_from(const Vector3d& p_mm, const Vector3d& normal, const Vector3d& from) const {
  return normal.dot(from) > kGrazing && may_come_from(spray_, from) && jet_meets_first(surface_, p_mm, from);
}

double JetReach::view_mm(const Vector3d& p_mm, const Vector3d& from) const {
  const auto hit = surface_.first_hit(Ray{p_mm + kSamePoint_mm * from, from});
  return hit ? hit->distance_mm : std::numeric_limits<double>::infinity();
}

std::optional<Vector3d> JetReach::search(const Vector3d& p_mm, const Vector3d& normal) const {
  if (try_from(p_mm, normal, normal)) return normal;
  for (const Vector3d& axis : axes_) {
    for (const double tilt : {0.02, 0.1, 0.4}) {  // off walls that run along the axis
      const Vector3d from = (axis + tilt * normal).normalized();
      if (try_from(p_mm, normal, from)) return from;
    }
  }
  Vector3d deepest = Vector3d::Zero();
  double deepest_mm = 0;
  for (const Vector3d& from : spread_) {
    if (normal.dot(from) <= kGrazing) continue;
    if (try_from(p_mm, normal, from)) return from;
    const double deep_mm = view_mm(p_mm, from);
    if (deep_mm <= deepest_mm) continue;
    deepest_mm = deep_mm;
    deepest = from;
  }
  if (deepest_mm == 0) return std::nullopt;
  for (double spread_rad = 0.15; spread_rad > 0.004; spread_rad /= 2) {
    for (const Vector3d& from : spread_over(Vector3d(deepest), spread_rad)) {
      if (normal.dot(from) <= kGrazing || !may_come_from(spray_, from)) continue;
      if (try_from(p_mm, normal, from)) return from;
      const double deep_mm = view_mm(p_mm, from);
      if (deep_mm <= deepest_mm) continue;
      deepest_mm = deep_mm;
      deepest = from;
    }
  }
  return std::nullopt;
}

}  // namespace pinjaw::planner

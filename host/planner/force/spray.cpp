#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/random.hpp"
#include "host/planner/force/disturbances.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;
using geometry::Vector3d;

constexpr int kMostDrawsPerRay =
    10000;  // chosen: a part fills far more than a ten-thousandth of its box's shadow

struct Box {
  Vector3d lo_mm;
  Vector3d hi_mm;
};

Box box_of(const geometry::Surface& surface) {
  const geometry::Interval x = surface.x_range_mm();
  const geometry::Interval y = surface.y_range_mm();
  const geometry::Interval z = surface.z_range_mm();
  return {{x.lo, y.lo, z.lo}, {x.hi, y.hi, z.hi}};
}

/// Uniform within the cap of half-angle `within_rad` about the unit vector `axis`.
Vector3d direction_about(const Vector3d& axis, double within_rad, base::Random& random) {
  const double along = random.uniform(std::cos(within_rad), 1);
  const double angle_rad = random.uniform(0, 2 * std::numbers::pi);
  const double across = std::sqrt(std::max(0.0, 1 - along * along));
  const Vector3d u = axis.unitOrthogonal();
  const Vector3d v = axis.cross(u);
  return (along * axis + across * (std::cos(angle_rad) * u + std::sin(angle_rad) * v)).normalized();
}

/// Whether the line through `p_mm` along `direction` meets the box.
bool line_meets(const Box& box, const Vector3d& p_mm, const Vector3d& direction) {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0) {
      if (p_mm[k] < box.lo_mm[k] || p_mm[k] > box.hi_mm[k]) return false;
      continue;
    }
    const double a = (box.lo_mm[k] - p_mm[k]) / direction[k];
    const double b = (box.hi_mm[k] - p_mm[k]) / direction[k];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

/// A ray along `direction` from outside the part, its origin uniform over the box's shadow: drawn over the
/// shadow's bounding rectangle, and again until it lies in the shadow.
geometry::Ray ray_over_shadow(const Box& box, const Vector3d& direction, base::Random& random) {
  const Vector3d u = direction.unitOrthogonal();
  const Vector3d v = direction.cross(u);
  const Vector3d middle_mm = (box.lo_mm + box.hi_mm) / 2;
  const Vector3d half_mm = (box.hi_mm - box.lo_mm) / 2;
  const double reach_u_mm = half_mm.dot(u.cwiseAbs());
  const double reach_v_mm = half_mm.dot(v.cwiseAbs());
  Vector3d p_mm = middle_mm;
  for (int draw = 0; draw < kMostDrawsPerRay; ++draw) {
    p_mm =
        middle_mm + random.uniform(-reach_u_mm, reach_u_mm) * u + random.uniform(-reach_v_mm, reach_v_mm) * v;
    if (line_meets(box, p_mm, direction)) break;
  }
  constexpr double kStandOff_mm = 1;  // beyond the box: any value above 0
  return {p_mm - (2 * half_mm.norm() + kStandOff_mm) * direction, direction};
}

}  // namespace

base::Expected<std::vector<SprayHit>> spray_hits(const model::Spray& spray,
                                                 const geometry::Surface& surface) {
  const Box box = box_of(surface);
  base::Random random(spray.seed);
  const Vector3d from = spray.from ? Vector3d(spray.from->normalized()) : Vector3d::UnitZ();
  const double within_rad = spray.from ? spray.within_rad.value_or(0) : std::numbers::pi;
  std::vector<SprayHit> hits;
  const auto wanted = static_cast<std::size_t>(std::max(0, spray.count));
  for (std::size_t draws = 0; hits.size() < wanted; ++draws) {
    if (draws >= kMostDrawsPerRay * wanted) return base::failure("the spray's rays do not find the part");
    const Vector3d direction = -direction_about(from, within_rad, random);
    const auto hit = surface.first_hit(ray_over_shadow(box, direction, random));
    if (!hit) continue;
    const double sign = hit->normal.dot(direction) < 0 ? -1 : 1;
    hits.push_back({hit->point_mm, sign * spray.force_n * hit->normal, -direction, hit->triangle});
  }
  return hits;
}

}  // namespace pinjaw::planner

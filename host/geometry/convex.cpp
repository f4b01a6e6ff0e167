#include "host/geometry/convex.hpp"

#include <ccd/ccd.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pinjaw::geometry {
namespace {

double distance_mm(const Vector2d& p_mm, const Segment& piece) {
  const Vector2d d_mm = piece.b_mm - piece.a_mm;
  const double d2 = d_mm.squaredNorm();
  const double t = d2 > 0 ? std::clamp(d_mm.dot(p_mm - piece.a_mm) / d2, 0.0, 1.0) : 0.0;
  return (piece.a_mm + t * d_mm - p_mm).norm();
}

bool strictly_apart(double a, double b) {
  return (a > 0 && b < 0) || (a < 0 && b > 0);
}

bool cross_properly(const Segment& a, const Segment& b) {
  const Vector2d u = a.b_mm - a.a_mm;
  const Vector2d v = b.b_mm - b.a_mm;
  return strictly_apart(cross(u, b.a_mm - a.a_mm), cross(u, b.b_mm - a.a_mm)) &&
         strictly_apart(cross(v, a.a_mm - b.a_mm), cross(v, a.b_mm - b.a_mm));
}

double distance_mm(const Segment& a, const Segment& b) {
  if (cross_properly(a, b)) return 0;
  return std::min(
      {distance_mm(a.a_mm, b), distance_mm(a.b_mm, b), distance_mm(b.a_mm, a), distance_mm(b.b_mm, a)});
}

std::array<Vector2d, 4> corners(const Rectangle& r) {
  const Vector2d u = r.direction * r.half_mm.x();
  const Vector2d v = across(r.direction) * r.half_mm.y();
  return {r.center_mm - u - v, r.center_mm + u - v, r.center_mm + u + v, r.center_mm - u + v};
}

bool contains(const Rectangle& r, const Vector2d& p_mm) {
  const Vector2d q_mm = p_mm - r.center_mm;
  return std::abs(r.direction.dot(q_mm)) <= r.half_mm.x() &&
         std::abs(across(r.direction).dot(q_mm)) <= r.half_mm.y();
}

/// What libccd is handed: a solid whose z range is finite.
struct Upright {
  const Solid* solid;
  Interval z_mm;
};

Vector2d plan_support(const SweptCylinder& swept, const Vector2d& direction) {
  const Sweep& plan = swept.plan;
  const Vector2d& end_mm = direction.dot(plan.to_mm - plan.from_mm) > 0 ? plan.to_mm : plan.from_mm;
  const double length = direction.norm();
  return length > 0 ? Vector2d(end_mm + direction * (plan.radius_mm / length)) : end_mm;
}

Vector2d plan_support(const Block& block, const Vector2d& direction) {
  const Rectangle& r = block.plan;
  return r.center_mm + r.direction * std::copysign(r.half_mm.x(), r.direction.dot(direction)) +
         across(r.direction) * std::copysign(r.half_mm.y(), across(r.direction).dot(direction));
}

Vector2d plan_center(const SweptCylinder& swept) {
  return 0.5 * (swept.plan.from_mm + swept.plan.to_mm);
}
Vector2d plan_center(const Block& block) {
  return block.plan.center_mm;
}

Vector3d support(const Upright& upright, const Vector3d& direction) {
  const Vector2d plan = direction.head<2>();
  const Vector2d p_mm =
      std::visit([&](const auto& solid) { return plan_support(solid, plan); }, *upright.solid);
  return {p_mm.x(), p_mm.y(), direction.z() > 0 ? upright.z_mm.hi : upright.z_mm.lo};
}

Vector3d center(const Upright& upright) {
  const Vector2d p_mm = std::visit([](const auto& solid) { return plan_center(solid); }, *upright.solid);
  return {p_mm.x(), p_mm.y(), 0.5 * (upright.z_mm.lo + upright.z_mm.hi)};
}

/// What libccd asked last: it tells neither that its iterations ran out nor what separates the solids.
struct Asked {
  Upright upright;
  Vector3d first_direction = Vector3d::UnitX();
  mutable unsigned long calls = 0;
  mutable Vector3d direction = Vector3d::UnitX();
};

void answer_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  const auto& asked = *static_cast<const Asked*>(object);
  ++asked.calls;
  asked.direction = {ccdVec3X(direction), ccdVec3Y(direction), ccdVec3Z(direction)};
  const Vector3d p_mm = support(asked.upright, asked.direction);
  ccdVec3Set(out, p_mm.x(), p_mm.y(), p_mm.z());
}

void answer_first_direction(const void* object, const void* /*other*/, ccd_vec3_t* out) {
  const Vector3d& direction = static_cast<const Asked*>(object)->first_direction;
  ccdVec3Set(out, direction.x(), direction.y(), direction.z());
}

/// Whether a plane square to `direction` has a on its near side and b on its far side.
bool separates(const Vector3d& direction, const Upright& a, const Upright& b) {
  return direction.dot(support(a, direction)) < direction.dot(support(b, -direction));
}

Overlap decide(const Upright& a, const Upright& b, const Vector3d& first_direction) {
  const Asked first{a, first_direction};
  const Asked second{b};
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.first_dir = answer_first_direction;
  ccd.support1 = answer_support;
  ccd.support2 = answer_support;
  ccd.max_iterations = kOverlapIterations;
  if (ccdGJKIntersect(&first, &second, &ccd) != 0) return Overlap::Overlapping;
  if (first.calls > kOverlapIterations) return Overlap::Undecided;
  return separates(first.direction, a, b) ? Overlap::Apart : Overlap::Undecided;
}

Interval z_of(const Solid& solid) {
  return std::visit([](const auto& s) { return s.z_mm; }, solid);
}

/// Infinite ends cut off beyond the other solid's.
Interval finite(Interval z, const Interval& other) {
  constexpr double kBeyond_mm = 1;
  const auto end = [](double at, double fallback) { return std::isfinite(at) ? at : fallback; };
  const double low = end(other.lo, end(other.hi, end(z.hi, 0)));
  const double high = end(other.hi, end(other.lo, end(z.lo, 0)));
  if (!std::isfinite(z.lo)) z.lo = std::min(low, end(z.hi, low)) - kBeyond_mm;
  if (!std::isfinite(z.hi)) z.hi = std::max(high, z.lo) + kBeyond_mm;
  return z;
}

}  // namespace

double plan_distance_mm(const Sweep& a, const Sweep& b) {
  const double axes_mm = distance_mm(Segment{a.from_mm, a.to_mm}, Segment{b.from_mm, b.to_mm});
  return std::max(0.0, axes_mm - a.radius_mm - b.radius_mm);
}

double plan_distance_mm(const Sweep& a, const Rectangle& b) {
  if (contains(b, a.from_mm)) return 0;
  const auto around = corners(b);
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < around.size(); ++i) {
    nearest_mm = std::min(nearest_mm,
                          distance_mm(Segment{a.from_mm, a.to_mm}, Segment{around[i], around[(i + 1) % 4]}));
  }
  return std::max(0.0, nearest_mm - a.radius_mm);
}

Overlap overlap(const Solid& a, const Solid& b) {
  const Interval z_a = z_of(a);
  const Interval z_b = z_of(b);
  if (z_a.lo >= z_b.hi || z_b.lo >= z_a.hi) return Overlap::Apart;
  const Upright first{&a, finite(z_a, z_b)};
  const Upright second{&b, finite(z_b, z_a)};
  const Overlap straight = decide(first, second, center(second) - center(first));
  if (straight != Overlap::Undecided) return straight;
  const Vector3d oblique{0.48, -0.6,
                         0.64};  // a simplex that collapsed from the first direction rarely does so twice
  return decide(first, second, oblique);
}

}  // namespace pinjaw::geometry

#include "host/part/curve_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pinjaw::part {
namespace {

std::optional<Recognised> as_line(std::span<const Vector3d> samples, double tolerance_mm) {
  const Vector3d chord = samples.back() - samples.front();
  const double length_mm = chord.norm();
  if (length_mm <= tolerance_mm) return std::nullopt;
  const Vector3d along = chord / length_mm;
  double error_mm = 0;
  for (const Vector3d& p : samples) error_mm = std::max(error_mm, along.cross(p - samples.front()).norm());
  if (error_mm > tolerance_mm) return std::nullopt;
  return Recognised{Line3{samples.front(), samples.back()}, error_mm};
}

struct Circle {
  Vector3d center_mm, normal;
  double radius_mm;
};

std::optional<Circle> through(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const Vector3d normal = ab.cross(ac);
  const double area2 = normal.squaredNorm();
  if (area2 <= 1e-18 * ab.squaredNorm() * ac.squaredNorm()) return std::nullopt;
  const Vector3d to_center =
      (ac.squaredNorm() * normal.cross(ab) + ab.squaredNorm() * ac.cross(normal)) / (2 * area2);
  return Circle{a + to_center, normal.normalized(), to_center.norm()};
}

std::optional<Recognised> as_circle(std::span<const Vector3d> samples, double tolerance_mm) {
  const bool closed = (samples.back() - samples.front()).norm() <= tolerance_mm;
  const std::size_t last = samples.size() - 1;
  const auto circle = closed ? through(samples[0], samples[last / 3], samples[2 * last / 3])
                             : through(samples[0], samples[last / 2], samples[last]);
  if (!circle) return std::nullopt;
  Ellipse3 arc{.center_mm = circle->center_mm, .u_mm = samples[0] - circle->center_mm};
  arc.v_mm = circle->normal.cross(arc.u_mm);
  double before_rad = 0;
  double error_mm = 0;
  for (const Vector3d& p : samples) {
    const Vector3d spoke = p - circle->center_mm;
    error_mm =
        std::max({error_mm, std::abs(spoke.dot(circle->normal)), std::abs(spoke.norm() - circle->radius_mm)});
    if (error_mm > tolerance_mm) return std::nullopt;
    double angle_rad = std::atan2(spoke.dot(arc.v_mm), spoke.dot(arc.u_mm));
    if (angle_rad < before_rad - 1e-9) angle_rad += 2 * std::numbers::pi;
    if (angle_rad < before_rad - 1e-9) return std::nullopt;
    before_rad = angle_rad;
  }
  arc.sweep_rad = closed ? 2 * std::numbers::pi : before_rad;
  return Recognised{arc, error_mm};
}

}  // namespace

std::optional<Recognised> recognised(std::span<const Vector3d> samples, double tolerance_mm) {
  if (samples.size() < 4) return std::nullopt;
  if (auto line = as_line(samples, tolerance_mm)) return line;
  return as_circle(samples, tolerance_mm);
}

}  // namespace pinjaw::part

#include "host/part/turning.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "host/part/occt_values.hpp"

namespace pinjaw::part {
namespace {

constexpr double kNoNormal = 1e-12;  // of |Su||Sv|: the two directions are one
constexpr double kLevel = 1e-14;     // lean that counts as none: rounding
constexpr double kFound = 1e-10;     // lean that Newton's method must reach to have found the point
constexpr int kMostSteps = 60;       // of the bracketed search
constexpr int kMostNewtonSteps = 12;

/// First and second derivatives of a surface by its parameters.
struct Derivatives {
  Vector3d p_mm, u, v, uu, vv, uv;
};

Derivatives derivatives_at(const BRepAdaptor_Surface& surface, const gp_Pnt2d& at) {
  gp_Pnt p;
  gp_Vec u, v, uu, vv, uv;
  surface.D2(at.X(), at.Y(), p, u, v, uu, vv, uv);
  return {vector_of(p.XYZ()),  vector_of(u.XYZ()),  vector_of(v.XYZ()),
          vector_of(uu.XYZ()), vector_of(vv.XYZ()), vector_of(uv.XYZ())};
}

gp_Pnt2d between(const gp_Pnt2d& a, const gp_Pnt2d& b, double t) {
  return {a.X() + t * (b.X() - a.X()), a.Y() + t * (b.Y() - a.Y())};
}

}  // namespace

LeaningSurface::LeaningSurface(const TopoDS_Face& face, const Vector3d& up)
    : surface_(face), up_(up), outward_(face.Orientation() == TopAbs_REVERSED ? -1 : 1) {}

std::optional<double> LeaningSurface::lean(const gp_Pnt2d& uv) const {
  gp_Pnt p;
  gp_Vec du, dv;
  surface_.D1(uv.X(), uv.Y(), p, du, dv);
  const Vector3d u = vector_of(du.XYZ());
  const Vector3d v = vector_of(dv.XYZ());
  const Vector3d normal = u.cross(v);
  const double size = normal.norm();
  if (!(size > kNoNormal * u.norm() * v.norm())) return std::nullopt;
  return outward_ * up_.dot(normal) / size;
}

Vector3d LeaningSurface::point_mm(const gp_Pnt2d& uv) const {
  return vector_of(surface_.Value(uv.X(), uv.Y()).XYZ());
}

TurningPoint LeaningSurface::turning_between(const gp_Pnt2d& a, const gp_Pnt2d& b) const {
  double lo = 0;
  double hi = 1;
  double at_lo = lean(a).value_or(0);
  double at_hi = lean(b).value_or(0);
  const auto found = [&](double t) {
    const gp_Pnt2d uv = between(a, b, t);
    return TurningPoint{uv, point_mm(uv)};
  };
  if (at_lo * at_hi >= 0) return found(std::abs(at_lo) <= std::abs(at_hi) ? 0 : 1);
  double t = 0;
  for (int step = 0; step < kMostSteps; ++step) {  // regula falsi, Illinois' way
    t = (lo * at_hi - hi * at_lo) / (at_hi - at_lo);
    const double here = lean(between(a, b, t)).value_or(0);
    if (std::abs(here) < kLevel || std::abs(hi - lo) < std::numeric_limits<double>::epsilon()) break;
    if (here * at_hi < 0) {
      lo = hi;
      at_lo = at_hi;
    } else {
      at_lo /= 2;
    }
    hi = t;
    at_hi = here;
  }
  return found(t);
}

std::optional<TurningPoint> LeaningSurface::turning_near(const gp_Pnt2d& uv) const {
  gp_Pnt2d at = uv;
  for (int step = 0; step < kMostNewtonSteps; ++step) {
    const Derivatives d = derivatives_at(surface_, at);
    const Vector3d normal = d.u.cross(d.v);
    const double rise = up_.dot(normal);
    const double by_u = up_.dot(d.uu.cross(d.v) + d.u.cross(d.uv));
    const double by_v = up_.dot(d.uv.cross(d.v) + d.u.cross(d.vv));
    const double squared = by_u * by_u + by_v * by_v;
    if (!(squared > 0) || !std::isfinite(squared)) return std::nullopt;
    if (std::abs(rise) <= kLevel * normal.norm()) break;
    at.SetCoord(at.X() - rise * by_u / squared, at.Y() - rise * by_v / squared);
  }
  const auto left = lean(at);
  if (!left || std::abs(*left) > kFound) return std::nullopt;
  return TurningPoint{at, point_mm(at)};
}

double LeaningSurface::upright_radius_mm(const gp_Pnt2d& uv) const {
  const Derivatives d = derivatives_at(surface_, uv);
  const Vector3d normal = d.u.cross(d.v).normalized();
  Eigen::Matrix2d first;
  first << d.u.dot(d.u), d.u.dot(d.v), d.u.dot(d.v), d.v.dot(d.v);
  const Eigen::Vector2d along = first.inverse() * Eigen::Vector2d(d.u.dot(up_), d.v.dot(up_));
  const double curvature_per_mm = along.x() * along.x() * d.uu.dot(normal) +
                                  2 * along.x() * along.y() * d.uv.dot(normal) +
                                  along.y() * along.y() * d.vv.dot(normal);
  return std::isfinite(curvature_per_mm) ? 1 / std::abs(curvature_per_mm)
                                         : std::numeric_limits<double>::infinity();
}

}  // namespace pinjaw::part

#pragma once

#include <BRepAdaptor_Surface.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Pnt2d.hxx>
#include <optional>

#include "host/geometry/plane.hpp"

/// How an exact face leans. Only for sources of host/part that include OpenCASCADE's headers anyway.
namespace pinjaw::part {

using geometry::Vector3d;

/// A point of a face where its normal is horizontal.
struct TurningPoint {
  gp_Pnt2d uv;
  Vector3d p_mm = Vector3d::Zero();
};

/// The exact surface of a face, asked where it turns over.
class LeaningSurface {
 public:
  LeaningSurface(const TopoDS_Face& face, const Vector3d& up);

  /// The share of `up` in the outward unit normal; nothing where there is no normal (poles, tips).
  [[nodiscard]] std::optional<double> lean(const gp_Pnt2d& uv) const;
  [[nodiscard]] Vector3d point_mm(const gp_Pnt2d& uv) const;
  /// The point between `a` and `b` where the lean is 0, to rounding; the end that leans less where both lean
  /// one way.
  [[nodiscard]] TurningPoint turning_between(const gp_Pnt2d& a, const gp_Pnt2d& b) const;
  /// The turning point nearest to `uv`, by Newton's method; nothing where that leads nowhere.
  [[nodiscard]] std::optional<TurningPoint> turning_near(const gp_Pnt2d& uv) const;
  /// Radius of the surface's upright section at a turning point; +inf where that is straight.
  [[nodiscard]] double upright_radius_mm(const gp_Pnt2d& uv) const;

 private:
  BRepAdaptor_Surface surface_;
  Vector3d up_;
  double outward_;
};

}  // namespace pinjaw::part

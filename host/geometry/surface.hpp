#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "host/geometry/mesh.hpp"

namespace pinjaw::geometry {

/// How far outside a region still touches it. Chosen: far above rounding at 1 m, far below any mesh
/// deflection.
inline constexpr double kTouch_mm = 1e-9;

/// A disc of `radius_mm` swept in plan from `from_mm` to `to_mm` (a stadium; a disc where both are equal).
struct Sweep {
  Vector2d from_mm = Vector2d::Zero();
  Vector2d to_mm = Vector2d::Zero();
  double radius_mm = 0;
};

/// An upright rectangle in plan; `direction` is the unit vector of its first half extent.
struct Rectangle {
  Vector2d center_mm = Vector2d::Zero();
  Vector2d direction = Vector2d::UnitX();
  Vector2d half_mm = Vector2d::Zero();
};

/// Heights that count: facets are cut to lo <= z <= hi.
struct Slab {
  double lo_mm = -std::numeric_limits<double>::infinity();
  double hi_mm = std::numeric_limits<double>::infinity();
};

struct Ray {
  Vector3d origin_mm = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitZ();  ///< unit
};

struct Hit {
  double distance_mm = 0;
  Vector3d point_mm = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();  ///< unit, outward, of the facet
  int triangle = 0;
  int face = 0;
};

/// The part's surface with a spatial index: the one geometric primitive of the planner (DESIGN 4).
///
/// Answers exactly on the triangles, in double precision: the lowest or highest z of the surface over a disc
/// or over a swept disc, within a slab. Touching counts: regions are grown by kTouch_mm so that rounding
/// cannot lose a touch. Immutable; copies share the index; queries may run from many threads.
class Surface {
 public:
  explicit Surface(TriangleMesh mesh);

  /// Lowest z of the surface over the closed region, within the slab; +inf where there is none.
  [[nodiscard]] double lowest_z_mm(const Sweep& region, const Slab& slab = {}) const;
  /// Highest z of the surface over the closed region, within the slab; -inf where there is none.
  [[nodiscard]] double highest_z_mm(const Sweep& region, const Slab& slab = {}) const;
  /// Whether any of the surface lies over the closed region, within the slab.
  [[nodiscard]] bool meets(const Sweep& region, const Slab& slab) const;
  [[nodiscard]] bool meets(const Rectangle& region, const Slab& slab) const;
  /// First facet hit by the ray at distance > 0, from either side; nothing where it misses.
  [[nodiscard]] std::optional<Hit> first_hit(const Ray& ray) const;
  /// The lowest surface point above (x, y): z and the face it lies on; nothing where there is none.
  /// Its distance is counted from the lowest z of the surface.
  [[nodiscard]] std::optional<Hit> lowest_above(const Vector2d& p_mm) const;

  /// The height of the silhouette that stands for a surface point at `z_mm` above or below it.
  ///
  /// Behind a silhouette a surface of upright radius R is at depth d only at sqrt(2 R d) above and below. So
  /// what a pin meets at `p_mm` within `depth_mm` in plan spans heights that a true pin does not touch: it
  /// touches at the silhouette alone. Gives the silhouette's height where one passes within `depth_mm` of
  /// `p_mm` and `z_mm` lies in that span, taken half again as large since p and the triangles are right to
  /// parts of the depth; else nothing.
  [[nodiscard]] std::optional<double> silhouette_z_mm(const Vector2d& p_mm, double z_mm,
                                                      double depth_mm) const;

  [[nodiscard]] const TriangleMesh& mesh() const;
  [[nodiscard]] Interval x_range_mm() const;
  [[nodiscard]] Interval y_range_mm() const;
  [[nodiscard]] Interval z_range_mm() const;

 private:
  friend class Patch;
  struct Index;
  std::shared_ptr<const Index> index_;
};

}  // namespace pinjaw::geometry

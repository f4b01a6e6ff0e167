#pragma once

#include <optional>

#include "host/geometry/facet.hpp"

namespace pinjaw::geometry {

/// One ray against boxes and facets, watertight: a ray through a shared edge or corner hits one of its facets
/// (Woop, Benthin and Wald 2013: the same products decide on both sides of an edge).
class RayTest {
 public:
  explicit RayTest(const Ray& ray);

  /// Distance at which the ray enters the box, at least 0; +inf where it misses.
  [[nodiscard]] double entry_mm(const Box& box) const;
  /// Distance to the facet where that is above 0.
  [[nodiscard]] std::optional<double> distance_mm(const Facet& facet) const;

 private:
  Vector3d origin_mm_;
  Vector3d direction_;
  std::array<int, 3> axes_{};  ///< the last is the direction's largest
  Vector3d shear_;
};

}  // namespace pinjaw::geometry

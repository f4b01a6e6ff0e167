#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "host/geometry/region.hpp"

namespace pinjaw::geometry {

/// What a facet's shadow spans along the normals of its edges: where a region lies beyond one of the spans,
/// it and the facet are apart. Made once a facet, so that most facets are settled without being cut.
class ShadowSpans {
 public:
  explicit ShadowSpans(const Facet& facet) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector2d along_mm = (facet.p_mm[(i + 1) % 3] - facet.p_mm[i]).head<2>();
      axes_[i] = Vector2d(-along_mm.y(), along_mm.x());
      if (const double length_mm = along_mm.norm(); length_mm > 0) axes_[i] /= length_mm;
      spans_[i] = shadow_span(facet, axes_[i]);
    }
  }

  /// True only where cutting the facet to the region leaves nothing.
  template <class Region>
  [[nodiscard]] bool apart_from(const Region& region) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (apart(spans_[i], region.span(axes_[i]))) return true;
    }
    return false;
  }

 private:
  std::array<Vector2d, 3> axes_;  ///< unit, square to the edges; zero for an edge without length in plan
  std::array<Interval, 3> spans_;
};

/// |n_z| under which a facet counts as upright: its z extremes over any region lie on its edges to within
/// rounding.
inline constexpr double kUprightNormal = 1e-12;

/// Whether (x, y) lies in the facet's shadow, its outline included.
inline bool shadow_contains(const Facet& facet, const Vector2d& q_mm) {
  bool left = false;
  bool right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector2d a_mm = facet.p_mm[i].head<2>();
    const Vector2d b_mm = facet.p_mm[(i + 1) % 3].head<2>();
    const double side = (b_mm - a_mm).x() * (q_mm - a_mm).y() - (b_mm - a_mm).y() * (q_mm - a_mm).x();
    left |= side > 0;
    right |= side < 0;
  }
  return !(left && right);
}

/// The z range of the facet over the region; empty where they do not meet.
///
/// The facet over the region is a convex set, so its z values are one interval, and its extremes lie on the
/// facet's edges, cut to the region, or at the region's own extreme point along the facet's slope where that
/// lies inside.
template <class Region>
Interval z_range_over(const Facet& facet, const Region& region) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Interval z{kInfinity, -kInfinity};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& a_mm = facet.p_mm[i];
    const Vector3d& b_mm = facet.p_mm[(i + 1) % 3];
    const Interval t = region.clip(a_mm.head<2>(), b_mm.head<2>());
    if (t.lo > t.hi) continue;
    const double z1 = t.lo == 1 ? b_mm.z() : a_mm.z() + t.lo * (b_mm.z() - a_mm.z());
    const double z2 = t.hi == 1 ? b_mm.z() : a_mm.z() + t.hi * (b_mm.z() - a_mm.z());
    z.lo = std::min({z.lo, z1, z2});
    z.hi = std::max({z.hi, z1, z2});
  }
  if (std::abs(facet.normal.z()) < kUprightNormal) return z;
  const Vector2d slope = -facet.normal.head<2>() / facet.normal.z();
  const auto include = [&](const Vector2d& q_mm) {
    if (!shadow_contains(facet, q_mm)) return;
    const auto [low, high] = std::minmax({facet.p_mm[0].z(), facet.p_mm[1].z(), facet.p_mm[2].z()});
    const double z_mm = facet.p_mm[0].z() + slope.dot(q_mm - facet.p_mm[0].head<2>());
    z.lo = std::min(z.lo, std::clamp(z_mm, low, high));
    z.hi = std::max(z.hi, std::clamp(z_mm, low, high));
  };
  include(region.support(-slope));
  include(region.support(slope));
  return z;
}

}  // namespace pinjaw::geometry

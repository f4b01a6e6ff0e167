#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "host/geometry/bvh.hpp"
#include "host/geometry/facet.hpp"

/// What a surface asks its tree, and the questions themselves. Private to host/geometry.
namespace pinjaw::geometry {

struct Surface::Index {
  TriangleMesh mesh;
  Box box;
  std::vector<Facet> facets;       ///< in the order of the tree's leaves
  std::vector<Box> boxes;          ///< theirs
  std::vector<ShadowSpans> spans;  ///< theirs
  Bvh tree{{}};
  /// Two neighbouring points of a silhouette, in the order of the leaves of their tree.
  struct Link {
    Vector3d a_mm, b_mm;
    double radius_mm;
  };
  std::vector<Link> links;
  Bvh links_tree{{}};

  explicit Index(TriangleMesh source);
  void index_silhouettes();

  /// Calls leaf(facet) for facets that may meet the region and the slab [slab.lo, slab.hi]; `slab` may shrink
  /// while the walk goes on. Stops where leaf returns true.
  template <class Region, class First, class Leaf>
  void visit(const Region& region, const Slab& slab, First&& first, Leaf&& leaf) const;
  /// False only where the region and the i-th facet's shadow are apart.
  template <class Region>
  [[nodiscard]] bool may_meet(const Region& region, std::size_t i) const {
    return region.may_meet(boxes[i]) && region.may_meet(facets[i]) && !spans[i].apart_from(region);
  }
  [[nodiscard]] Hit hit_of(const Facet& facet, double distance_mm, const Vector3d& p_mm) const;
  /// Of what lowest_facet() found over one place.
  [[nodiscard]] std::optional<Hit> lowest_hit(const std::pair<double, const Facet*>& found,
                                              const Vector2d& p_mm) const;
};

/// `z` cut to the slab; empty where nothing is left.
inline Interval within(const Interval& z, const Slab& slab) {
  return {std::max(z.lo, slab.lo_mm), std::min(z.hi, slab.hi_mm)};
}

inline constexpr auto kLowerFirst = [](const Bvh::Node& a, const Bvh::Node& b) {
  return a.box.lo.z() < b.box.lo.z();
};
inline constexpr auto kHigherFirst = [](const Bvh::Node& a, const Bvh::Node& b) {
  return a.box.hi.z() > b.box.hi.z();
};

template <class Region, class First, class Leaf>
void Surface::Index::visit(const Region& region, const Slab& slab, First&& first, Leaf&& leaf) const {
  const auto off = [&](const Box& candidate) {
    return candidate.lo.z() > slab.hi_mm || candidate.hi.z() < slab.lo_mm;
  };
  tree.walk([&](const Bvh::Node& node) { return off(node.box) || !region.may_meet(node.box); }, first,
            [&](const Bvh::Node& node) {
              const auto end = static_cast<std::size_t>(node.first + node.count);
              for (auto i = static_cast<std::size_t>(node.first); i < end; ++i) {
                if (off(boxes[i]) || !may_meet(region, i)) continue;
                if (leaf(facets[i])) return true;
              }
              return false;
            });
}

// The questions, of anything that can visit(region, slab, first, leaf) its facets.

template <class Source, class Region>
double lowest(const Source& source, const Region& region, Slab slab) {
  double best = std::numeric_limits<double>::infinity();
  source.visit(region, slab, kLowerFirst, [&](const Facet& facet) {
    const Interval z = within(z_range_over(facet, region), slab);
    if (z.lo > z.hi) return false;
    best = z.lo;
    slab.hi_mm = std::nextafter(
        z.lo, -std::numeric_limits<double>::infinity());  // what is as low need not be looked at
    return best <= slab.lo_mm;
  });
  return best;
}

/// The lowest z and its facet; of facets as low the first of the mesh.
template <class Source, class Region>
std::pair<double, const Facet*> lowest_facet(const Source& source, const Region& region) {
  Slab slab;
  std::pair<double, const Facet*> best{std::numeric_limits<double>::infinity(), nullptr};
  source.visit(region, slab, kLowerFirst, [&](const Facet& facet) {
    const Interval z = within(z_range_over(facet, region), slab);
    if (z.lo > z.hi || z.lo > best.first) return false;
    if (z.lo == best.first && best.second != nullptr && facet.triangle > best.second->triangle) return false;
    best = {z.lo, &facet};
    slab.hi_mm = z.lo;
    return false;
  });
  return best;
}

template <class Source, class Region>
double highest(const Source& source, const Region& region, Slab slab) {
  double best = -std::numeric_limits<double>::infinity();
  source.visit(region, slab, kHigherFirst, [&](const Facet& facet) {
    const Interval z = within(z_range_over(facet, region), slab);
    if (z.lo > z.hi) return false;
    best = z.hi;
    slab.lo_mm = std::nextafter(
        z.hi, std::numeric_limits<double>::infinity());  // what is as high need not be looked at
    return best >= slab.hi_mm;
  });
  return best;
}

template <class Source, class Region>
bool meets(const Source& source, const Region& region, const Slab& slab) {
  bool met = false;
  source.visit(region, slab, kLowerFirst, [&](const Facet& facet) {
    const Interval z = within(z_range_over(facet, region), slab);
    met = z.lo <= z.hi;
    return met;
  });
  return met;
}

}  // namespace pinjaw::geometry

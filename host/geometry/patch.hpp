#pragma once

#include <cstdint>
#include <vector>

#include "host/geometry/surface.hpp"

namespace pinjaw::geometry {

/// The facets of a surface over one region, found in one walk: for several questions about one place. Answers
/// are the surface's own, to the bit, as long as what is asked lies within the region. The surface outlives
/// it.
class Patch {
 public:
  Patch(const Surface& surface, const Sweep& within);

  [[nodiscard]] double lowest_z_mm(const Sweep& region, const Slab& slab = {}) const;
  [[nodiscard]] double highest_z_mm(const Sweep& region, const Slab& slab = {}) const;
  [[nodiscard]] std::optional<Hit> lowest_above(const Vector2d& p_mm) const;

  /// As the tree's: see Surface::Index.
  template <class Region, class First, class Leaf>
  void visit(const Region& region, const Slab& slab, First&& first, Leaf&& leaf) const;

 private:
  struct Entry {
    double lo_mm, hi_mm;  ///< in z
    std::size_t facet;
  };
  const Surface::Index& index_;
  std::vector<Entry> entries_;
};

}  // namespace pinjaw::geometry

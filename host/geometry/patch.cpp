#include "host/geometry/patch.hpp"

#include "host/geometry/surface_index.hpp"

namespace pinjaw::geometry {

Patch::Patch(const Surface& surface, const Sweep& within) : index_(*surface.index_) {
  constexpr std::size_t kUsual = 64;  // chosen: a pin stands under some dozens of facets
  entries_.reserve(kUsual);
  index_.visit(Stadium(within), Slab{}, kLowerFirst, [&](const Facet& facet) {
    const auto at = static_cast<std::size_t>(&facet - index_.facets.data());
    entries_.push_back({index_.boxes[at].lo.z(), index_.boxes[at].hi.z(), at});
    return false;
  });
}

template <class Region, class First, class Leaf>
void Patch::visit(const Region& region, const Slab& slab, First&& /*first*/, Leaf&& leaf) const {
  for (const Entry& entry : entries_) {
    if (entry.lo_mm > slab.hi_mm || entry.hi_mm < slab.lo_mm) continue;
    if (!index_.may_meet(region, entry.facet)) continue;
    if (leaf(index_.facets[entry.facet])) return;
  }
}

double Patch::lowest_z_mm(const Sweep& region, const Slab& slab) const {
  return lowest(*this, Stadium(region), slab);
}

double Patch::highest_z_mm(const Sweep& region, const Slab& slab) const {
  return highest(*this, Stadium(region), slab);
}

std::optional<Hit> Patch::lowest_above(const Vector2d& p_mm) const {
  return index_.lowest_hit(lowest_facet(*this, Stadium({p_mm, p_mm, 0})), p_mm);
}

}  // namespace pinjaw::geometry

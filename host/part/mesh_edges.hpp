#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/geometry/mesh.hpp"

/// Which facets of a mesh share an edge. Private to host/part.
namespace pinjaw::part {

/// One side of one facet: from vertex `low` to the greater `high`, or back where not `forward`.
struct FacetSide {
  int low = 0;
  int high = 0;
  int facet = 0;
  bool forward = true;
};

/// All sides of all facets, sorted so that those of one edge stand together.
std::vector<FacetSide> facet_sides(const geometry::TriangleMesh& mesh);

/// Calls `visit(std::span<const FacetSide>)` for each edge, with the sides that share it.
template <class Visit>
void for_each_edge(const std::vector<FacetSide>& sides, const Visit& visit) {
  for (std::size_t from = 0; from < sides.size();) {
    std::size_t to = from + 1;
    while (to < sides.size() && sides[to].low == sides[from].low && sides[to].high == sides[from].high) ++to;
    visit(std::span(sides).subspan(from, to - from));
    from = to;
  }
}

}  // namespace pinjaw::part

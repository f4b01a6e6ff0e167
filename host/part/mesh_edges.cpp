#include "host/part/mesh_edges.hpp"

#include <algorithm>
#include <tuple>

namespace pinjaw::part {

std::vector<FacetSide> facet_sides(const geometry::TriangleMesh& mesh) {
  std::vector<FacetSide> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t facet = 0; facet < mesh.triangles.size(); ++facet) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = mesh.triangles[facet][i];
      const int to = mesh.triangles[facet][(i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), static_cast<int>(facet), from < to});
    }
  }
  std::ranges::sort(sides, {},
                    [](const FacetSide& side) { return std::tuple(side.low, side.high, side.facet); });
  return sides;
}

}  // namespace pinjaw::part

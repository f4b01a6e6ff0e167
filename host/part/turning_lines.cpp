#include "host/part/turning_lines.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "host/part/mesh_chains.hpp"
#include "host/part/mesh_edges.hpp"
#include "host/part/mesh_weld.hpp"

namespace pinjaw::part {
namespace {

/// Facets on welded vertices; those that the weld left without an area are dropped.
geometry::TriangleMesh joined(const geometry::TriangleMesh& mesh) {
  Welded welded = weld(mesh.vertices_mm);
  geometry::TriangleMesh result;
  for (const auto& corners : mesh.triangles) {
    std::array<int, 3> facet{};
    for (std::size_t i = 0; i < 3; ++i) facet[i] = welded.vertex_of[static_cast<std::size_t>(corners[i])];
    if (facet[0] == facet[1] || facet[1] == facet[2] || facet[2] == facet[0]) continue;
    result.triangles.push_back(facet);
  }
  result.vertices_mm = std::move(welded.vertices_mm);
  return result;
}

/// By the turn of its corners in plan, so that upright facets are told by rounding: either way the edges
/// between the two kinds close around the shadow.
bool corners_turn_down(const geometry::TriangleMesh& mesh, int facet) {
  const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(facet)];
  const auto at = [&](int vertex) { return mesh.vertices_mm[static_cast<std::size_t>(vertex)]; };
  return (at(b) - at(a)).cross(at(c) - at(a)).z() < 0;
}

}  // namespace

std::vector<std::vector<Vector3d>> turning_lines(const geometry::TriangleMesh& mesh) {
  const geometry::TriangleMesh whole = joined(mesh);
  std::vector<ChainEdge> edges;
  for_each_edge(facet_sides(whole), [&](std::span<const FacetSide> sides) {
    const auto down = std::ranges::count_if(
        sides, [&](const FacetSide& side) { return corners_turn_down(whole, side.facet); });
    const bool alone = sides.size() == 1;
    if (alone || (down > 0 && down < std::ssize(sides))) edges.push_back({sides[0].low, sides[0].high, 0});
  });
  std::vector<std::vector<Vector3d>> lines;
  for (const Chain& chain : chains_of(edges, whole.vertices_mm)) {
    std::vector<Vector3d>& line = lines.emplace_back();
    for (const int vertex : chain.vertices)
      line.push_back(whole.vertices_mm[static_cast<std::size_t>(vertex)]);
    if (chain.closed) line.push_back(line.front());
  }
  return lines;
}

}  // namespace pinjaw::part

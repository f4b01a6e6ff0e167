#include "host/part/stl_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>

#include "host/part/mesh_edges.hpp"
#include "host/part/mesh_shells.hpp"
#include "host/part/mesh_weld.hpp"

namespace pinjaw::part {
namespace {

using Corners = std::array<int, 3>;

/// The same facet whichever corner it begins with.
Corners from_least(Corners corners) {
  std::ranges::rotate(corners, std::ranges::min_element(corners));
  return corners;
}

void drop_degenerate_and_repeated(std::vector<Corners>& triangles, MeshCounts& counts) {
  counts.degenerate = static_cast<int>(std::erase_if(triangles, [](const Corners& corners) {
    return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
  }));
  std::set<Corners> seen;
  counts.repeated = static_cast<int>(std::erase_if(
      triangles, [&](const Corners& corners) { return !seen.insert(from_least(corners)).second; }));
}

}  // namespace

base::Expected<StlMesh> joined_mesh(std::span<const StlSolid> solids) {
  std::vector<Vector3d> corners_mm;
  for (const StlSolid& solid : solids) {
    for (const StlFacet& facet : solid.facets) {
      corners_mm.insert(corners_mm.end(), facet.corners_mm.begin(), facet.corners_mm.end());
    }
  }
  StlMesh result;
  result.counts.facets = static_cast<int>(corners_mm.size() / 3);
  const Welded welded = weld(corners_mm);
  result.mesh.vertices_mm = welded.vertices_mm;
  for (std::size_t i = 0; i + 2 < welded.vertex_of.size(); i += 3) {
    result.mesh.triangles.push_back({welded.vertex_of[i], welded.vertex_of[i + 1], welded.vertex_of[i + 2]});
  }
  drop_degenerate_and_repeated(result.mesh.triangles, result.counts);
  if (result.mesh.triangles.empty()) return base::failure("none of its facets has an area");
  const auto shells = turn_outwards(result.mesh);
  if (!shells) return tl::unexpected(shells.error());
  result.counts.shells = shells->count;
  result.counts.turned = shells->turned;
  for_each_edge(facet_sides(result.mesh), [&](std::span<const FacetSide> sides) {
    const auto forward = std::ranges::count_if(sides, &FacetSide::forward);
    if (2 * forward != std::ssize(sides)) ++result.counts.open_edges;
    if (sides.size() > 2) ++result.counts.crowded_edges;
  });
  return result;
}

base::Expected<StlMesh> read_stl_mesh(std::string_view bytes, const std::string& file, int most_facets) {
  const auto solids = read_stl(bytes, file, most_facets);
  if (!solids) return tl::unexpected(solids.error());
  auto mesh = joined_mesh(*solids);
  if (!mesh) return base::failure(file + ": " + mesh.error().message);
  return mesh;
}

MeshMass mass_of(const geometry::TriangleMesh& mesh, const MeshCounts& counts) {
  const Vector3d middle_mm = middle_of(mesh);
  double six_volumes_mm3 = 0;
  double area2_mm2 = 0;
  Vector3d moment = Vector3d::Zero();
  Vector3d area_moment = Vector3d::Zero();
  for (const Corners& corners : mesh.triangles) {
    const Vector3d a = mesh.vertices_mm[static_cast<std::size_t>(corners[0])] - middle_mm;
    const Vector3d b = mesh.vertices_mm[static_cast<std::size_t>(corners[1])] - middle_mm;
    const Vector3d c = mesh.vertices_mm[static_cast<std::size_t>(corners[2])] - middle_mm;
    const double volume = a.dot(b.cross(c));
    const double area = (b - a).cross(c - a).norm();
    six_volumes_mm3 += volume;
    moment += volume * (a + b + c) / 4;
    area2_mm2 += area;
    area_moment += area * (a + b + c) / 3;
  }
  if (counts.closed() && six_volumes_mm3 > 0) {
    return {.volume_mm3 = six_volumes_mm3 / 6, .centroid_mm = middle_mm + moment / six_volumes_mm3};
  }
  return {.volume_mm3 = 0, .centroid_mm = area2_mm2 > 0 ? middle_mm + area_moment / area2_mm2 : middle_mm};
}

}  // namespace pinjaw::part

#include "host/part/stl_part.hpp"

#include <algorithm>

#include "host/part/mesh_contours.hpp"
#include "host/part/stl_mesh.hpp"

namespace pinjaw::part {
namespace {

/// Of each solid by itself; 0 where it is open.
std::vector<Solid> listed(std::span<const StlSolid> solids) {
  std::vector<Solid> list;
  for (const StlSolid& solid : solids) {
    const auto joined = joined_mesh({&solid, 1});
    list.push_back({solid.name, joined ? mass_of(joined->mesh, joined->counts).volume_mm3 : 0});
  }
  return list;
}

}  // namespace

base::Expected<Part> stl_part(std::span<const StlSolid> solids, std::span<const StlSolid> chosen,
                              const Matrix3d& rotation) {
  auto joined = joined_mesh(chosen);
  if (!joined) return tl::unexpected(joined.error());
  const geometry::TriangleMesh mesh = rotated(std::move(joined->mesh), rotation);
  const MeshMass mass = mass_of(mesh, joined->counts);
  MeshContours found = contours_of(mesh);
  double chord_mm = 0;
  for (const Contour& contour : found.contours) chord_mm = std::max(chord_mm, contour.error_mm);
  return Part{.name = {},
              .file = {},
              .sha256 = {},
              .surface = geometry::Surface(rounded(mesh, found.rims, kMeshDeflectionMm)),
              .edges = {},
              .walls = {},
              .contours = std::move(found.contours),
              .edge_counts = {},
              .mesh_counts = joined->counts,
              .contour_counts = found.counts,
              .mesh_deflection_mm = chord_mm,
              .solids = listed(solids),
              .volume_mm3 = mass.volume_mm3,
              .centroid_mm = mass.centroid_mm,
              .profile = {}};
}

}  // namespace pinjaw::part

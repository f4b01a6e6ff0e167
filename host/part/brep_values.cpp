#include "host/part/brep.hpp"

namespace pinjaw::part {
namespace {

base::Expected<std::vector<Solid>> listed(const std::vector<NamedShape>& solids) {
  std::vector<Solid> list;
  for (const NamedShape& solid : solids) {
    const auto mass = mass_of(solid.shape);
    if (!mass) return tl::unexpected(mass.error());
    list.push_back({solid.name, mass->volume_mm3});
  }
  return list;
}

}  // namespace

base::Expected<BrepValues> values_of(const std::vector<NamedShape>& solids,
                                     const std::vector<NamedShape>& chosen, const Vector3d& up,
                                     const base::IsolatedStage& stage) {
  const Shape shape = compound_of(chosen);
  stage("computing its volume");
  auto list = listed(solids);
  if (!list) return tl::unexpected(list.error());
  const auto mass = mass_of(shape);
  if (!mass) return tl::unexpected(mass.error());
  stage("reading its edges");
  auto edges = edges_of(shape);
  if (!edges) return tl::unexpected(edges.error());
  stage("reading its faces");
  auto wall_faces = wall_faces_of(shape);
  if (!wall_faces) return tl::unexpected(wall_faces.error());
  stage("meshing its faces");
  auto mesh = mesh_of(shape, kMostTriangles);
  if (!mesh) return tl::unexpected(mesh.error());
  stage("tracing its silhouettes");
  auto silhouettes = silhouettes_of(shape, up.normalized());
  if (!silhouettes) return tl::unexpected(silhouettes.error());
  mesh->mesh.silhouettes = std::move(*silhouettes);
  return BrepValues{.solids = std::move(*list),
                    .mass = *mass,
                    .edges = std::move(*edges),
                    .wall_faces = std::move(*wall_faces),
                    .mesh = std::move(*mesh)};
}

}  // namespace pinjaw::part

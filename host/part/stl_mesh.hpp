#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/expected.hpp"
#include "host/geometry/mesh.hpp"
#include "host/part/part.hpp"
#include "host/part/stl_file.hpp"

/// Facets of an STL file made one surface. Private to host/part.
namespace pinjaw::part {

struct StlMesh {
  geometry::TriangleMesh mesh;  ///< `face_of` counts the connected shells from 1
  MeshCounts counts;
};

/// The facets of `solids` as one mesh: corners that differ by single-precision rounding are one vertex,
/// facets without area and repeated ones are dropped, and the rest turned so that neighbours agree and the
/// outside is outside. A shell inside another keeps the sense that the file gives it relative to the outer
/// one: a cavity and a body inside a body are told apart by nothing else. A failure where no facet has an
/// area or there are too many shells.
base::Expected<StlMesh> joined_mesh(std::span<const StlSolid> solids);

/// The same straight from a file's bytes: a pure function of them, for any bytes.
base::Expected<StlMesh> read_stl_mesh(std::string_view bytes, const std::string& file, int most_facets);

struct MeshMass {
  double volume_mm3 = 0;
  Vector3d centroid_mm = Vector3d::Zero();
};

/// What the mesh encloses, by the divergence theorem; volume 0 and the centroid of its facets' area where it
/// encloses nothing or is not closed.
MeshMass mass_of(const geometry::TriangleMesh& mesh, const MeshCounts& counts);

}  // namespace pinjaw::part

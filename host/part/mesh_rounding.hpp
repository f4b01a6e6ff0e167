#pragma once

#include <utility>
#include <vector>

#include "host/geometry/mesh.hpp"

/// Chords of a mesh bent back to the arcs that they stand for. Private to host/part.
namespace pinjaw::part {

/// An arc in plan and the edges of the mesh that are its chords, as pairs of vertices.
struct Rim {
  geometry::Arc arc;
  std::vector<std::pair<int, int>> edges;
};

/// The mesh with every rim, and the facets of its cylinder that go on from it, cut finer, until no
/// chord lies farther than `sagitta_mm` from the arc. Facets beside a rim are stretched or cut to the arc, in
/// plan; heights along a rim stay. What the planner asks of the surface then agrees with the curves that it
/// fits, however coarse the file is.
geometry::TriangleMesh rounded(const geometry::TriangleMesh& mesh, const std::vector<Rim>& rims,
                               double sagitta_mm);

}  // namespace pinjaw::part

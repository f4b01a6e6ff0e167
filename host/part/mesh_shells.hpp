#pragma once

#include "host/base/expected.hpp"
#include "host/geometry/mesh.hpp"

/// Connected shells of a mesh and their outsides. Private to host/part.
namespace pinjaw::part {

using geometry::Vector3d;

struct Shells {
  int count = 0;
  int turned = 0;  ///< facets whose corners were put in the other order
};

/// Turns facets so that neighbours across an edge of two facets agree, then whole shells so that those inside
/// no other face outwards; a shell inside another keeps its sense relative to the outermost one about it.
/// Fills `face_of` with the shells' numbers from 1. An open shell faces away from the middle of its box.
/// A failure where there are more than kMostShells shells, which no part that a jaw could hold has.
base::Expected<Shells> turn_outwards(geometry::TriangleMesh& mesh);

inline constexpr int kMostShells = 2000;

/// The middle of the mesh's box.
Vector3d middle_of(const geometry::TriangleMesh& mesh);

}  // namespace pinjaw::part

#pragma once

#include <span>
#include <vector>

#include "host/geometry/plane.hpp"

/// Edges of a mesh put one after another. Private to host/part.
namespace pinjaw::part {

using geometry::Vector3d;

struct ChainEdge {
  int from = 0;
  int to = 0;
  double bulge_mm = 0;  ///< how far the face beside it may bulge beyond its facets
};

struct Chain {
  std::vector<int> vertices;  ///< in order; a closed chain does not repeat its first
  bool closed = false;
  double bulge_mm = 0;  ///< the most of its edges
};

/// Every edge in exactly one chain. A chain goes on through a vertex of two edges; where more meet, through
/// the pairs of them that turn least, by at most geometry::kMostStepRad.
std::vector<Chain> chains_of(std::span<const ChainEdge> edges, std::span<const Vector3d> vertices_mm);

}  // namespace pinjaw::part

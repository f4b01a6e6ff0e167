#include "host/part/mesh_chains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "host/geometry/chain_fit.hpp"

namespace pinjaw::part {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// One end of an edge: edge 2 i from its `from`, 2 i + 1 from its `to`.
using End = std::size_t;

End other(End end) {
  return end ^ 1U;
}

int vertex_at(std::span<const ChainEdge> edges, End end) {
  return end % 2 == 0 ? edges[end / 2].from : edges[end / 2].to;
}

/// The unit direction in which an edge leaves its end.
Vector3d leaving(std::span<const ChainEdge> edges, std::span<const Vector3d> vertices_mm, End end) {
  return (vertices_mm[static_cast<std::size_t>(vertex_at(edges, other(end)))] -
          vertices_mm[static_cast<std::size_t>(vertex_at(edges, end))])
      .normalized();
}

struct Turn {
  double cosine;  ///< of the angle by which the way turns; 1 is straight on
  End a, b;
};

/// Pairs the ends at one vertex, the straightest first.
void link(std::span<const ChainEdge> edges, std::span<const Vector3d> vertices_mm, std::span<const End> ends,
          std::vector<End>& linked) {
  constexpr std::size_t kMostEnds = 64;  // chosen: bounds the pairs at the hub of a fan
  if (ends.size() == 2) {
    linked[ends[0]] = ends[1];
    linked[ends[1]] = ends[0];
    return;
  }
  if (ends.size() > kMostEnds) return;
  std::vector<Turn> turns;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      const double cosine = -leaving(edges, vertices_mm, ends[i]).dot(leaving(edges, vertices_mm, ends[j]));
      if (cosine >= std::cos(geometry::kMostStepRad)) turns.push_back({cosine, ends[i], ends[j]});
    }
  }
  std::ranges::sort(turns, {}, [](const Turn& turn) { return std::tuple(-turn.cosine, turn.a, turn.b); });
  for (const Turn& turn : turns) {
    if (linked[turn.a] != kNone || linked[turn.b] != kNone) continue;
    linked[turn.a] = turn.b;
    linked[turn.b] = turn.a;
  }
}

std::vector<End> links_of(std::span<const ChainEdge> edges, std::span<const Vector3d> vertices_mm) {
  std::vector<End> ends(2 * edges.size());
  for (End end = 0; end < ends.size(); ++end) ends[end] = end;
  std::ranges::stable_sort(ends, {}, [&](End end) { return vertex_at(edges, end); });
  std::vector<End> linked(ends.size(), kNone);
  for (std::size_t from = 0; from < ends.size();) {
    std::size_t to = from + 1;
    while (to < ends.size() && vertex_at(edges, ends[to]) == vertex_at(edges, ends[from])) ++to;
    link(edges, vertices_mm, std::span(ends).subspan(from, to - from), linked);
    from = to;
  }
  return linked;
}

/// The chain that leaves `start`, until it ends or comes back.
Chain chain_from(End start, std::span<const ChainEdge> edges, const std::vector<End>& linked,
                 std::vector<bool>& used) {
  Chain chain;
  End end = start;
  while (true) {
    used[end / 2] = true;
    chain.vertices.push_back(vertex_at(edges, end));
    chain.bulge_mm = std::max(chain.bulge_mm, edges[end / 2].bulge_mm);
    const End next = linked[other(end)];
    if (next == start) {
      chain.closed = true;
      return chain;
    }
    if (next == kNone) {
      chain.vertices.push_back(vertex_at(edges, other(end)));
      return chain;
    }
    end = next;
  }
}

}  // namespace

std::vector<Chain> chains_of(std::span<const ChainEdge> edges, std::span<const Vector3d> vertices_mm) {
  const std::vector<End> linked = links_of(edges, vertices_mm);
  std::vector<bool> used(edges.size(), false);
  std::vector<Chain> chains;
  for (End end = 0; end < linked.size(); ++end) {
    if (linked[end] == kNone && !used[end / 2]) chains.push_back(chain_from(end, edges, linked, used));
  }
  for (std::size_t edge = 0; edge < edges.size(); ++edge) {
    if (!used[edge]) chains.push_back(chain_from(2 * edge, edges, linked, used));
  }
  return chains;
}

}  // namespace pinjaw::part

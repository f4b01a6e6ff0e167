#include "host/part/mesh_contours.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "host/geometry/chain_fit.hpp"
#include "host/model/tolerance.hpp"
#include "host/part/mesh_chains.hpp"
#include "host/part/mesh_edges.hpp"
#include "host/part/placing.hpp"

namespace pinjaw::part {
namespace {

using geometry::TriangleMesh;

constexpr double kPointMm = 1e-3;   // an edge shorter than this in plan is a point
constexpr double kJaggedRatio = 8;  // a smooth silhouette shorter than this times its bulge has no direction
constexpr double kCornerSteps = 8;  // how many steps of single precision a facet's corners may be off
constexpr int kMostThinNeighbours = 16;

/// A facet as its edges need it.
struct Facet {
  Vector3d normal =
      Vector3d::Zero();  ///< unit; borrowed from a neighbour where the facet is too thin for one
  double area2_mm2 = 0;  ///< twice its area
  double height_mm = 0;  ///< over its longest edge
  int longest = 0;       ///< which edge that is: from that corner to the next
};

enum class Facing { Down, Upright, Up };

Facing facing_of(const Facet& facet) {
  if (std::abs(facet.normal.z()) <= kUprightSine) return Facing::Upright;
  return facet.normal.z() < 0 ? Facing::Down : Facing::Up;
}

bool is_steep(const Facet& facet) {
  return std::abs(facet.normal.z()) <= kSteepSine;
}

const Vector3d& corner(const TriangleMesh& mesh, std::size_t facet, int i) {
  return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[facet][static_cast<std::size_t>(i % 3)])];
}

Facet facet_at(const TriangleMesh& mesh, std::size_t facet) {
  const Vector3d cross = (corner(mesh, facet, 1) - corner(mesh, facet, 0))
                             .cross(corner(mesh, facet, 2) - corner(mesh, facet, 0));
  Facet result;
  double longest_mm = 0;
  for (int i = 0; i < 3; ++i) {
    const double length_mm = (corner(mesh, facet, i + 1) - corner(mesh, facet, i)).norm();
    if (length_mm <= longest_mm) continue;
    longest_mm = length_mm;
    result.longest = i;
  }
  result.area2_mm2 = cross.norm();
  result.height_mm = result.area2_mm2 / longest_mm;
  result.normal = cross.normalized();
  return result;
}

/// Below this height the rounding of the corners turns a facet by more than what counts as upright.
double thin_mm(const TriangleMesh& mesh) {
  double farthest_mm = 0;
  for (const Vector3d& p : mesh.vertices_mm) farthest_mm = std::max(farthest_mm, p.cwiseAbs().maxCoeff());
  return kCornerSteps * std::numeric_limits<float>::epsilon() * farthest_mm / kUprightSine;
}

/// The facet across the longest edge of each one, or itself where there is none.
std::vector<std::size_t> across_longest(const TriangleMesh& mesh, const std::vector<FacetSide>& sides,
                                        const std::vector<Facet>& facets) {
  std::vector<std::size_t> across(facets.size());
  for (std::size_t i = 0; i < across.size(); ++i) across[i] = i;
  const auto is_longest = [&](const FacetSide& side) {
    const auto facet = static_cast<std::size_t>(side.facet);
    const int from = mesh.triangles[facet][static_cast<std::size_t>(facets[facet].longest)];
    return from == (side.forward ? side.low : side.high);
  };
  for_each_edge(sides, [&](std::span<const FacetSide> edge) {
    if (edge.size() != 2) return;
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      if (is_longest(edge[i]))
        across[static_cast<std::size_t>(edge[i].facet)] = static_cast<std::size_t>(edge[1 - i].facet);
    }
  });
  return across;
}

/// All facets; a thin one takes the normal of the first that is not beyond its longest edge, since what lies
/// there is the face that it is a sliver of.
std::vector<Facet> facets_of(const TriangleMesh& mesh, const std::vector<FacetSide>& sides) {
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) facets.push_back(facet_at(mesh, i));
  const auto across = across_longest(mesh, sides, facets);
  const double thin = thin_mm(mesh);
  for (std::size_t i = 0; i < facets.size(); ++i) {
    std::size_t from = i;
    for (int step = 0; step < kMostThinNeighbours && facets[from].height_mm < thin; ++step)
      from = across[from];
    if (facets[from].height_mm >= thin) facets[i].normal = facets[from].normal;
  }
  return facets;
}

enum class Kind { None, Crease, Smooth, Gentle };

Kind kind_of(std::span<const FacetSide> edge, const std::vector<Facet>& facets) {
  if (edge.size() != 2) return Kind::Crease;
  const Facet& a = facets[static_cast<std::size_t>(edge[0].facet)];
  const Facet& b = facets[static_cast<std::size_t>(edge[1].facet)];
  const bool folded = a.normal.dot(b.normal) < std::cos(geometry::kMostStepRad);
  const bool beside_wall = facing_of(a) == Facing::Upright || facing_of(b) == Facing::Upright;
  if (facing_of(a) != facing_of(b)) return folded || beside_wall ? Kind::Crease : Kind::Smooth;
  if (!folded || beside_wall) return Kind::None;
  return is_steep(a) || is_steep(b) ? Kind::Crease : Kind::Gentle;
}

/// How far a smooth face bulges beyond each of its facets: the most sagitta of a chord that turns as the
/// facet and a neighbour do and is as wide as the narrower of the two.
std::vector<double> bulges_mm(const std::vector<FacetSide>& sides, const std::vector<Facet>& facets,
                              const TriangleMesh& mesh) {
  std::vector<double> bulges(facets.size(), 0);
  for_each_edge(sides, [&](std::span<const FacetSide> edge) {
    if (edge.size() != 2) return;
    const auto a = static_cast<std::size_t>(edge[0].facet);
    const auto b = static_cast<std::size_t>(edge[1].facet);
    const double turn_rad = std::acos(std::clamp(facets[a].normal.dot(facets[b].normal), -1.0, 1.0));
    if (turn_rad > geometry::kMostStepRad) return;
    const double length_mm = (mesh.vertices_mm[static_cast<std::size_t>(edge[0].high)] -
                              mesh.vertices_mm[static_cast<std::size_t>(edge[0].low)])
                                 .norm();
    const double width_mm = std::min(facets[a].area2_mm2, facets[b].area2_mm2) / length_mm;
    const double bulge_mm = width_mm / 2 * std::tan(turn_rad / 4);
    bulges[a] = std::max(bulges[a], bulge_mm);
    bulges[b] = std::max(bulges[b], bulge_mm);
  });
  return bulges;
}

struct ContourEdges {
  std::vector<ChainEdge> creases;
  std::vector<ChainEdge> smooth;
  ContourCounts counts;
};

ContourEdges contour_edges(const TriangleMesh& mesh) {
  const auto sides = facet_sides(mesh);
  const auto facets = facets_of(mesh, sides);
  const auto bulges = bulges_mm(sides, facets, mesh);
  ContourEdges result;
  for_each_edge(sides, [&](std::span<const FacetSide> edge) {
    const Kind kind = kind_of(edge, facets);
    if (kind == Kind::None) return;
    const Vector3d along = mesh.vertices_mm[static_cast<std::size_t>(edge[0].high)] -
                           mesh.vertices_mm[static_cast<std::size_t>(edge[0].low)];
    ++result.counts.edges;
    if (kind == Kind::Gentle) {
      ++result.counts.gentle;
    } else if (along.head<2>().norm() < kPointMm) {
      ++result.counts.upright;
    } else if (kind == Kind::Crease) {
      result.creases.push_back({edge[0].low, edge[0].high, 0});
    } else {
      const double bulge_mm = std::max(bulges[static_cast<std::size_t>(edge[0].facet)],
                                       bulges[static_cast<std::size_t>(edge[1].facet)]);
      result.smooth.push_back({edge[0].low, edge[0].high, bulge_mm});
    }
  });
  result.counts.creases = static_cast<int>(result.creases.size());
  result.counts.silhouettes = static_cast<int>(result.smooth.size());
  return result;
}

std::vector<Vector2d> in_plan(const TriangleMesh& mesh, const Chain& chain) {
  std::vector<Vector2d> points;
  for (const int vertex : chain.vertices)
    points.emplace_back(mesh.vertices_mm[static_cast<std::size_t>(vertex)].head<2>());
  return points;
}

struct Fitted {
  std::vector<geometry::FittedPiece> pieces;
  bool loosely = false;
};

/// Tight, or as loose as the chain's facets bulge where that halves the number of curves.
Fitted fitted(const std::vector<Vector2d>& points, const Chain& chain) {
  auto tight = geometry::fitted_pieces(points, chain.closed, {kCornerMm, kMostSagittaMm});
  if (chain.bulge_mm <= 0 || tight.size() < 2) return {std::move(tight)};
  const double loose_mm = std::min(kCornerMm + 2 * chain.bulge_mm, model::kEps_mm);
  auto loose = geometry::fitted_pieces(points, chain.closed, {loose_mm, kMostSagittaMm});
  if (2 * loose.size() > tight.size()) return {std::move(tight)};
  return {std::move(loose), true};
}

/// The vertices that a piece passes, in order.
std::vector<int> vertices_under(const geometry::FittedPiece& piece, const Chain& chain) {
  const std::size_t points = chain.vertices.size();
  const std::size_t last = piece.last > piece.first ? piece.last : piece.last + points;
  std::vector<int> vertices;
  for (std::size_t i = piece.first; i <= last; ++i) vertices.push_back(chain.vertices[i % points]);
  return vertices;
}

Rim rim_of(const geometry::Arc& arc, const std::vector<int>& vertices) {
  Rim rim{arc, {}};
  for (std::size_t i = 1; i < vertices.size(); ++i) rim.edges.emplace_back(vertices[i - 1], vertices[i]);
  return rim;
}

void add_contours(const TriangleMesh& mesh, const Chain& chain, MeshContours& result) {
  const auto [pieces, loosely] = fitted(in_plan(mesh, chain), chain);
  for (const geometry::FittedPiece& piece : pieces) {
    const auto vertices = vertices_under(piece, chain);
    const auto* arc = std::get_if<geometry::Arc>(&piece.curve);
    if (arc == nullptr && geometry::length_mm(piece.curve) < kJaggedRatio * chain.bulge_mm) {
      result.counts.jagged += static_cast<int>(vertices.size()) - 1;
      continue;
    }
    Contour contour{.number = static_cast<int>(result.contours.size()) + 1,
                    .curve = piece.curve,
                    .error_mm = std::max(piece.error_mm, piece.sagitta_mm) + chain.bulge_mm,
                    .trace_mm = {}};
    for (const int vertex : vertices)
      contour.trace_mm.push_back(mesh.vertices_mm[static_cast<std::size_t>(vertex)]);
    result.contours.push_back(std::move(contour));
    if (arc != nullptr && !loosely) result.rims.push_back(rim_of(*arc, vertices));
  }
}

}  // namespace

MeshContours contours_of(const TriangleMesh& mesh) {
  const ContourEdges edges = contour_edges(mesh);
  MeshContours result{.contours = {}, .rims = {}, .counts = edges.counts};
  for (const auto* kind : {&edges.creases, &edges.smooth}) {
    for (const Chain& chain : chains_of(*kind, mesh.vertices_mm)) add_contours(mesh, chain, result);
  }
  return result;
}

}  // namespace pinjaw::part

#include "host/part/mesh_shells.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "host/geometry/region.hpp"
#include "host/part/mesh_edges.hpp"

namespace pinjaw::part {
namespace {

using geometry::Box;

/// Facets that meet across edges of exactly two facets, and whether they pass that edge the same way.
struct Neighbour {
  int facet = 0;
  bool agrees = true;
};
using Neighbours = std::vector<std::vector<Neighbour>>;

Neighbours neighbours_of(const geometry::TriangleMesh& mesh) {
  Neighbours neighbours(mesh.triangles.size());
  for_each_edge(facet_sides(mesh), [&](std::span<const FacetSide> sides) {
    if (sides.size() != 2) return;
    const bool agrees = sides[0].forward != sides[1].forward;
    neighbours[static_cast<std::size_t>(sides[0].facet)].push_back({sides[1].facet, agrees});
    neighbours[static_cast<std::size_t>(sides[1].facet)].push_back({sides[0].facet, agrees});
  });
  return neighbours;
}

struct Shell {
  std::vector<int> facets;
  Box box;
  double volume_mm3 = 0;
  int outermost = -1;  ///< the shell about it that nothing is about; itself where it is that one
};

std::array<Vector3d, 3> corners_of(const geometry::TriangleMesh& mesh, int facet) {
  const auto& triangle = mesh.triangles[static_cast<std::size_t>(facet)];
  return {mesh.vertices_mm[static_cast<std::size_t>(triangle[0])],
          mesh.vertices_mm[static_cast<std::size_t>(triangle[1])],
          mesh.vertices_mm[static_cast<std::size_t>(triangle[2])]};
}

void turn(const Shell& shell, std::vector<bool>& turned) {
  for (const int facet : shell.facets) turned[static_cast<std::size_t>(facet)].flip();
}

/// Facets reached from `seed`, each turned to agree with the one it was reached from, as few as will do.
Shell shell_from(int seed, const Neighbours& neighbours, std::vector<int>& shell_of, int number,
                 std::vector<bool>& turned) {
  Shell shell{.facets = {seed}, .box = {}};
  shell_of[static_cast<std::size_t>(seed)] = number;
  for (std::size_t i = 0; i < shell.facets.size(); ++i) {
    const auto here = static_cast<std::size_t>(shell.facets[i]);
    for (const Neighbour& next : neighbours[here]) {
      const auto there = static_cast<std::size_t>(next.facet);
      if (shell_of[there] != 0) continue;
      shell_of[there] = number;
      turned[there] = turned[here] == next.agrees;
      shell.facets.push_back(next.facet);
    }
  }
  const auto is_turned = [&](int facet) { return turned[static_cast<std::size_t>(facet)]; };
  if (2 * std::ranges::count_if(shell.facets, is_turned) > std::ssize(shell.facets)) turn(shell, turned);
  return shell;
}

void measure(Shell& shell, const geometry::TriangleMesh& mesh, const std::vector<bool>& turned) {
  for (const int facet : shell.facets) {
    for (const Vector3d& p : corners_of(mesh, facet)) shell.box.include(p);
  }
  const Vector3d middle_mm = (shell.box.lo + shell.box.hi) / 2;
  for (const int facet : shell.facets) {
    const auto [a, b, c] = corners_of(mesh, facet);
    const double six = (a - middle_mm).dot((b - middle_mm).cross(c - middle_mm));
    shell.volume_mm3 += (turned[static_cast<std::size_t>(facet)] ? -six : six) / 6;
  }
}

/// Whether a ray from `p_mm` crosses the shell an odd number of times. Its direction is like no edge's.
bool contains(const Shell& shell, const geometry::TriangleMesh& mesh, const Vector3d& p_mm) {
  const Vector3d along = Vector3d(0.2718281, 0.3141592, 0.9097381).normalized();
  bool inside = false;
  for (const int facet : shell.facets) {
    const auto [a, b, c] = corners_of(mesh, facet);
    const Vector3d across = along.cross(c - a);
    const double scale = across.dot(b - a);
    if (scale == 0) continue;
    const double u = across.dot(p_mm - a) / scale;
    const Vector3d over = (p_mm - a).cross(b - a);
    const double v = over.dot(along) / scale;
    if (u >= 0 && v >= 0 && u + v <= 1 && over.dot(c - a) / scale > 0) inside = !inside;
  }
  return inside;
}

bool holds(const Box& outer, const Box& inner) {
  return (outer.lo.array() < inner.lo.array()).all() && (outer.hi.array() > inner.hi.array()).all();
}

/// Of the shells about each one, the largest is about all the others and has none about it.
void find_outermost(std::vector<Shell>& shells, const geometry::TriangleMesh& mesh) {
  const auto size = [](const Box& box) { return (box.hi - box.lo).prod(); };
  for (std::size_t i = 0; i < shells.size(); ++i) {
    shells[i].outermost = static_cast<int>(i);
    double largest_mm3 = 0;
    const Vector3d p_mm = corners_of(mesh, shells[i].facets.front())[0];
    for (std::size_t j = 0; j < shells.size(); ++j) {
      if (i == j || size(shells[j].box) <= largest_mm3 || !holds(shells[j].box, shells[i].box)) continue;
      if (!contains(shells[j], mesh, p_mm)) continue;
      largest_mm3 = size(shells[j].box);
      shells[i].outermost = static_cast<int>(j);
    }
  }
}

}  // namespace

base::Expected<Shells> turn_outwards(geometry::TriangleMesh& mesh) {
  const Neighbours neighbours = neighbours_of(mesh);
  std::vector<int> shell_of(mesh.triangles.size(), 0);
  std::vector<bool> turned(mesh.triangles.size(), false);
  std::vector<Shell> shells;
  for (std::size_t facet = 0; facet < shell_of.size(); ++facet) {
    if (shell_of[facet] != 0) continue;
    if (shells.size() == kMostShells) {
      return base::failure("its facets fall into more than " + std::to_string(kMostShells) +
                           " separate shells");
    }
    const int number = static_cast<int>(shells.size()) + 1;
    shells.push_back(shell_from(static_cast<int>(facet), neighbours, shell_of, number, turned));
    measure(shells.back(), mesh, turned);
  }
  find_outermost(shells, mesh);
  for (const Shell& shell : shells) {
    if (shells[static_cast<std::size_t>(shell.outermost)].volume_mm3 < 0) turn(shell, turned);
  }
  for (std::size_t facet = 0; facet < turned.size(); ++facet) {
    if (turned[facet]) std::swap(mesh.triangles[facet][1], mesh.triangles[facet][2]);
  }
  mesh.face_of = std::move(shell_of);
  return Shells{static_cast<int>(shells.size()), static_cast<int>(std::ranges::count(turned, true))};
}

Vector3d middle_of(const geometry::TriangleMesh& mesh) {
  Box box;
  for (const Vector3d& p : mesh.vertices_mm) box.include(p);
  return (box.lo + box.hi) / 2;
}

}  // namespace pinjaw::part

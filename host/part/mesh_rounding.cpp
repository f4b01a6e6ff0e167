#include "host/part/mesh_rounding.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <span>

#include "host/geometry/chain_fit.hpp"
#include "host/part/mesh_contours.hpp"
#include "host/part/mesh_edges.hpp"

namespace pinjaw::part {
namespace {

using geometry::Arc;
using geometry::TriangleMesh;

using Corners = std::array<int, 3>;

/// Edges that are chords, by their lesser and greater vertex, and the rim whose arc they follow.
using Chords = std::map<std::pair<int, int>, std::size_t>;

std::pair<int, int> key(int a, int b) {
  return std::minmax(a, b);
}

class Rounding {
 public:
  Rounding(const TriangleMesh& mesh, const std::vector<Rim>& rims, double sagitta_mm)
      : mesh_(mesh), rims_(rims), sagitta_mm_(sagitta_mm), wall_of_(mesh.triangles.size()) {
    for (std::size_t rim = 0; rim < rims.size(); ++rim) {
      for (const auto& [a, b] : rims[rim].edges) chords_.try_emplace(key(a, b), rim);
    }
    result_.vertices_mm = mesh.vertices_mm;
    find_walls();
  }

  TriangleMesh take() {
    for (std::size_t facet = 0; facet < mesh_.triangles.size(); ++facet) {
      face_ = mesh_.face_of[facet];
      if (wall_of_[facet]) {
        add_wall(mesh_.triangles[facet], rims_[*wall_of_[facet]].arc);
      } else {
        add_beside(mesh_.triangles[facet]);
      }
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] const Vector3d& at(int vertex) const {
    return result_.vertices_mm[static_cast<std::size_t>(vertex)];
  }

  [[nodiscard]] bool on_arc(int vertex, const Arc& arc) const {
    const double distance_mm = (at(vertex).head<2>() - arc.center_mm).norm();
    return std::abs(distance_mm - arc.radius_mm) <= 2 * kCornerMm;
  }

  /// The turn about the arc's centre from one vertex to the other, in (-pi, pi].
  [[nodiscard]] double turn_rad(int from, int to, const Arc& arc) const {
    const Vector2d a = at(from).head<2>() - arc.center_mm;
    const Vector2d b = at(to).head<2>() - arc.center_mm;
    return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }

  /// Chords of unlike rims make a wall's facets lean; what lies flat in a rim has its corners on it as well.
  [[nodiscard]] bool stands(const Corners& corners) const {
    const Vector3d cross = (at(corners[1]) - at(corners[0])).cross(at(corners[2]) - at(corners[0]));
    return std::abs(cross.z()) < std::numbers::sqrt2 / 2 * cross.norm();
  }

  [[nodiscard]] bool is_wall(const Corners& corners, const Arc& arc) const {
    if (!stands(corners)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!on_arc(corners[i], arc)) return false;
      if (std::abs(turn_rad(corners[i], corners[(i + 1) % 3], arc)) > geometry::kMostStepRad) return false;
    }
    return true;
  }

  /// Facets of a rim's cylinder, from the rim on across their edges, which are chords too.
  void find_walls() {
    const auto sides = facet_sides(mesh_);
    std::map<std::pair<int, int>, std::vector<std::size_t>> facets_at;
    for (const FacetSide& side : sides) {
      if (stands(mesh_.triangles[static_cast<std::size_t>(side.facet)])) {
        facets_at[{side.low, side.high}].push_back(static_cast<std::size_t>(side.facet));
      }
    }
    std::vector<std::pair<std::pair<int, int>, std::size_t>> front(chords_.begin(), chords_.end());
    while (!front.empty()) {
      const auto [edge, rim] = front.back();
      front.pop_back();
      const auto found = facets_at.find(edge);
      if (found == facets_at.end()) continue;
      for (const std::size_t facet : found->second) {
        const Corners& corners = mesh_.triangles[facet];
        if (wall_of_[facet] || !is_wall(corners, rims_[rim].arc)) continue;
        wall_of_[facet] = rim;
        for (std::size_t i = 0; i < 3; ++i) {
          const auto next = key(corners[i], corners[(i + 1) % 3]);
          chords_.try_emplace(next, rim);
          front.emplace_back(next, rim);
        }
      }
    }
  }

  void add(const Corners& corners) {
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    result_.triangles.push_back(corners);
    result_.face_of.push_back(face_);
  }

  /// The point at `part` of the way from one vertex to the other along the arc; remembered by its edge, so
  /// that neighbours share it.
  int between(int from, int to, int number, int of, const Arc& arc) {
    if (number == 0) return from;
    if (number == of) return to;
    const bool forward = from < to;
    const std::array<int, 4> name{std::min(from, to), std::max(from, to), forward ? number : of - number, of};
    if (const auto known = made_.find(name); known != made_.end()) return known->second;
    const double part = static_cast<double>(number) / of;
    const Vector2d spoke = at(from).head<2>() - arc.center_mm;
    const double angle_rad = std::atan2(spoke.y(), spoke.x()) + part * turn_rad(from, to, arc);
    Vector3d p_mm = at(from) + part * (at(to) - at(from));
    p_mm.head<2>() = arc.center_mm + arc.radius_mm * geometry::direction(angle_rad);
    const int vertex = static_cast<int>(result_.vertices_mm.size());
    result_.vertices_mm.push_back(p_mm);
    made_.emplace(name, vertex);
    return vertex;
  }

  /// How many chords the edge becomes.
  [[nodiscard]] int pieces(int from, int to, const Arc& arc) const {
    const double step_rad = 2 * std::acos(std::max(0.0, 1 - sagitta_mm_ / arc.radius_mm));
    return std::max(1, static_cast<int>(std::ceil(std::abs(turn_rad(from, to, arc)) / step_rad - 1e-9)));
  }

  /// The facet base, tip, other, of which base and other stand one over the other, cut into upright strips.
  void add_strips(int base, int tip, int other, const Arc& arc) {
    const int count = pieces(base, tip, arc);
    for (int i = 0; i < count; ++i) {
      const int a = between(base, tip, i, count, arc);
      const int b = between(base, tip, i + 1, count, arc);
      const int c = between(other, tip, i + 1, count, arc);
      const int d = between(other, tip, i, count, arc);
      add({a, b, c});
      add({a, c, d});
    }
  }

  void add_wall(Corners corners, const Arc& arc) {
    const auto together = [&](int a, int b) {
      return std::abs(turn_rad(a, b, arc)) * arc.radius_mm <= kCornerMm;
    };
    for (int turn = 0; turn < 3; ++turn) {
      if (together(corners[2], corners[0])) return add_strips(corners[0], corners[1], corners[2], arc);
      std::ranges::rotate(corners, corners.begin() + 1);
    }
    // No side is upright: cut at the corner that stands between the others.
    while (turn_rad(corners[0], corners[1], arc) * turn_rad(corners[1], corners[2], arc) < 0) {
      std::ranges::rotate(corners, corners.begin() + 1);
    }
    const auto [first, middle, last] = corners;
    const double part = turn_rad(first, middle, arc) / turn_rad(first, last, arc);
    Vector3d p_mm = at(first) + part * (at(last) - at(first));
    p_mm.head<2>() = at(middle).head<2>();
    const int cut = static_cast<int>(result_.vertices_mm.size());
    result_.vertices_mm.push_back(p_mm);
    add_strips(cut, first, middle, arc);
    add_strips(middle, last, cut, arc);
  }

  /// A facet beside a rim: a fan from the corner across each chord of its own.
  void add_beside(const Corners& corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = corners[i];
      const int to = corners[(i + 1) % 3];
      const int across = corners[(i + 2) % 3];
      const auto chord = chords_.find(key(from, to));
      if (chord == chords_.end()) continue;
      const Arc& arc = rims_[chord->second].arc;
      const int count = pieces(from, to, arc);
      if (count == 1) continue;
      for (int k = 0; k < count; ++k) {
        add_beside({between(from, to, k, count, arc), between(from, to, k + 1, count, arc), across});
      }
      return;
    }
    add(corners);
  }

  const TriangleMesh& mesh_;
  const std::vector<Rim>& rims_;
  double sagitta_mm_;
  Chords chords_;
  std::vector<std::optional<std::size_t>> wall_of_;
  TriangleMesh result_;
  int face_ = 0;
  std::map<std::array<int, 4>, int> made_;
};

}  // namespace

TriangleMesh rounded(const TriangleMesh& mesh, const std::vector<Rim>& rims, double sagitta_mm) {
  if (rims.empty()) return mesh;
  return Rounding(mesh, rims, sagitta_mm).take();
}

}  // namespace pinjaw::part

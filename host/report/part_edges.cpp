#include "host/report/part_edges.hpp"

#include <cmath>

namespace pinjaw::report {
namespace {

using geometry::Vector3d;

constexpr double kNearMm = 0.02;    // the disc probed about a point: the planner's eps (DESIGN 3.1 no. 1)
constexpr double kBeyondMm = 0.05;  // chosen: the mesh's error and slopes within the disc
constexpr double kStepMm = 1.0;     // chosen: where sight changes within a chord shows to 1 mm

std::vector<Vector3d> chorded(const part::Curve3& curve) {
  std::vector<Vector3d> points_mm;
  if (const auto* polyline = std::get_if<part::Polyline3>(&curve)) return polyline->points_mm;
  if (const auto* line = std::get_if<part::Line3>(&curve)) {
    const int pieces = 1 + static_cast<int>((line->b_mm - line->a_mm).norm() / kStepMm);
    for (int i = 0; i <= pieces; ++i)
      points_mm.push_back(line->a_mm + (line->b_mm - line->a_mm) * i / pieces);
    return points_mm;
  }
  const auto& arc = std::get<part::Ellipse3>(curve);
  const double length_mm = arc.sweep_rad * std::max(arc.u_mm.norm(), arc.v_mm.norm());
  const int pieces = 8 + static_cast<int>(length_mm / kStepMm);
  for (int i = 0; i <= pieces; ++i) {
    const double t = arc.from_rad + arc.sweep_rad * i / pieces;
    points_mm.push_back(arc.center_mm + std::cos(t) * arc.u_mm + std::sin(t) * arc.v_mm);
  }
  return points_mm;
}

struct Seen {
  bool from_above = false;
  bool from_below = false;
  friend bool operator==(const Seen&, const Seen&) = default;
};

Seen seen(const geometry::Surface& surface, const Vector3d& p_mm) {
  const geometry::Sweep disc{p_mm.head<2>(), p_mm.head<2>(), kNearMm};
  return {surface.highest_z_mm(disc) <= p_mm.z() + kBeyondMm,
          surface.lowest_z_mm(disc) >= p_mm.z() - kBeyondMm};
}

}  // namespace

std::vector<SheetEdge> sheet_edges(const part::Part& part) {
  std::vector<SheetEdge> edges;
  for (const part::EdgeCurve& edge : part.edges) {
    const std::vector<Vector3d> points_mm = chorded(edge.curve);
    Seen last;
    for (std::size_t i = 0; i + 1 < points_mm.size(); ++i) {
      const Seen now = seen(part.surface, (points_mm[i] + points_mm[i + 1]) / 2);
      if (i == 0 || !(now == last))
        edges.push_back({{points_mm[i].head<2>()}, now.from_above, now.from_below});
      edges.back().points_mm.emplace_back(points_mm[i + 1].head<2>());
      last = now;
    }
  }
  std::erase_if(edges, [](const SheetEdge& edge) { return !edge.from_above && !edge.from_below; });
  return edges;
}

}  // namespace pinjaw::report

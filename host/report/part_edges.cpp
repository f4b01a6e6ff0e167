#include "host/report/part_edges.hpp"

#include <algorithm>
#include <cmath>

#include "host/part/turning_lines.hpp"

namespace pinjaw::report {
namespace {

using geometry::Vector3d;

constexpr double kAsideMm = 0.02;     // how far beside a line is looked: the planner's eps (DESIGN 3.1 no. 1)
constexpr double kProbeMm = 0.004;    // radius of what is looked at there: the mesh's error
constexpr double kBeyondMm = 0.05;    // chosen: the mesh's error and slopes beside the line
constexpr double kStepMm = 0.2;       // chosen: where sight changes within a chord shows to 0.2 mm
constexpr double kSagittaMm = 0.003;  // of chords of arcs: far less than kAsideMm
constexpr double kSamePlaceMm = 1e-6;  // an upright stretch: a point in plan

std::vector<Vector3d> chorded(const part::Curve3& curve) {
  if (const auto* polyline = std::get_if<part::Polyline3>(&curve)) return polyline->points_mm;
  if (const auto* line = std::get_if<part::Line3>(&curve)) return {line->a_mm, line->b_mm};
  const auto& arc = std::get<part::Ellipse3>(curve);
  const double radius_mm = std::max(arc.u_mm.norm(), arc.v_mm.norm());
  const int pieces = 8 + static_cast<int>(arc.sweep_rad * std::sqrt(radius_mm / (8 * kSagittaMm)));
  std::vector<Vector3d> points_mm;
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

/// Looks on either side of a line that runs along `direction` in plan: a rounded side, whose surface rises
/// or falls steeply right beside its outline, hides the line on that side alone.
Seen seen(const geometry::Surface& surface, const Vector3d& p_mm, const Vector2d& direction) {
  Seen result;
  for (const double side : {-kAsideMm, kAsideMm}) {
    const Vector2d at_mm = p_mm.head<2>() + side * Vector2d(-direction.y(), direction.x());
    const geometry::Sweep disc{at_mm, at_mm, kProbeMm};
    result.from_above |= surface.highest_z_mm(disc) <= p_mm.z() + kBeyondMm;
    result.from_below |= surface.lowest_z_mm(disc) >= p_mm.z() - kBeyondMm;
  }
  return result;
}

/// Appends what is seen of the line through the points, cut where sight changes.
void add_line(const geometry::Surface& surface, const std::vector<Vector3d>& points_mm,
              std::vector<SheetEdge>& edges) {
  Seen last;
  for (std::size_t i = 0; i + 1 < points_mm.size(); ++i) {
    const Vector3d chord_mm = points_mm[i + 1] - points_mm[i];
    const double plan_mm = chord_mm.head<2>().norm();
    if (plan_mm < kSamePlaceMm) continue;
    const int pieces = 1 + static_cast<int>(plan_mm / kStepMm);
    for (int k = 0; k < pieces; ++k) {
      const Seen now =
          seen(surface, points_mm[i] + chord_mm * (k + 0.5) / pieces, chord_mm.head<2>() / plan_mm);
      const Vector2d from_mm = (points_mm[i] + chord_mm * k / pieces).head<2>();
      const Vector2d to_mm = (points_mm[i] + chord_mm * (k + 1) / pieces).head<2>();
      const bool goes_on = now == last;
      last = now;
      if (!now.from_above && !now.from_below) continue;
      if (!goes_on) edges.push_back({{from_mm}, now.from_above, now.from_below});
      std::vector<Vector2d>& drawn_mm = edges.back().points_mm;
      if (goes_on && k > 0)
        drawn_mm.back() = to_mm;
      else
        drawn_mm.push_back(to_mm);
    }
  }
}

}  // namespace

std::vector<SheetEdge> sheet_edges(const part::Part& part) {
  std::vector<SheetEdge> edges;
  for (const part::EdgeCurve& edge : part.edges) add_line(part.surface, chorded(edge.curve), edges);
  for (const part::Contour& contour : part.contours) add_line(part.surface, contour.trace_mm, edges);
  for (const auto& line : part::turning_lines(part.surface.mesh())) add_line(part.surface, line, edges);
  return edges;
}

}  // namespace pinjaw::report

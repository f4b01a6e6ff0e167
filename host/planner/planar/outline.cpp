#include "host/planner/planar/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pinjaw::planner::planar {
namespace {

using geometry::Arc;
using geometry::Interval;
using geometry::Segment;

constexpr double kLeastPiece = 1e-10;  // mm or rad, chosen: shorter pieces are rounding

double segment_distance_mm(const Segment& segment, const Vector2d& p_mm) {
  const Vector2d along = segment.b_mm - segment.a_mm;
  const double share = std::clamp(along.dot(p_mm - segment.a_mm) / along.squaredNorm(), 0.0, 1.0);
  return (p_mm - segment.a_mm - share * along).norm();
}

double arc_distance_mm(const Arc& arc, const Vector2d& p_mm) {
  const Vector2d radial = p_mm - arc.center_mm;
  const double at_rad = geometry::wrapped_rad(std::atan2(radial.y(), radial.x()) - arc.from_rad);
  if (at_rad <= arc.sweep_rad) return std::abs(radial.norm() - arc.radius_mm);
  const geometry::Curve curve = arc;
  return std::min((p_mm - geometry::point_at(curve, 0)).norm(),
                  (p_mm - geometry::point_at(curve, arc.radius_mm * arc.sweep_rad)).norm());
}

double edge_distance_mm(const geometry::Curve& edge, const Vector2d& p_mm) {
  if (const auto* segment = std::get_if<Segment>(&edge)) return segment_distance_mm(*segment, p_mm);
  return arc_distance_mm(std::get<Arc>(edge), p_mm);
}

/// Collects where a contact curve crosses lines and circles.
class Crossings {
 public:
  explicit Crossings(const ContactCurve& curve) : curve_(curve) {}

  void with_line(const Vector2d& p_mm, const Vector2d& direction) {
    const Vector2d across(-direction.y(), direction.x());
    if (!curve_.arc) {
      const double slope = across.dot(curve_.tangent);
      if (std::abs(slope) < 1e-14) return;
      add(across.dot(p_mm - curve_.offset_mm * curve_.normal) / slope);
      return;
    }
    const double distance_mm = across.dot(p_mm - curve_.center_mm);
    add_about(std::atan2(across.y(), across.x()), distance_mm / curve_.rho_mm);
  }

  void with_circle(const Vector2d& center_mm, double radius_mm) {
    if (radius_mm <= 0) return;
    if (!curve_.arc) {
      const double off_mm = curve_.normal.dot(center_mm) - curve_.offset_mm;
      const double square = radius_mm * radius_mm - off_mm * off_mm;
      if (square < 0) return;
      const double at_mm = curve_.tangent.dot(center_mm);
      add(at_mm - std::sqrt(square));
      add(at_mm + std::sqrt(square));
      return;
    }
    const Vector2d between = center_mm - curve_.center_mm;
    const double gap_mm = between.norm();
    if (gap_mm < 1e-12) return;
    const double cosine = (gap_mm * gap_mm + curve_.rho_mm * curve_.rho_mm - radius_mm * radius_mm) /
                          (2 * gap_mm * curve_.rho_mm);
    add_about(std::atan2(between.y(), between.x()), cosine);
  }

  /// Parameters inside the range, ascending, with the ends of the range.
  [[nodiscard]] std::vector<double> sorted() const {
    std::vector<double> all = at_;
    all.push_back(curve_.range.lo);
    all.push_back(curve_.range.hi);
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  void add_about(double middle_rad, double cosine) {
    if (std::abs(cosine) > 1) return;
    const double half_rad = std::acos(cosine);
    for (const double at_rad : {middle_rad - half_rad, middle_rad + half_rad}) {
      add(curve_.range.lo + geometry::wrapped_rad(at_rad - curve_.range.lo));
    }
  }
  void add(double at) {
    if (at > curve_.range.lo && at < curve_.range.hi) at_.push_back(at);
  }

  const ContactCurve& curve_;
  std::vector<double> at_;
};

void cross_edge(Crossings& crossings, const geometry::Curve& edge, double reach_mm) {
  crossings.with_circle(geometry::point_at(edge, 0), reach_mm);
  crossings.with_circle(geometry::point_at(edge, geometry::length_mm(edge)), reach_mm);
  if (const auto* segment = std::get_if<Segment>(&edge)) {
    const Vector2d along = (segment->b_mm - segment->a_mm).normalized();
    const Vector2d across(-along.y(), along.x());
    crossings.with_line(segment->a_mm + reach_mm * across, along);
    crossings.with_line(segment->a_mm - reach_mm * across, along);
    return;
  }
  const auto& arc = std::get<Arc>(edge);
  crossings.with_circle(arc.center_mm, arc.radius_mm + reach_mm);
  crossings.with_circle(arc.center_mm, arc.radius_mm - reach_mm);
}

}  // namespace

double outline_distance_mm(const model::Profile& outline, const Vector2d& p_mm) {
  double least_mm = std::numeric_limits<double>::infinity();
  for (const auto& loop : outline.loops) {
    for (const model::ProfileEdge& edge : loop) {
      least_mm = std::min(least_mm, edge_distance_mm(edge.curve, p_mm));
    }
  }
  return least_mm;
}

std::vector<Interval> free_pieces(const ContactCurve& curve, double pin_radius_mm,
                                  const model::Profile* outline) {
  if (outline == nullptr) return {curve.range};
  const double reach_mm = pin_radius_mm - kPenetrationTolerance_mm;
  Crossings crossings(curve);
  for (const auto& loop : outline->loops) {
    for (const model::ProfileEdge& edge : loop) cross_edge(crossings, edge.curve, reach_mm);
  }
  const std::vector<double> cuts = crossings.sorted();
  std::vector<Interval> pieces;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i + 1] - cuts[i] < kLeastPiece) continue;
    const Vector2d q_mm = centre_at(curve, (cuts[i] + cuts[i + 1]) / 2);
    if (outline_distance_mm(*outline, q_mm) < reach_mm - 1e-12) continue;
    if (!pieces.empty() && cuts[i] - pieces.back().hi < 2 * kLeastPiece) {
      pieces.back().hi = cuts[i + 1];
    } else {
      pieces.push_back({cuts[i], cuts[i + 1]});
    }
  }
  return pieces;
}

}  // namespace pinjaw::planner::planar

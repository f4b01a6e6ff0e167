#include "host/config/profile_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pinjaw::config {
namespace {

using geometry::Arc;
using geometry::cross;
using geometry::Curve;
using geometry::Segment;

Vector2d on_arc(const Arc& arc, double share) {
  return arc.center_mm + arc.radius_mm * geometry::direction(arc.from_rad + share * arc.sweep_rad);
}

Vector2d first_point(const Curve& curve) {
  if (const auto* segment = std::get_if<Segment>(&curve)) return segment->a_mm;
  return on_arc(std::get<Arc>(curve), 0);
}

Vector2d last_point(const Curve& curve) {
  if (const auto* segment = std::get_if<Segment>(&curve)) return segment->b_mm;
  return on_arc(std::get<Arc>(curve), 1);
}

Vector2d middle_point(const Curve& curve) {
  if (const auto* segment = std::get_if<Segment>(&curve)) return (segment->a_mm + segment->b_mm) / 2;
  return on_arc(std::get<Arc>(curve), 0.5);
}

bool lies_on(const Vector2d& p_mm, const Segment& segment) {
  const Vector2d along = segment.b_mm - segment.a_mm;
  const double share = std::clamp((p_mm - segment.a_mm).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (segment.a_mm + share * along - p_mm).norm() <= kSamePoint_mm;
}

bool lies_on(const Vector2d& p_mm, const Arc& arc) {
  const Vector2d out = p_mm - arc.center_mm;
  if (std::abs(out.norm() - arc.radius_mm) > kSamePoint_mm) return false;
  const double turned_rad = geometry::wrapped_rad(std::atan2(out.y(), out.x()) - arc.from_rad);
  if (turned_rad <= arc.sweep_rad) return true;
  return (on_arc(arc, 0) - p_mm).norm() <= kSamePoint_mm || (on_arc(arc, 1) - p_mm).norm() <= kSamePoint_mm;
}

bool lies_on(const Vector2d& p_mm, const Curve& curve) {
  return std::visit([&](const auto& each) { return lies_on(p_mm, each); }, curve);
}

using Points = std::vector<Vector2d>;

/// Where the lines or circles of two curves meet, whether or not the curves reach there.
Points carriers_meet(const Segment& a, const Segment& b) {
  const Vector2d along_a = a.b_mm - a.a_mm;
  const Vector2d along_b = b.b_mm - b.a_mm;
  const double turn = cross(along_a, along_b);
  constexpr double kParallel =
      1e-12;  // relative: below it the point is noise; touching ends are tried anyway
  if (std::abs(turn) <= kParallel * along_a.norm() * along_b.norm()) return {};
  return {a.a_mm + cross(b.a_mm - a.a_mm, along_b) / turn * along_a};
}

Points carriers_meet(const Segment& line, const Arc& circle) {
  const Vector2d along = (line.b_mm - line.a_mm).normalized();
  const Vector2d foot = line.a_mm + (circle.center_mm - line.a_mm).dot(along) * along;
  const double away_mm = (foot - circle.center_mm).norm();
  if (away_mm > circle.radius_mm + kSamePoint_mm) return {};
  const double half_mm = std::sqrt(std::max(0.0, circle.radius_mm * circle.radius_mm - away_mm * away_mm));
  return {foot - half_mm * along, foot + half_mm * along};
}

Points carriers_meet(const Arc& circle, const Segment& line) {
  return carriers_meet(line, circle);
}

Points carriers_meet(const Arc& a, const Arc& b) {
  const Vector2d between = b.center_mm - a.center_mm;
  const double distance_mm = between.norm();
  if (distance_mm <= kSamePoint_mm || distance_mm > a.radius_mm + b.radius_mm + kSamePoint_mm) return {};
  const double along_mm =
      (distance_mm * distance_mm + a.radius_mm * a.radius_mm - b.radius_mm * b.radius_mm) / (2 * distance_mm);
  const double half_mm = std::sqrt(std::max(0.0, a.radius_mm * a.radius_mm - along_mm * along_mm));
  const Vector2d forward = between / distance_mm;
  const Vector2d side(-forward.y(), forward.x());
  const Vector2d foot = a.center_mm + along_mm * forward;
  return {foot - half_mm * side, foot + half_mm * side};
}

/// A box around a segment, or around an arc's whole circle.
Eigen::AlignedBox2d box_of(const Curve& curve) {
  if (const auto* arc = std::get_if<Arc>(&curve)) {
    const Vector2d half(arc->radius_mm + kSamePoint_mm, arc->radius_mm + kSamePoint_mm);
    return {arc->center_mm - half, arc->center_mm + half};
  }
  const Segment& segment = std::get<Segment>(curve);
  const Vector2d margin(kSamePoint_mm, kSamePoint_mm);
  return {segment.a_mm.cwiseMin(segment.b_mm) - margin, segment.a_mm.cwiseMax(segment.b_mm) + margin};
}

/// Area that a curve adds by Green's theorem, run counter-clockwise or from a to b.
double swept_area_mm2(const Segment& segment) {
  return cross(segment.a_mm, segment.b_mm) / 2;
}

double swept_area_mm2(const Arc& arc) {
  const Vector2d ends = geometry::direction(arc.from_rad + arc.sweep_rad) - geometry::direction(arc.from_rad);
  return arc.radius_mm * (arc.radius_mm * arc.sweep_rad + cross(arc.center_mm, ends)) / 2;
}

/// Angle under which the point sees the directed curve.
double seen_rad(const Vector2d& p_mm, const model::ProfileEdge& edge) {
  const auto* arc = std::get_if<Arc>(&edge.curve);
  constexpr double kPieceRad = std::numbers::pi / 180;  // chosen: chords within 4e-5 of the radius
  const int pieces = arc == nullptr ? 1 : static_cast<int>(std::ceil(arc->sweep_rad / kPieceRad));
  double angle_rad = 0;
  Vector2d from = first_point(edge.curve) - p_mm;
  for (int i = 1; i <= pieces; ++i) {
    const Vector2d to = (arc == nullptr ? last_point(edge.curve) : on_arc(*arc, double(i) / pieces)) - p_mm;
    angle_rad += std::atan2(cross(from, to), from.dot(to));
    from = to;
  }
  return edge.reversed ? -angle_rad : angle_rad;
}

}  // namespace

Vector2d start_of(const model::ProfileEdge& edge) {
  return edge.reversed ? last_point(edge.curve) : first_point(edge.curve);
}

Vector2d end_of(const model::ProfileEdge& edge) {
  return edge.reversed ? first_point(edge.curve) : last_point(edge.curve);
}

double signed_area_mm2(const std::vector<model::ProfileEdge>& loop) {
  double area_mm2 = 0;
  for (const model::ProfileEdge& edge : loop) {
    const double swept_mm2 = std::visit([](const auto& curve) { return swept_area_mm2(curve); }, edge.curve);
    area_mm2 += edge.reversed ? -swept_mm2 : swept_mm2;
  }
  return area_mm2;
}

bool is_inside(const Vector2d& p_mm, const std::vector<model::ProfileEdge>& loop) {
  double angle_rad = 0;
  for (const model::ProfileEdge& edge : loop) angle_rad += seen_rad(p_mm, edge);
  return std::abs(angle_rad) > std::numbers::pi;
}

std::vector<Vector2d> meetings(const model::ProfileEdge& a, const model::ProfileEdge& b,
                               const std::vector<Vector2d>& shared) {
  if (!box_of(a.curve).intersects(box_of(b.curve))) return {};
  Points points = std::visit([](const auto& one, const auto& other) { return carriers_meet(one, other); },
                             a.curve, b.curve);
  // Ends that touch, and middles of curves that run along each other.
  for (const Curve* curve : {&a.curve, &b.curve}) {
    points.push_back(first_point(*curve));
    points.push_back(last_point(*curve));
    points.push_back(middle_point(*curve));
  }
  const auto does_not_count = [&](const Vector2d& p_mm) {
    const auto is_near = [&](const Vector2d& end_mm) { return (end_mm - p_mm).norm() <= 4 * kSamePoint_mm; };
    return std::any_of(shared.begin(), shared.end(), is_near) || !lies_on(p_mm, a.curve) ||
           !lies_on(p_mm, b.curve);
  };
  std::erase_if(points, does_not_count);
  return points;
}

}  // namespace pinjaw::config

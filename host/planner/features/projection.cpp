#include "host/planner/features/projection.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;

constexpr double kPointMm = 1e-3;     // an edge shorter than this in plan is a point
constexpr double kStraightMm = 1e-4;  // an ellipse narrower than this in plan is a straight line
constexpr double kRoundMm = 1e-3;     // an ellipse whose half axes differ by less is a circle

struct Left {
  int FeatureCounts::*reason;
  std::vector<Vector2d> chords;
};
using InPlan = std::variant<geometry::Curve, Left>;

Vector2d at(const part::Ellipse3& arc, double t_rad) {
  return (arc.center_mm + std::cos(t_rad) * arc.u_mm + std::sin(t_rad) * arc.v_mm).head<2>();
}

std::vector<Vector2d> chords_of(const part::Ellipse3& arc) {
  constexpr double kStepRad = 0.05;
  const int steps = std::max(4, static_cast<int>(std::ceil(arc.sweep_rad / kStepRad)));
  std::vector<Vector2d> points;
  for (int i = 0; i <= steps; ++i) points.push_back(at(arc, arc.from_rad + i * arc.sweep_rad / steps));
  return points;
}

/// An ellipse seen edge-on along `axis`: the straight piece between the extremes of its sweep.
geometry::Segment edge_on(const part::Ellipse3& arc, const Vector2d& axis) {
  std::vector<Vector2d> points{at(arc, arc.from_rad), at(arc, arc.from_rad + arc.sweep_rad)};
  const double turning_rad = std::atan2(axis.dot(arc.v_mm.head<2>()), axis.dot(arc.u_mm.head<2>()));
  for (const double t_rad : {turning_rad, turning_rad + std::numbers::pi}) {
    const double along_rad = geometry::wrapped_rad(t_rad - arc.from_rad);
    if (along_rad < arc.sweep_rad) points.push_back(at(arc, arc.from_rad + along_rad));
  }
  const auto [lo, hi] = std::ranges::minmax(points, {}, [&](const Vector2d& p) { return axis.dot(p); });
  return {lo, hi};
}

geometry::Arc seen_round(const part::Ellipse3& arc, double radius_mm) {
  const bool counter_clockwise = arc.u_mm.x() * arc.v_mm.y() - arc.u_mm.y() * arc.v_mm.x() > 0;
  const double start_rad = counter_clockwise ? arc.from_rad : arc.from_rad + arc.sweep_rad;
  const Vector2d spoke = at(arc, start_rad) - arc.center_mm.head<2>();
  return {arc.center_mm.head<2>(), radius_mm, geometry::wrapped_rad(std::atan2(spoke.y(), spoke.x())),
          std::min(arc.sweep_rad, 2 * std::numbers::pi)};
}

struct ToPlan {
  InPlan operator()(const part::Line3& line) const {
    const geometry::Segment segment{line.a_mm.head<2>(), line.b_mm.head<2>()};
    if ((segment.b_mm - segment.a_mm).norm() < kPointMm) return Left{&FeatureCounts::left_out_upright, {}};
    return segment;
  }
  InPlan operator()(const part::Ellipse3& arc) const {
    Eigen::Matrix2d axes;
    axes << arc.u_mm.head<2>(), arc.v_mm.head<2>();
    const Eigen::JacobiSVD<Eigen::Matrix2d> svd(axes, Eigen::ComputeFullU);
    const double major_mm = svd.singularValues()[0];
    const double minor_mm = svd.singularValues()[1];
    if (minor_mm < kStraightMm) {
      const geometry::Segment segment = edge_on(arc, svd.matrixU().col(0));
      if ((segment.b_mm - segment.a_mm).norm() < kPointMm) return Left{&FeatureCounts::left_out_upright, {}};
      return segment;
    }
    if (major_mm - minor_mm > kRoundMm) return Left{&FeatureCounts::left_out_tilted, chords_of(arc)};
    return seen_round(arc, (major_mm + minor_mm) / 2);
  }
  InPlan operator()(const part::Polyline3& line) const {
    Left left{&FeatureCounts::left_out_freeform, {}};
    for (const auto& p : line.points_mm) left.chords.emplace_back(p.head<2>());
    return left;
  }
};

}  // namespace

Projection projected(const part::Part& part, FeatureCounts& counts) {
  Projection result;
  for (const part::EdgeCurve& edge : part.edges) {
    InPlan plan = std::visit(ToPlan{}, edge.curve);
    if (auto* left = std::get_if<Left>(&plan)) {
      ++(counts.*(left->reason));
      if (left->chords.size() > 1) result.others.push_back(std::move(left->chords));
    } else {
      result.curves.push_back({std::get<geometry::Curve>(plan), edge.edge, false, edge.approximate});
    }
  }
  for (const part::Wall& wall : part.walls) {
    if (geometry::length_mm(wall.curve) >= kPointMm)
      result.curves.push_back({wall.curve, wall.face, true, false});
  }
  for (const part::Contour& contour : part.contours) {
    result.curves.push_back({contour.curve, contour.number, false, true});
  }
  counts.left_out_upright += part.contour_counts.upright;
  counts.left_out_gentle = part.contour_counts.gentle;
  counts.left_out_jagged = part.contour_counts.jagged;
  counts.candidates = static_cast<int>(result.curves.size());
  return result;
}

}  // namespace pinjaw::planner

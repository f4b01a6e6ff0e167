#include "host/planner/features/projection.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/geometry/chain_fit.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;
using geometry::Vector3d;

constexpr double kPointMm = 1e-3;     // an edge shorter than this in plan is a point
constexpr double kStraightMm = 1e-4;  // an ellipse narrower than this in plan is a straight line
constexpr double kRoundMm = 1e-3;     // an ellipse whose half axes differ by less is a circle
constexpr double kChordMm = 1e-3;     // sagitta of chords that stand for exact curves
constexpr double kSagittaMm = 0.01;   // of chords that may stand for an arc; sources are chorded finer
constexpr double kCoveredMm = 3e-3;   // a chain this near to a lower curve runs above it

Vector3d at(const part::Ellipse3& arc, double t_rad) {
  return arc.center_mm + std::cos(t_rad) * arc.u_mm + std::sin(t_rad) * arc.v_mm;
}

std::vector<Vector3d> chords_of(const part::Ellipse3& arc) {
  const double longest_mm = std::max(arc.u_mm.norm(), arc.v_mm.norm());
  const double step_rad = std::min(0.2, std::sqrt(8 * kChordMm / longest_mm));
  const int steps = std::max(4, static_cast<int>(std::ceil(arc.sweep_rad / step_rad)));
  std::vector<Vector3d> points;
  for (int i = 0; i <= steps; ++i) points.push_back(at(arc, arc.from_rad + i * arc.sweep_rad / steps));
  return points;
}

/// An ellipse seen edge-on along `axis`: the straight piece between the extremes of its sweep.
geometry::Segment edge_on(const part::Ellipse3& arc, const Vector2d& axis) {
  std::vector<Vector2d> points{at(arc, arc.from_rad).head<2>(),
                               at(arc, arc.from_rad + arc.sweep_rad).head<2>()};
  const double turning_rad = std::atan2(axis.dot(arc.v_mm.head<2>()), axis.dot(arc.u_mm.head<2>()));
  for (const double t_rad : {turning_rad, turning_rad + std::numbers::pi}) {
    const double along_rad = geometry::wrapped_rad(t_rad - arc.from_rad);
    if (along_rad < arc.sweep_rad) points.emplace_back(at(arc, arc.from_rad + along_rad).head<2>());
  }
  const auto [lo, hi] = std::ranges::minmax(points, {}, [&](const Vector2d& p) { return axis.dot(p); });
  return {lo, hi};
}

geometry::Arc seen_round(const part::Ellipse3& arc, double radius_mm) {
  const bool counter_clockwise = arc.u_mm.x() * arc.v_mm.y() - arc.u_mm.y() * arc.v_mm.x() > 0;
  const double start_rad = counter_clockwise ? arc.from_rad : arc.from_rad + arc.sweep_rad;
  const Vector2d spoke = (at(arc, start_rad) - arc.center_mm).head<2>();
  return {arc.center_mm.head<2>(), radius_mm, geometry::wrapped_rad(std::atan2(spoke.y(), spoke.x())),
          std::min(arc.sweep_rad, 2 * std::numbers::pi)};
}

/// A curve that is a line or circle in plan, or the points of one that is neither.
struct InPlan {
  std::optional<geometry::Curve> curve;
  double error_mm = 0;
  std::vector<Vector3d> trace_mm;
};

struct ToPlan {
  InPlan operator()(const part::Line3& line) const {
    return {geometry::Segment{line.a_mm.head<2>(), line.b_mm.head<2>()}, 0, {line.a_mm, line.b_mm}};
  }
  InPlan operator()(const part::Ellipse3& arc) const {
    Eigen::Matrix2d axes;
    axes << arc.u_mm.head<2>(), arc.v_mm.head<2>();
    const Eigen::JacobiSVD<Eigen::Matrix2d> svd(axes, Eigen::ComputeFullU);
    const double major_mm = svd.singularValues()[0];
    const double minor_mm = svd.singularValues()[1];
    if (minor_mm < kStraightMm) return {edge_on(arc, svd.matrixU().col(0)), minor_mm, chords_of(arc)};
    if (major_mm - minor_mm > kRoundMm) return {std::nullopt, 0, chords_of(arc)};
    return {seen_round(arc, (major_mm + minor_mm) / 2), (major_mm - minor_mm) / 2, chords_of(arc)};
  }
  InPlan operator()(const part::Polyline3& line) const { return {std::nullopt, 0, line.points_mm}; }
};

/// A chain of points in space and its box in plan.
struct Chain {
  std::vector<Vector3d> points_mm;
  std::size_t source = 0;
  Vector2d lo_mm = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector2d hi_mm = Vector2d::Constant(-std::numeric_limits<double>::infinity());

  Chain(std::vector<Vector3d> points, std::size_t of) : points_mm(std::move(points)), source(of) {
    for (const Vector3d& p : points_mm) {
      lo_mm = lo_mm.cwiseMin(p.head<2>());
      hi_mm = hi_mm.cwiseMax(p.head<2>());
    }
  }
  [[nodiscard]] double lowest_mm() const {
    return std::ranges::min(points_mm, {}, [](const Vector3d& p) { return p.z(); }).z();
  }
  [[nodiscard]] bool passes(const Vector2d& p_mm) const {
    if ((p_mm.array() < lo_mm.array() - kCoveredMm).any() ||
        (p_mm.array() > hi_mm.array() + kCoveredMm).any())
      return false;
    for (std::size_t i = 1; i < points_mm.size(); ++i) {
      const Vector2d a_mm = points_mm[i - 1].head<2>();
      const Vector2d ab_mm = points_mm[i].head<2>() - a_mm;
      const double squared = ab_mm.squaredNorm();
      const double t = squared > 0 ? std::clamp(ab_mm.dot(p_mm - a_mm) / squared, 0.0, 1.0) : 0.0;
      if ((a_mm + t * ab_mm - p_mm).squaredNorm() <= kCoveredMm * kCoveredMm) return true;
    }
    return false;
  }
};

double plan_length_mm(std::span<const Vector3d> points_mm) {
  double length_mm = 0;
  for (std::size_t i = 1; i < points_mm.size(); ++i)
    length_mm += (points_mm[i] - points_mm[i - 1]).head<2>().norm();
  return length_mm;
}

/// Whether each link between neighbouring points of the chain runs above or below one of the `others`;
/// shorter than eps in a row they only cross it.
std::vector<bool> covered_links(const Chain& chain, const std::vector<Chain>& others) {
  const auto& points = chain.points_mm;
  std::vector<bool> covered(points.size() - 1);
  for (const Chain& other : others) {
    if ((other.hi_mm.array() < chain.lo_mm.array()).any() ||
        (other.lo_mm.array() > chain.hi_mm.array()).any())
      continue;
    std::vector<bool> near(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) near[i] = other.passes(points[i].head<2>());
    for (std::size_t from = 0; from + 1 < points.size(); ++from) {
      std::size_t to = from;
      while (to + 1 < points.size() && near[to] && near[to + 1]) ++to;
      if (plan_length_mm(std::span(points).subspan(from, to - from + 1)) < model::kEps_mm) continue;
      std::fill(covered.begin() + static_cast<std::ptrdiff_t>(from),
                covered.begin() + static_cast<std::ptrdiff_t>(to), true);
      from = to;
    }
  }
  return covered;
}

/// Collects the candidates; curves that have to be fitted wait until all others are known.
class Projecting {
 public:
  std::size_t add_source(Source::Kind kind, int number) {
    result_.sources.push_back({kind, number, {}});
    return result_.sources.size() - 1;
  }
  void add(std::size_t source, InPlan plan, double error_mm) {
    if (plan.curve ? geometry::length_mm(*plan.curve) < kPointMm : plan_length_mm(plan.trace_mm) < kPointMm) {
      result_.sources[source].met(Fate::Upright);
    } else if (plan.curve) {
      known_.emplace_back(plan.trace_mm, source);
      result_.curves.push_back({*plan.curve, source, plan.error_mm + error_mm, std::move(plan.trace_mm)});
    } else {
      waiting_.emplace_back(std::move(plan.trace_mm), source);
    }
  }
  void add_wall(std::size_t source, const part::Wall& wall) {
    if (geometry::length_mm(wall.curve) < kPointMm) return result_.sources[source].met(Fate::Upright);
    const Vector2d p_mm = geometry::point_at(wall.curve, 0);
    result_.curves.push_back({wall.curve, source, 0, {{p_mm.x(), p_mm.y(), wall.z_mm.lo}}});
  }
  Projection take() {
    std::ranges::stable_sort(waiting_, {}, &Chain::lowest_mm);
    for (Chain& chain : waiting_) {
      fit(chain);
      known_.push_back(std::move(chain));
    }
    return std::move(result_);
  }

 private:
  void fit(const Chain& chain) {
    const std::vector<bool> covered = covered_links(chain, known_);
    for (std::size_t from = 0; from < covered.size(); ++from) {
      std::size_t to = from;
      while (to < covered.size() && covered[to] == covered[from]) ++to;
      if (covered[from]) {
        result_.sources[chain.source].met(Fate::Coincident);
      } else {
        fit_run(std::span(chain.points_mm).subspan(from, to - from + 1), chain.source);
      }
      from = to - 1;
    }
  }
  void fit_run(std::span<const Vector3d> run, std::size_t source) {
    std::vector<Vector2d> plan;
    for (const Vector3d& p : run) plan.emplace_back(p.head<2>());
    const bool closed = plan.size() > 3 && (plan.back() - plan.front()).norm() < kPointMm;
    if (closed) plan.pop_back();
    for (const auto& piece : geometry::fitted_pieces(plan, closed, {kFitMm, kSagittaMm})) {
      if (geometry::length_mm(piece.curve) < kPointMm) continue;
      PlanCurve curve{piece.curve, source, piece.error_mm, {}};
      const std::size_t last = piece.last > piece.first ? piece.last : piece.last + plan.size();
      for (std::size_t i = piece.first; i <= last; ++i) curve.trace_mm.push_back(run[i % plan.size()]);
      result_.curves.push_back(std::move(curve));
    }
  }

  Projection result_;
  std::vector<Chain> known_;
  std::vector<Chain> waiting_;
};

}  // namespace

double z_near_mm(const PlanCurve& curve, const Vector2d& p_mm) {
  double nearest_mm = std::numeric_limits<double>::infinity();
  double z_mm = curve.trace_mm.front().z();
  for (std::size_t i = 1; i < curve.trace_mm.size(); ++i) {
    const Vector3d& a_mm = curve.trace_mm[i - 1];
    const Vector3d ab_mm = curve.trace_mm[i] - a_mm;
    const double squared = ab_mm.head<2>().squaredNorm();
    const double t =
        squared > 0 ? std::clamp(ab_mm.head<2>().dot(p_mm - a_mm.head<2>()) / squared, 0.0, 1.0) : 0.0;
    const Vector3d foot_mm = a_mm + t * ab_mm;
    const double away_mm = (foot_mm.head<2>() - p_mm).norm();
    const bool nearer = away_mm < nearest_mm - kPointMm;
    if (nearer || (away_mm < nearest_mm + kPointMm && foot_mm.z() < z_mm)) z_mm = foot_mm.z();
    nearest_mm = std::min(nearest_mm, away_mm);
  }
  return z_mm;
}

Projection projected(const part::Part& part) {
  Projecting projecting;
  for (const part::EdgeCurve& edge : part.edges) {
    projecting.add(projecting.add_source(Source::Kind::Edge, edge.edge), std::visit(ToPlan{}, edge.curve),
                   edge.error_mm);
  }
  for (const part::Wall& wall : part.walls) {
    projecting.add_wall(projecting.add_source(Source::Kind::Wall, wall.face), wall);
  }
  for (const geometry::Silhouette& line : part.surface.mesh().silhouettes) {
    projecting.add(projecting.add_source(Source::Kind::Silhouette, line.face),
                   {std::nullopt, 0, line.points_mm}, 0);
  }
  for (const part::Contour& contour : part.contours) {
    projecting.add(projecting.add_source(Source::Kind::Contour, contour.number),
                   {contour.curve, 0, contour.trace_mm}, contour.error_mm);
  }
  return projecting.take();
}

}  // namespace pinjaw::planner

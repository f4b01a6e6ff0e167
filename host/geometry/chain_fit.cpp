#include "host/geometry/chain_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

namespace pinjaw::geometry {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kSamePointMm = 1e-9;
constexpr std::size_t kLeastArcPoints = 4;  // three points lie on a circle always
constexpr double kMostRadiusMm = 1e5;       // chosen: flatter than any arc that a pin could tell from a line
constexpr std::size_t kMostBreaks = 9;      // places tried for one break; clean chains leave one or two

/// A curve fitted to a run and the sum of its squared distances.
struct Fit {
  FittedPiece piece;
  double squares_mm2 = 0;
};

using Run = std::span<const Vector2d>;

std::optional<Fit> line_through(Run run, const FitLimits& limits) {
  const Vector2d middle_mm =
      std::accumulate(run.begin(), run.end(), Vector2d(Vector2d::Zero())) / static_cast<double>(run.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Vector2d& p : run) spread += (p - middle_mm) * (p - middle_mm).transpose();
  Vector2d along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(1);
  if (along.dot(run.back() - run.front()) < 0) along = -along;
  Fit fit;
  double before_mm = -std::numeric_limits<double>::infinity();
  for (const Vector2d& p : run) {
    const double aside_mm = std::abs(cross(along, p - middle_mm));
    const double here_mm = along.dot(p - middle_mm);
    if (aside_mm > limits.tolerance_mm || here_mm < before_mm - limits.tolerance_mm) return std::nullopt;
    before_mm = std::max(before_mm, here_mm);
    fit.piece.error_mm = std::max(fit.piece.error_mm, aside_mm);
    fit.squares_mm2 += aside_mm * aside_mm;
  }
  const auto on_line = [&](const Vector2d& p) -> Vector2d {
    return middle_mm + along.dot(p - middle_mm) * along;
  };
  fit.piece.curve = Segment{on_line(run.front()), on_line(run.back())};
  return fit;
}

struct Circle {
  Vector2d center_mm;
  double radius_mm;
};

/// The circle of least algebraic distance (Kasa), then one of least distance by three Gauss-Newton steps.
std::optional<Circle> circle_through(Run run) {
  const Vector2d origin_mm = run.front();
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const Vector2d& p : run) {
    const Vector3d row(p.x() - origin_mm.x(), p.y() - origin_mm.y(), 1);
    normal += row * row.transpose();
    right += row * (p - origin_mm).squaredNorm();
  }
  const Vector3d kasa = normal.ldlt().solve(right);
  Circle circle{origin_mm + kasa.head<2>() / 2, std::sqrt(kasa.z() + kasa.head<2>().squaredNorm() / 4)};
  for (int step = 0; step < 3; ++step) {
    normal.setZero();
    right.setZero();
    for (const Vector2d& p : run) {
      const Vector2d spoke = p - circle.center_mm;
      const double distance_mm = spoke.norm();
      const Vector3d row(-spoke.x() / distance_mm, -spoke.y() / distance_mm, -1);
      normal += row * row.transpose();
      right -= row * (distance_mm - circle.radius_mm);
    }
    const Vector3d change = normal.ldlt().solve(right);
    circle.center_mm += change.head<2>();
    circle.radius_mm += change.z();
  }
  if (!circle.center_mm.allFinite() || !(circle.radius_mm > 0) || circle.radius_mm > kMostRadiusMm)
    return std::nullopt;
  return circle;
}

/// The arc over the whole run; `closed`: its last point is joined to its first, which is one full turn.
std::optional<Fit> arc_through(Run run, bool closed, const FitLimits& limits) {
  if (run.size() < kLeastArcPoints) return std::nullopt;
  const auto circle = circle_through(run);
  if (!circle) return std::nullopt;
  Fit fit;
  for (const Vector2d& p : run) {
    const double aside_mm = std::abs((p - circle->center_mm).norm() - circle->radius_mm);
    if (aside_mm > limits.tolerance_mm) return std::nullopt;
    fit.piece.error_mm = std::max(fit.piece.error_mm, aside_mm);
    fit.squares_mm2 += aside_mm * aside_mm;
  }
  const double slack_rad = limits.tolerance_mm / circle->radius_mm;
  double swept_rad = 0;
  double widest_rad = 0;
  double most_rad = 0;
  double least_rad = 0;
  for (std::size_t i = 0; i + (closed ? 0 : 1) < run.size(); ++i) {
    const Vector2d from = run[i] - circle->center_mm;
    const Vector2d to = run[(i + 1) % run.size()] - circle->center_mm;
    const double step_rad = std::atan2(cross(from, to), from.dot(to));
    swept_rad += step_rad;
    widest_rad = std::max(widest_rad, std::abs(step_rad));
    if (swept_rad < most_rad - slack_rad && swept_rad > least_rad + slack_rad) return std::nullopt;
    most_rad = std::max(most_rad, swept_rad);
    least_rad = std::min(least_rad, swept_rad);
  }
  fit.piece.sagitta_mm = circle->radius_mm * (1 - std::cos(widest_rad / 2)) + fit.piece.error_mm;
  if (widest_rad > kMostStepRad || fit.piece.sagitta_mm > limits.most_sagitta_mm) return std::nullopt;
  const double sweep_rad = closed ? kTurn : std::abs(swept_rad);
  if (closed && std::abs(std::abs(swept_rad) - kTurn) > slack_rad) return std::nullopt;
  if (sweep_rad > kTurn || !(sweep_rad > slack_rad)) return std::nullopt;
  fit.piece.clockwise = swept_rad < 0;
  const Vector2d start = (fit.piece.clockwise && !closed ? run.back() : run.front()) - circle->center_mm;
  fit.piece.curve =
      Arc{circle->center_mm, circle->radius_mm, wrapped_rad(std::atan2(start.y(), start.x())), sweep_rad};
  return fit;
}

std::optional<Fit> fit_of(Run run, const FitLimits& limits) {
  if (auto line = line_through(run, limits)) return line;
  return arc_through(run, false, limits);
}

/// The largest `count` in [known, most] for which `fits(count)`; it fits up to there and not beyond.
/// Doubling, then halving: long runs cost their length times its logarithm.
template <class Fits>
std::size_t last_that_fits(std::size_t known, std::size_t most, const Fits& fits) {
  std::size_t step = 1;
  std::size_t fails = most + 1;
  while (known < most && fails > most) {
    const std::size_t tried = std::min(known + step, most);
    if (fits(tried)) {
      known = tried;
      step *= 2;
    } else {
      fails = tried;
    }
  }
  while (fails <= most && fails - known > 1) {
    const std::size_t tried = known + (fails - known) / 2;
    (fits(tried) ? known : fails) = tried;
  }
  return known;
}

/// How many points from the start of `rest` one curve covers.
std::size_t reach_of(Run rest, const FitLimits& limits) {
  const std::size_t line = last_that_fits(
      2, rest.size(), [&](std::size_t count) { return line_through(rest.first(count), limits).has_value(); });
  const std::size_t least = std::max(kLeastArcPoints, line + 1);  // what a line still fits has no radius
  const auto is_arc = [&](std::size_t count) {
    return arc_through(rest.first(count), false, limits).has_value();
  };
  if (least > rest.size() || !is_arc(least)) return line;
  return last_that_fits(least, rest.size(), is_arc);
}

/// Indices where the curves end when each takes all it can, from 0 to the last point.
std::vector<std::size_t> greedy_breaks(Run chain, const FitLimits& limits) {
  std::vector<std::size_t> breaks{0};
  while (breaks.back() + 1 < chain.size()) {
    breaks.push_back(breaks.back() + reach_of(chain.subspan(breaks.back()), limits) - 1);
  }
  return breaks;
}

/// Places for one break: the earliest to the latest, thinned evenly where they are many.
std::vector<std::size_t> places_between(std::size_t early, std::size_t late) {
  const std::size_t span = late - early;
  const std::size_t count = std::min(span + 1, kMostBreaks);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < count; ++i)
    places.push_back(count == 1 ? early : early + i * span / (count - 1));
  return places;
}

/// The best way over the places of every break: least sum of squared distances.
///
/// Whoever takes all it can from the left breaks as late as is possible with the fewest curves, from the
/// right as early, so every break of a best way lies between the two.
std::vector<Fit> best_way(Run chain, const std::vector<std::size_t>& early,
                          const std::vector<std::size_t>& late, const FitLimits& limits) {
  struct Step {
    std::size_t place = 0;
    double cost_mm2 = 0;
    std::size_t before = 0;  ///< which step of the previous break
    Fit fit;
  };
  std::vector<std::vector<Step>> steps{{Step{}}};
  for (std::size_t k = 1; k < late.size(); ++k) {
    std::vector<Step> here;
    for (const std::size_t place : places_between(early[k], late[k])) {
      std::optional<Step> best;
      for (std::size_t b = 0; b < steps.back().size(); ++b) {
        const Step& before = steps.back()[b];
        if (before.place >= place) continue;
        const auto fit = fit_of(chain.subspan(before.place, place - before.place + 1), limits);
        if (!fit) continue;
        const double cost_mm2 = before.cost_mm2 + fit->squares_mm2;
        if (best && best->cost_mm2 <= cost_mm2) continue;
        best = Step{place, cost_mm2, b, *fit};
        best->fit.piece.first = before.place;
        best->fit.piece.last = place;
      }
      if (best) here.push_back(*best);
    }
    if (here.empty()) return {};
    steps.push_back(std::move(here));
  }
  std::vector<Fit> way;
  std::size_t at = 0;
  for (std::size_t k = steps.size() - 1; k > 0; --k) {
    way.push_back(steps[k][at].fit);
    at = steps[k][at].before;
  }
  std::ranges::reverse(way);
  return way;
}

std::vector<Fit> open_way(const std::vector<Vector2d>& chain, const FitLimits& limits) {
  const auto late = greedy_breaks(chain, limits);
  const std::vector<Vector2d> backwards(chain.rbegin(), chain.rend());
  auto early = greedy_breaks(backwards, limits);
  std::ranges::reverse(early);
  for (std::size_t& place : early) place = chain.size() - 1 - place;
  if (early.size() < late.size()) {
    // A run may fit backwards and, by rounding, not forwards; then the longer way stands.
    if (auto way = best_way(chain, early, early, limits); !way.empty()) return way;
  }
  const bool nested = early.size() == late.size() && std::ranges::equal(early, late, std::less_equal<>());
  return best_way(chain, nested ? early : late, late, limits);
}

std::vector<Vector2d> rotated(const std::vector<Vector2d>& ring, std::size_t start) {
  std::vector<Vector2d> chain(ring.begin() + static_cast<std::ptrdiff_t>(start), ring.end());
  chain.insert(chain.end(), ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(start) + 1);
  return chain;
}

/// A closed chain as an open one from a break of a way with few curves: taking all one can, lap after lap,
/// falls into step with the true breaks; then once more from a break that was placed best.
std::vector<Fit> closed_way(const std::vector<Vector2d>& ring, const FitLimits& limits) {
  constexpr int kLaps = 2;
  std::size_t start = 0;
  for (int lap = 0; lap < kLaps; ++lap) {
    const auto breaks = greedy_breaks(rotated(ring, start), limits);
    start = (start + breaks[breaks.size() - 2]) % ring.size();
  }
  std::vector<Fit> way = open_way(rotated(ring, start), limits);
  if (way.size() > 1) {
    const std::size_t best = (start + way[way.size() / 2].piece.first) % ring.size();
    std::vector<Fit> again = open_way(rotated(ring, best), limits);
    if (again.size() <= way.size()) {
      way = std::move(again);
      start = best;
    }
  }
  for (Fit& fit : way) {
    fit.piece.first = (fit.piece.first + start) % ring.size();
    fit.piece.last = (fit.piece.last + start) % ring.size();
  }
  std::ranges::sort(way, {}, [](const Fit& fit) { return fit.piece.first; });
  return way;
}

}  // namespace

std::vector<FittedPiece> fitted_pieces(std::span<const Vector2d> chain_mm, bool closed,
                                       const FitLimits& limits) {
  std::vector<Vector2d> points;
  std::vector<std::size_t> index_of;
  for (std::size_t i = 0; i < chain_mm.size(); ++i) {
    if (!points.empty() && (chain_mm[i] - points.back()).norm() <= kSamePointMm) continue;
    points.push_back(chain_mm[i]);
    index_of.push_back(i);
  }
  if (closed && points.size() > 1 && (points.back() - points.front()).norm() <= kSamePointMm)
    points.pop_back();
  if (points.size() < 2) return {};
  std::vector<Fit> way;
  if (!closed) {
    way = open_way(points, limits);
  } else if (auto circle = arc_through(points, true, limits)) {
    way = {std::move(*circle)};
  } else {
    way = closed_way(points, limits);
  }
  std::vector<FittedPiece> pieces;
  for (Fit& fit : way) {
    fit.piece.first = index_of[fit.piece.first];
    fit.piece.last = index_of[fit.piece.last];
    pieces.push_back(std::move(fit.piece));
  }
  return pieces;
}

}  // namespace pinjaw::geometry

#include "host/planner/planar/piece.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/planner/planar/constants.hpp"

namespace pinjaw::planner::planar {
namespace {

constexpr double kLongest_rad = 0.1;    // chosen: a cubic follows y over this much for parts of some 100 mm
constexpr double kShortest_rad = 1e-7;  // chosen: shorter pieces of a fold are taken as upright

struct Offset {
  HolePair holes;
  Vector2d apart_mm;
  double length_mm;
};

/// All ways to set two pins into one plate, shortest first.
std::vector<Offset> hole_offsets(const model::Kit& kit) {
  std::vector<Offset> offsets;
  for (int rows = 0; rows < kit.grid.rows; ++rows) {
    for (int columns = rows == 0 ? 1 : 1 - kit.grid.columns; columns < kit.grid.columns; ++columns) {
      const Vector2d apart_mm = kit.grid.spacing_mm * Vector2d(-columns, rows);
      if (apart_mm.norm() < 2 * kit.pins.radius_mm - kOverlap_mm) continue;
      offsets.push_back({{columns, rows}, apart_mm, apart_mm.norm()});
    }
  }
  const auto shorter = [](const Offset& x, const Offset& y) { return x.length_mm < y.length_mm; };
  std::stable_sort(offsets.begin(), offsets.end(), shorter);
  return offsets;
}

/// Bounds of the distance between a point of one curve and a point of the other; generous for arcs.
geometry::Interval distances_mm(const ContactCurve& a, const ContactCurve& b) {
  const Vector2d middle_a = a.arc ? a.center_mm : Vector2d((a.ends_mm[0] + a.ends_mm[1]) / 2);
  const Vector2d middle_b = b.arc ? b.center_mm : Vector2d((b.ends_mm[0] + b.ends_mm[1]) / 2);
  const double reach_mm = (a.arc ? a.rho_mm : (a.ends_mm[1] - a.ends_mm[0]).norm() / 2) +
                          (b.arc ? b.rho_mm : (b.ends_mm[1] - b.ends_mm[0]).norm() / 2);
  const double gap_mm = (middle_a - middle_b).norm();
  return {gap_mm - reach_mm - kSearchWidening_mm, gap_mm + reach_mm + kSearchWidening_mm};
}

class PieceMaker {
 public:
  PieceMaker(const std::vector<ContactCurve>& curves, std::vector<Piece>& out) : curves_(curves), out_(out) {}

  void make(int a, int b, const Offset& offset) {
    const Pair pair{&curves_[static_cast<std::size_t>(a)], &curves_[static_cast<std::size_t>(b)],
                    offset.apart_mm};
    Piece piece;
    piece.a = a;
    piece.b = b;
    piece.holes = offset.holes;
    set_cone(pair, piece);
    for (const Standstill& still : standstills(pair)) {
      piece.upright = true;
      piece.theta_rad = {still.theta_rad, still.theta_rad};
      piece.y_mm = still.y_mm;
      out_.push_back(piece);
    }
    for (const Stretch& stretch : stretches(pair)) {
      const int parts = static_cast<int>(std::ceil(stretch.theta_rad.length() / kLongest_rad));
      const double step_rad = stretch.theta_rad.length() / parts;
      for (int i = 0; i < parts; ++i) {
        const double lo = stretch.theta_rad.lo + i * step_rad;
        const double hi = i + 1 == parts ? stretch.theta_rad.hi : lo + step_rad;
        split(pair, stretch.branch, {lo, hi}, piece);
      }
    }
  }

 private:
  static void set_cone(const Pair& pair, Piece& piece) {
    if (pair.a->arc || pair.b->arc) {
      piece.cone_half_rad = std::numbers::pi;
      return;
    }
    const double between_rad = std::remainder(pair.b->normal_rad - pair.a->normal_rad, 2 * std::numbers::pi);
    piece.cone_rad = geometry::wrapped_rad(pair.a->normal_rad + between_rad / 2);
    piece.cone_half_rad = std::abs(between_rad) / 2;
  }

  void split(const Pair& pair, int branch, const geometry::Interval& theta_rad, Piece piece) {
    const auto lo = state_at(pair, theta_rad.lo, branch);
    const auto hi = state_at(pair, theta_rad.hi, branch);
    piece.theta_rad = theta_rad;
    if (theta_rad.length() <= kShortest_rad) {
      upright(pair, branch, piece);
      return;
    }
    piece.upright = false;
    if (lo && hi && fits(pair, branch, *lo, *hi, piece)) {
      out_.push_back(piece);
      return;
    }
    const double middle = (theta_rad.lo + theta_rad.hi) / 2;
    split(pair, branch, {theta_rad.lo, middle}, piece);
    split(pair, branch, {middle, theta_rad.hi}, piece);
  }

  /// Keeps the piece with the y of its ends and middle; an end that rounding has put beyond a fold adds
  /// nothing.
  void upright(const Pair& pair, int branch, Piece& piece) {
    piece.upright = true;
    bool any = false;
    for (const double at :
         {piece.theta_rad.lo, (piece.theta_rad.lo + piece.theta_rad.hi) / 2, piece.theta_rad.hi}) {
      const auto state = state_at(pair, at, branch);
      if (!state) continue;
      const double y = state->o_mm.y();
      piece.y_mm = any ? geometry::Interval{std::min(piece.y_mm.lo, y), std::max(piece.y_mm.hi, y)}
                       : geometry::Interval{y, y};
      any = true;
    }
    if (any) out_.push_back(piece);
  }

  /// Hermite's cubic through both ends, checked against the true curve inside.
  static bool fits(const Pair& pair, int branch, const PairState& lo, const PairState& hi, Piece& piece) {
    if (!std::isfinite(lo.y_slope) || !std::isfinite(hi.y_slope)) return false;
    const double width = piece.theta_rad.length();
    const double rise = (hi.o_mm.y() - lo.o_mm.y()) / width;
    piece.c[0] = lo.o_mm.y();
    piece.c[1] = lo.y_slope;
    piece.c[2] = (3 * rise - 2 * lo.y_slope - hi.y_slope) / width;
    piece.c[3] = (lo.y_slope + hi.y_slope - 2 * rise) / (width * width);
    for (const double share : {0.25, 0.5, 0.75}) {
      const double theta_rad = piece.theta_rad.lo + share * width;
      const auto state = state_at(pair, theta_rad, branch);
      if (!state || !(std::abs(level_at(piece, theta_rad).y_mm - state->o_mm.y()) < kPieceError_mm))
        return false;
    }
    return true;
  }

  const std::vector<ContactCurve>& curves_;
  std::vector<Piece>& out_;
};

}  // namespace

std::vector<Piece> pair_pieces(const std::vector<ContactCurve>& curves, const model::Kit& kit) {
  const std::vector<Offset> offsets = hole_offsets(kit);
  std::vector<std::vector<Piece>> by_first(curves.size());
  tbb::parallel_for(std::size_t{0}, curves.size(), [&](std::size_t a) {
    PieceMaker maker(curves, by_first[a]);
    for (std::size_t b = 0; b < curves.size(); ++b) {
      const geometry::Interval bounds = distances_mm(curves[a], curves[b]);
      const auto longer = [](const Offset& x, double length_mm) { return x.length_mm < length_mm; };
      for (auto it = std::lower_bound(offsets.begin(), offsets.end(), bounds.lo, longer);
           it != offsets.end() && it->length_mm <= bounds.hi; ++it) {
        maker.make(static_cast<int>(a), static_cast<int>(b), *it);
      }
    }
  });
  std::vector<Piece> pieces;
  for (const auto& some : by_first) pieces.insert(pieces.end(), some.begin(), some.end());
  return pieces;
}

}  // namespace pinjaw::planner::planar

#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "host/planner/planar/piece.hpp"

namespace pinjaw::planner::planar {

/// Rows by which the second pair's pin A may stand above the first pair's: a closed range of whole numbers.
struct RowRange {
  int lo = 0;
  int hi = 0;
};

/// How far beyond an end of a theta interval another one may start and still be taken to meet it.
inline constexpr double kThetaGap_rad = 2e-7;  // chosen: above the rounding of interval ends
/// How near two curves must come to be tried as crossing; the tries are polished and checked.
inline constexpr double kNear_mm = 1e-4;  // chosen: five times the pieces' own error

/// Zeros of y_p(theta) - y_q(theta) - row * spacing, all rows at once: on one overlap of two pieces the
/// difference is a cubic, so each of its monotone parts meets each row's level at most once (level sets of
/// one function; DESIGN 6).
///
/// Calls try_at(theta_rad, y_mm of p's part origin, row) at least once near every crossing of the true
/// curves, also where they nearly touch (once on either side) and where they meet at an end.
template <typename TryAt>
class PieceCrossing {
 public:
  PieceCrossing(double spacing_mm, const TryAt& try_at) : spacing_mm_(spacing_mm), try_at_(try_at) {}

  void operator()(const Piece& p, const Piece& q, const RowRange& rows) const {
    double lo = std::max(p.theta_rad.lo, q.theta_rad.lo);
    double hi = std::min(p.theta_rad.hi, q.theta_rad.hi);
    if (lo > hi) {
      if (lo > hi + kThetaGap_rad) return;
      lo = hi = (lo + hi) / 2;
    }
    if (p.upright || q.upright) {
      if (!(p.upright && q.upright)) meet_upright(p, q, (lo + hi) / 2, rows);
      return;
    }
    const Level p0 = level_at(p, lo);
    const Level q0 = level_at(q, lo);
    const Level p1 = level_at(p, hi);
    const Level q1 = level_at(q, hi);
    const double width = hi - lo;
    const double third = width / 3;
    const std::array<double, 4> bezier{p0.y_mm - q0.y_mm, p0.y_mm - q0.y_mm + third * (p0.slope - q0.slope),
                                       p1.y_mm - q1.y_mm - third * (p1.slope - q1.slope), p1.y_mm - q1.y_mm};
    const auto [least, most] = std::minmax({bezier[0], bezier[1], bezier[2], bezier[3]});
    const int from = std::max(rows.lo, static_cast<int>(std::ceil((least - kNear_mm) / spacing_mm_)));
    const int to = std::min(rows.hi, static_cast<int>(std::floor((most + kNear_mm) / spacing_mm_)));
    for (int row = from; row <= to; ++row) meet_level(p, lo, width, bezier, row);
  }

 private:
  void meet_upright(const Piece& p, const Piece& q, double theta_rad, const RowRange& rows) const {
    const Piece& smooth = p.upright ? q : p;
    const geometry::Interval& range = p.upright ? p.y_mm : q.y_mm;
    const double y_mm = level_at(smooth, theta_rad).y_mm;
    // p upright: range holds y_q + row d; q upright: range holds y_p - row d
    const double sign = p.upright ? 1.0 : -1.0;
    const double a = sign * (range.lo - y_mm) / spacing_mm_;
    const double b = sign * (range.hi - y_mm) / spacing_mm_;
    const double near = kNear_mm / spacing_mm_;
    const int from = std::max(rows.lo, static_cast<int>(std::ceil(std::min(a, b) - near)));
    const int to = std::min(rows.hi, static_cast<int>(std::floor(std::max(a, b) + near)));
    for (int row = from; row <= to; ++row) {
      try_at_(theta_rad, p.upright ? y_mm + row * spacing_mm_ : y_mm, row);
    }
  }

  /// The cubic over u in [0, 1], Bezier's form, against one row's level.
  void meet_level(const Piece& p, double lo, double width, const std::array<double, 4>& bezier,
                  int row) const {
    const double level = row * spacing_mm_;
    const double k0 = bezier[0] - level;
    const double k1 = 3 * (bezier[1] - bezier[0]);
    const double k2 = 3 * (bezier[2] - 2 * bezier[1] + bezier[0]);
    const double k3 = bezier[3] - 3 * bezier[2] + 3 * bezier[1] - bezier[0];
    const auto value = [&](double u) { return k0 + u * (k1 + u * (k2 + u * k3)); };
    const auto slope = [&](double u) { return k1 + u * (2 * k2 + u * 3 * k3); };
    const auto try_u = [&](double u) {
      const double theta_rad = lo + std::clamp(u, 0.0, 1.0) * width;
      try_at_(theta_rad, level_at(p, theta_rad).y_mm, row);
    };
    std::array<double, 4> ends{0, 1, 1, 1};
    std::size_t count = 1;
    for (const double u : stationary(k1, k2, k3)) {
      if (u > ends[count - 1] && u < 1) ends[count++] = u;
    }
    ends[count] = 1;
    for (std::size_t i = 0; i <= count; ++i) {
      const double u = ends[i];
      const double at = value(u);
      if (std::abs(at) < kNear_mm) {
        const bool turns = i > 0 && i < count;
        const double bend = std::abs(2 * k2 + 6 * k3 * u);
        const double aside = turns && bend > 0 ? std::sqrt(4 * kNear_mm / bend) : 0.0;
        try_u(u - aside);
        if (turns) try_u(u + aside);
      }
      if (i == count) break;
      const double next = value(ends[i + 1]);
      if ((at < 0) != (next < 0)) try_u(root_between(value, slope, u, ends[i + 1], at));
    }
  }

  static std::array<double, 2> stationary(double k1, double k2, double k3) {
    constexpr double kNone = 2;  // outside [0, 1]
    const double square = k2 * k2 - 3 * k3 * k1;
    if (square <= 0) return {kNone, kNone};
    const double big = -(k2 + std::copysign(std::sqrt(square), k2));
    const double one = k3 == 0 ? kNone : big / (3 * k3);
    const double two = big == 0 ? kNone : k1 / big;
    return {std::min(one, two), std::max(one, two)};
  }

  /// Newton kept inside the bracket; 40 halvings would already be enough for the seeds' purpose.
  template <typename Value, typename Slope>
  static double root_between(const Value& value, const Slope& slope, double lo, double hi, double at_lo) {
    double u = (lo + hi) / 2;
    for (int step = 0; step < 40 && hi - lo > 1e-9; ++step) {
      const double at = value(u);
      if (std::abs(at) < 1e-7) break;
      ((at < 0) == (at_lo < 0) ? lo : hi) = u;
      const double next = u - at / slope(u);
      u = next > lo && next < hi ? next : (lo + hi) / 2;
    }
    return u;
  }

  double spacing_mm_;
  const TryAt& try_at_;
};

}  // namespace pinjaw::planner::planar

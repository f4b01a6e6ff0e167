#include "tests/host/planner/planar/slow/search.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tests/host/planner/planar/slow/ladder.hpp"
#include "tests/host/planner/planar/slow/turn.hpp"

namespace pinjaw::planner::slow {
namespace {

using geometry::Interval;
using model::JawSide;

constexpr double kNear_mm = 0.06;    // chosen: above the chords' error
constexpr double kNear_rad = 2e-3;   // chosen: above the same error of theta
constexpr double kStill_rad = 1e-4;  // slides that turn less are searched over y
constexpr std::size_t kBins = 256;

JawSide other(JawSide jaw) {
  return jaw == JawSide::Left ? JawSide::Right : JawSide::Left;
}
std::size_t index(JawSide jaw) {
  return jaw == JawSide::Left ? 0 : 1;
}
Rung between(const Slide& slide, double share) {
  return {slide.from.theta_rad + share * (slide.to.theta_rad - slide.from.theta_rad),
          slide.from.o_mm + share * (slide.to.o_mm - slide.from.o_mm)};
}
bool still(const Slide& slide) {
  return std::abs(slide.to.theta_rad - slide.from.theta_rad) < kStill_rad;
}
Rung at_theta(const Slide& slide, double theta_rad) {
  if (still(slide)) return between(slide, 0.5);
  const double share = (theta_rad - slide.from.theta_rad) / (slide.to.theta_rad - slide.from.theta_rad);
  return between(slide, std::clamp(share, 0.0, 1.0));
}
Interval thetas(const Slide& slide) {
  return {std::min(slide.from.theta_rad, slide.to.theta_rad) - kNear_rad,
          std::max(slide.from.theta_rad, slide.to.theta_rad) + kNear_rad};
}

class Search {
 public:
  explicit Search(const Task& task) : task_(task) {}

  std::vector<Found> run() {
    const std::vector<Slide> lefts = slides(task_, JawSide::Left);
    const std::vector<Slide> rights = slides(task_, JawSide::Right);
    meet(lefts, rights);
    for (const Slide& slide : lefts) third_pins(slide, JawSide::Left);
    for (const Slide& slide : rights) third_pins(slide, JawSide::Right);
    return listed_once();
  }

 private:
  // ---- two and two

  void meet(const std::vector<Slide>& lefts, const std::vector<Slide>& rights) {
    struct Bin {
      std::vector<std::pair<const Slide*, bool>> lefts, rights;  ///< and whether it is the first of its bins
    };
    std::vector<Bin> bins(kBins);
    const auto fill = [&](const std::vector<Slide>& all, auto member) {
      for (const Slide& slide : all) {
        const Interval range = thetas(slide);
        const auto bin = [](double theta_rad) {
          return static_cast<int>(std::floor(theta_rad / kTurn * static_cast<double>(kBins)));
        };
        for (int i = bin(range.lo); i <= bin(range.hi); ++i) {
          const int wrapped =
              (i % static_cast<int>(kBins) + static_cast<int>(kBins)) % static_cast<int>(kBins);
          (bins[static_cast<std::size_t>(wrapped)].*member).push_back({&slide, i == bin(range.lo)});
        }
      }
    };
    fill(lefts, &Bin::lefts);
    fill(rights, &Bin::rights);
    for (const Bin& bin : bins) {
      for (const auto& [left, left_first] : bin.lefts) {
        for (const auto& [right, right_first] : bin.rights) {
          if (left_first || right_first) meet(*left, *right);
        }
      }
    }
  }

  void meet(const Slide& left, Slide right) {
    const double around_rad = kTurn * std::round((left.from.theta_rad - right.from.theta_rad) / kTurn);
    right.from.theta_rad += around_rad;
    right.to.theta_rad += around_rad;
    const Interval both{std::max(thetas(left).lo, thetas(right).lo),
                        std::min(thetas(left).hi, thetas(right).hi)};
    if (both.lo > both.hi || (still(left) && still(right))) return;
    const double d_mm = task_.kit.grid.spacing_mm;
    if (still(left) || still(right)) {
      const Slide& upright = still(left) ? left : right;
      const double sign = still(left) ? 1 : -1;  // rows by which the left slide is higher
      const double theta_rad = between(upright, 0.5).theta_rad;
      const double y_mm = at_theta(still(left) ? right : left, theta_rad).o_mm.y();
      const double from = sign * (upright.from.o_mm.y() - y_mm) / d_mm;
      const double to = sign * (upright.to.o_mm.y() - y_mm) / d_mm;
      each_row(left, right, from, to, [&](int row) {
        const double share = to == from ? 0.5 : std::clamp((row - from) / (to - from), 0.0, 1.0);
        const Rung rung = between(upright, share);
        if (still(left)) {
          seat(left, right, row, rung, at_theta(right, theta_rad));
        } else {
          seat(left, right, row, at_theta(left, theta_rad), rung);
        }
      });
      return;
    }
    const auto apart = [&](double theta_rad) {
      return (at_theta(left, theta_rad).o_mm.y() - at_theta(right, theta_rad).o_mm.y()) / d_mm;
    };
    const double at_lo = apart(both.lo);
    const double at_hi = apart(both.hi);
    const auto seat_at = [&](int row, double theta_rad) {
      seat(left, right, row, at_theta(left, theta_rad), at_theta(right, theta_rad));
    };
    each_row(left, right, at_lo, at_hi, [&](int row) {
      if ((at_lo < row) != (at_hi < row)) {
        seat_at(row, both.lo + (row - at_lo) / (at_hi - at_lo) * both.length());
      } else {
        seat_at(row, both.lo);
        seat_at(row, both.hi);
      }
    });
  }

  /// Every whole number of rows between `from` and `to` or near for which the plates have room.
  template <typename Take>
  void each_row(const Slide& left, const Slide& right, double from, double to, const Take& take) const {
    const double near = kNear_mm / task_.kit.grid.spacing_mm;
    const int most = task_.kit.grid.rows - 1;
    const int lo = static_cast<int>(std::ceil(std::min(from, to) - near));
    const int hi = static_cast<int>(std::floor(std::max(from, to) + near));
    for (int row = std::max(lo, left.holes.rows - most); row <= std::min(hi, most); ++row) {
      const int low = std::min(0, row);
      const int high = std::max(left.holes.rows, row + right.holes.rows);
      if (high - low <= most) take(row);
    }
  }

  void seat(const Slide& left, const Slide& right, int row, const Rung& l, const Rung& r) {
    Stand stand;
    stand.pins = {{{JawSide::Left, 0, 0}, left.a},
                  {{JawSide::Left, left.holes.columns, left.holes.rows}, left.b},
                  {{JawSide::Right, 0, row}, right.a},
                  {{JawSide::Right, right.holes.columns, row + right.holes.rows}, right.b}};
    stand.theta_rad = l.theta_rad;
    stand.y_mm = l.o_mm.y();
    stand.x_mm[0] = l.o_mm.x();
    stand.x_mm[1] = r.o_mm.x();
    if (surely_open(task_, stand) || !settle(task_, stand)) return;
    judge(stand);
  }

  // ---- three and one

  /// Every third pin above the ladder's second in the order of pairs, where it meets a feature on the way.
  void third_pins(const Slide& slide, JawSide jaw) {
    const Turn from(slide.from.theta_rad);
    const Turn to(slide.to.theta_rad);
    const model::Grid& grid = task_.kit.grid;
    for (int rows = slide.holes.rows; rows < grid.rows; ++rows) {
      for (int columns = 1 - grid.columns; columns < grid.columns; ++columns) {
        const auto [least, most] = std::minmax({0, slide.holes.columns, columns});
        const bool after = std::tuple(rows, columns) > std::tuple(slide.holes.rows, slide.holes.columns);
        if (after && most - least < grid.columns) {
          const Vector2d apart_mm =
              grid.spacing_mm * Vector2d(jaw == JawSide::Left ? -columns : columns, rows);
          third_pin(slide, jaw, {columns, rows}, from.back(apart_mm - slide.from.o_mm),
                    to.back(apart_mm - slide.to.o_mm));
        }
      }
    }
  }

  void third_pin(const Slide& slide, JawSide jaw, const HolePair& hole, const Vector2d& from_mm,
                 const Vector2d& to_mm) {
    for (int feature = 0; feature < static_cast<int>(task_.tracks.size()); ++feature) {
      const Track& track = task_.tracks[static_cast<std::size_t>(feature)];
      if (!track.exists()) continue;
      const double from = track.miss_mm(from_mm);
      const double to = track.miss_mm(to_mm);
      if ((from < 0) == (to < 0) && std::min(std::abs(from), std::abs(to)) > kNear_mm) continue;
      const double at_mm = track.nearest(from_mm);
      if (!track.closed() && (at_mm < -1 || at_mm > track.length_mm() + 1)) continue;
      if ((from < 0) != (to < 0)) {
        rest(slide, jaw, hole, feature, between(slide, from / (from - to)));
      } else {
        rest(slide, jaw, hole, feature, slide.from);
        rest(slide, jaw, hole, feature, slide.to);
      }
    }
  }

  /// The part on three pins of one jaw; then one pin of the other jaw on every feature in every row.
  void rest(const Slide& slide, JawSide jaw, const HolePair& hole, int feature, const Rung& rung) {
    Stand three;
    three.pins = {{{jaw, 0, 0}, slide.a},
                  {{jaw, slide.holes.columns, slide.holes.rows}, slide.b},
                  {{jaw, hole.columns, hole.rows}, feature}};
    three.theta_rad = rung.theta_rad;
    three.y_mm = rung.o_mm.y();
    three.x_mm[index(jaw)] = rung.o_mm.x();
    if (!settle(task_, three)) return;
    const Turn turn(three.theta_rad);
    const int most = task_.kit.grid.rows - 1;
    for (int row = hole.rows - most; row <= most; ++row) {
      const Vector2d level_mm(0, row * task_.kit.grid.spacing_mm - three.y_mm);
      for (int opposed = 0; opposed < static_cast<int>(task_.tracks.size()); ++opposed) {
        const Track& track = task_.tracks[static_cast<std::size_t>(opposed)];
        if (!track.exists()) continue;
        for (const auto& at_mm : track.places_on_line(turn.back(level_mm), turn.back(Vector2d::UnitX()))) {
          if (!at_mm || *at_mm < -1e-3 || *at_mm > track.length_mm() + 1e-3) continue;
          Stand stand = three;
          stand.pins.push_back({{other(jaw), 0, row}, opposed});
          stand.x_mm[index(other(jaw))] = -(turn * track.centre(*at_mm)).x();
          judge(stand);
        }
      }
    }
  }

  // ---- the list

  void judge(const Stand& stand) {
    const Verdict told = verdict(task_, stand);
    if (told.fixture || told.borderline) found_.push_back({canonical(task_, stand), told});
  }

  std::vector<Found> listed_once() {
    const auto key = [](const Found& found) { return std::tie(found.stand.pins, found.stand.theta_rad); };
    std::ranges::sort(found_, [&](const Found& p, const Found& q) { return key(p) < key(q); });
    std::vector<Found> once;
    for (const Found& found : found_) {
      bool listed = false;
      for (auto it = once.rbegin(); it != once.rend() && it->stand.pins == found.stand.pins && !listed;
           ++it) {
        listed = std::abs(std::remainder(it->stand.theta_rad - found.stand.theta_rad, kTurn)) < 1e-7 &&
                 std::abs(it->stand.y_mm - found.stand.y_mm) < 1e-6 &&
                 std::abs(span_mm(it->stand) - span_mm(found.stand)) < 1e-6;
      }
      if (!listed) once.push_back(found);
    }
    return once;
  }

  const Task& task_;
  std::vector<Found> found_;
};

}  // namespace

std::vector<Found> search(const Task& task) {
  return Search(task).run();
}

}  // namespace pinjaw::planner::slow

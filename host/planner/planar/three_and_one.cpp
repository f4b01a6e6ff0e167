#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <tuple>

#include "host/planner/planar/constants.hpp"
#include "host/planner/planar/crossing.hpp"
#include "host/planner/planar/sweep.hpp"
#include "host/planner/planar/theta_bins.hpp"

namespace pinjaw::planner::planar {
namespace {

constexpr std::size_t kTripleBins = 1024;

class TripleSearch {
 public:
  TripleSearch(const std::vector<ContactCurve>& curves, const Judge& judge, const model::Kit& kit)
      : curves_(curves), judge_(judge), kit_(kit) {}

  /// `later` starts in this slice; `other` may as well, then each pair of pieces comes here once.
  void meet(const Piece& one, const Piece& other) {
    const bool in_order = order(one) < order(other);
    if (!in_order && order(other) == order(one)) return;  // two pins in one hole
    const Piece& low = in_order ? one : other;
    const Piece& high = in_order ? other : one;
    if (!room(low.holes, high.holes)) return;
    const auto try_at = [&](double theta_rad, double y_mm, int) { seat(low, high, theta_rad, y_mm); };
    PieceCrossing(kit_.grid.spacing_mm, try_at)(low, high, {0, 0});
  }

  [[nodiscard]] std::vector<Candidate> take() { return std::move(found_); }

 private:
  static std::tuple<int, int> order(const Piece& piece) { return {piece.holes.rows, piece.holes.columns}; }

  [[nodiscard]] bool room(const HolePair& low, const HolePair& high) const {
    const auto [least, most] = std::minmax({0, low.columns, high.columns});
    if (most - least > kit_.grid.columns - 1) return false;
    const double apart_mm =
        kit_.grid.spacing_mm * std::hypot(high.columns - low.columns, high.rows - low.rows);
    return apart_mm >= 2 * kit_.pins.radius_mm - kOverlap_mm;
  }

  /// Three left pins near touching: seats the part on them, then tries every right contact.
  void seat(const Piece& low, const Piece& high, double theta_rad, double y_mm) {
    const int column = -std::min({0, low.holes.columns, high.holes.columns});
    Candidate candidate;
    candidate.pins[0] = {low.a, true, column, 0};
    candidate.pins[1] = {low.b, true, column + low.holes.columns, low.holes.rows};
    candidate.pins[2] = {high.b, true, column + high.holes.columns, high.holes.rows};
    const std::array<Touch, 3> touches{judge_.touch(candidate.pins[0]), judge_.touch(candidate.pins[1]),
                                       judge_.touch(candidate.pins[2])};
    Placement& placement = candidate.placement;
    placement.theta_rad = theta_rad;
    placement.y_mm = y_mm;
    placement.x_left_mm = x_where_it_touches(touches[0], theta_rad, y_mm);
    if (!polish(touches, placement)) return;
    for (const Touch& touch : touches) {
      if (contact_at(touch, placement).normal.x() >= 0) return;
    }
    for (std::size_t curve = 0; curve < curves_.size(); ++curve) oppose(candidate, static_cast<int>(curve));
  }

  /// Every row in which a right pin can touch `curve` while the part rests on the three left pins.
  void oppose(const Candidate& seated, int curve_index) {
    const ContactCurve& curve = curves_[static_cast<std::size_t>(curve_index)];
    const double theta_rad = seated.placement.theta_rad;
    const geometry::Interval reach_mm = heights(curve, theta_rad);
    const double y_mm = seated.placement.y_mm;
    const int most = kit_.grid.rows - 1;
    const int top = seated.pins[2].row;
    const int from =
        std::max(top - most, static_cast<int>(std::ceil((y_mm + reach_mm.lo) / kit_.grid.spacing_mm)));
    const int to = std::min(most, static_cast<int>(std::floor((y_mm + reach_mm.hi) / kit_.grid.spacing_mm)));
    for (int row = from; row <= to; ++row) {
      Candidate candidate = seated;
      candidate.pins[3] = {curve_index, false, 0, row};
      candidate.placement.x_right_mm = x_where_it_touches(judge_.touch(candidate.pins[3]), theta_rad, y_mm);
      if (auto fixture = judge_.judged(candidate)) found_.push_back(*fixture);
    }
  }

  /// Range of y of the curve's pin centres about the part origin, empty where the pin would not push to -x.
  static geometry::Interval heights(const ContactCurve& curve, double theta_rad) {
    const double c = std::cos(theta_rad);
    const double s = std::sin(theta_rad);
    const auto height = [&](const Vector2d& q_mm) { return s * q_mm.x() + c * q_mm.y(); };
    if (curve.arc) {
      const double middle_mm = height(curve.center_mm);
      return {middle_mm - curve.rho_mm - kNear_mm, middle_mm + curve.rho_mm + kNear_mm};
    }
    if (c * curve.normal.x() - s * curve.normal.y() <= 0) return {1, -1};
    const double one = height(curve.ends_mm[0]);
    const double two = height(curve.ends_mm[1]);
    return {std::min(one, two) - kNear_mm, std::max(one, two) + kNear_mm};
  }

  const std::vector<ContactCurve>& curves_;
  const Judge& judge_;
  const model::Kit& kit_;
  std::vector<Candidate> found_;
};

using ByFirst = std::map<int, ThetaBins::Bin>;

ByFirst by_first(const ThetaBins::Bin& bin) {
  ByFirst groups;
  for (const Piece* piece : bin.starting) groups[piece->a].starting.push_back(piece);
  for (const Piece* piece : bin.going) {
    const auto group = groups.find(piece->a);
    if (group != groups.end()) group->second.going.push_back(piece);
  }
  return groups;
}

}  // namespace

std::vector<Candidate> three_and_one(const std::vector<Piece>& pieces,
                                     const std::vector<ContactCurve>& curves, const Judge& judge,
                                     const model::Kit& kit, const Watch& watch) {
  ThetaBins bins(kTurn, kTripleBins);
  for (const Piece& piece : pieces) bins.add(piece);
  std::vector<std::vector<Candidate>> found(kTripleBins);
  std::atomic<std::size_t> done = 0;
  tbb::parallel_for(std::size_t{0}, kTripleBins, [&](std::size_t i) {
    if (watch.stop.stop_requested()) return;
    TripleSearch search(curves, judge, kit);
    for (const auto& [a, group] : by_first(bins[i])) {
      for (std::size_t k = 0; k < group.starting.size(); ++k) {
        for (std::size_t j = 0; j < k; ++j) search.meet(*group.starting[k], *group.starting[j]);
        for (const Piece* other : group.going) search.meet(*group.starting[k], *other);
      }
    }
    found[i] = search.take();
    const std::size_t now = ++done;
    if (watch.progress) watch.progress(static_cast<double>(now) / static_cast<double>(kTripleBins));
  });
  std::vector<Candidate> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace pinjaw::planner::planar

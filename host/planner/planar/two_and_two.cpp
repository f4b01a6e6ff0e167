#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <cmath>

#include "host/planner/planar/constants.hpp"
#include "host/planner/planar/crossing.hpp"
#include "host/planner/planar/sweep.hpp"
#include "host/planner/planar/theta_bins.hpp"

namespace pinjaw::planner::planar {
namespace {

constexpr std::size_t kPairBins = 512;       // chosen: slices of some 0.006 rad
constexpr double kLeastOverlap_rad = 1e-10;  // a gap between normals of exactly pi never closes

/// A left pair seen from the right jaw, the gripper turned by 180 degrees: y of pin A is mirrored.
Piece turned(const Piece& piece) {
  Piece other = piece;
  other.theta_rad = {piece.theta_rad.lo - kPi, piece.theta_rad.hi - kPi};
  for (double& c : other.c) c = -c;
  other.y_mm = {-piece.y_mm.hi, -piece.y_mm.lo};
  return other;
}

/// Four forces can balance only where the cone of one jaw's normals overlaps the other's turned by pi.
bool cones_oppose(const Piece& left, const Piece& right) {
  const double off_rad = std::abs(std::abs(left.cone_rad - right.cone_rad) - kPi);
  return off_rad < left.cone_half_rad + right.cone_half_rad - kLeastOverlap_rad;
}

class SliceSearch {
 public:
  SliceSearch(const Judge& judge, const model::Kit& kit) : judge_(judge), kit_(kit) {}

  void meet(const std::vector<const Piece*>& lefts, const std::vector<const Piece*>& rights) {
    for (const Piece* left : lefts) {
      for (const Piece* right : rights) {
        if (cones_oppose(*left, *right)) meet(*left, *right);
      }
    }
  }

  [[nodiscard]] std::vector<Candidate> take() { return std::move(found_); }

 private:
  void meet(const Piece& left, const Piece& right) {
    const auto try_at = [&](double theta_rad, double y_mm, int row) {
      weigh(left, right, theta_rad, y_mm, row);
    };
    const int most = kit_.grid.rows - 1;
    PieceCrossing(kit_.grid.spacing_mm, try_at)(left, right,
                                                {left.holes.rows + right.holes.rows - most, most});
  }

  void weigh(const Piece& left, const Piece& right, double theta_rad, double y_mm, int row) {
    const int left_column = std::max(0, -left.holes.columns);
    const int right_column = std::max(0, -right.holes.columns);
    Candidate candidate;
    candidate.pins = {{{left.a, true, left_column, 0},
                       {left.b, true, left_column + left.holes.columns, left.holes.rows},
                       {right.a, false, right_column, row},
                       {right.b, false, right_column + right.holes.columns, row - right.holes.rows}}};
    Placement& placement = candidate.placement;
    placement.theta_rad = theta_rad;
    placement.y_mm = y_mm;
    placement.x_left_mm = x_where_it_touches(judge_.touch(candidate.pins[0]), theta_rad, y_mm);
    placement.x_right_mm = x_where_it_touches(judge_.touch(candidate.pins[2]), theta_rad, y_mm);
    if (auto fixture = judge_.judged(candidate)) found_.push_back(*fixture);
  }

  const Judge& judge_;
  const model::Kit& kit_;
  std::vector<Candidate> found_;
};

}  // namespace

std::vector<Candidate> two_and_two(const std::vector<Piece>& pieces, const Judge& judge,
                                   const model::Kit& kit, const Watch& watch) {
  ThetaBins lefts(kPi, kPairBins);
  ThetaBins rights(kPi, kPairBins);
  std::vector<Piece> turned_pieces;
  turned_pieces.reserve(pieces.size());
  for (const Piece& piece : pieces) {
    if (piece.theta_rad.lo < kPi) {
      lefts.add(piece);
    } else {
      turned_pieces.push_back(turned(piece));
    }
  }
  for (const Piece& piece : turned_pieces) rights.add(piece);
  std::vector<std::vector<Candidate>> found(kPairBins);
  std::atomic<std::size_t> done = 0;
  tbb::parallel_for(std::size_t{0}, kPairBins, [&](std::size_t i) {
    if (watch.stop.stop_requested()) return;
    SliceSearch search(judge, kit);
    search.meet(lefts[i].starting, rights[i].starting);
    search.meet(lefts[i].starting, rights[i].going);
    search.meet(lefts[i].going, rights[i].starting);
    found[i] = search.take();
    const std::size_t now = ++done;
    if (watch.progress) watch.progress(static_cast<double>(now) / static_cast<double>(kPairBins));
  });
  std::vector<Candidate> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace pinjaw::planner::planar

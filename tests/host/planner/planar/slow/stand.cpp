#include "tests/host/planner/planar/slow/stand.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pinjaw::planner::slow {
namespace {

std::size_t side(const Pin& pin) {
  return pin.hole.jaw == model::JawSide::Left ? 0 : 1;
}
Vector2d hole_mm(const Task& task, const Pin& pin) {
  const double d_mm = task.kit.grid.spacing_mm;
  return {side(pin) == 0 ? -d_mm * pin.hole.column : d_mm * pin.hole.column, d_mm * pin.hole.row};
}
const Track& track_of(const Task& task, const Pin& pin) {
  return task.tracks[static_cast<std::size_t>(pin.feature)];
}

/// Pin centres from the part origin, gripper axes.
Vector2d lever_mm(const Task& task, const Stand& stand, const Pin& pin) {
  return hole_mm(task, pin) - Vector2d(stand.x_mm[side(pin)], stand.y_mm);
}

using Misses = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
using Slopes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;

Misses misses(const Task& task, const Stand& stand) {
  const Turn turn(stand.theta_rad);
  Misses miss(static_cast<Eigen::Index>(stand.pins.size()));
  for (std::size_t k = 0; k < stand.pins.size(); ++k) {
    const Pin& pin = stand.pins[k];
    miss(static_cast<Eigen::Index>(k)) = track_of(task, pin).miss_mm(turn.back(lever_mm(task, stand, pin)));
  }
  return miss;
}

/// The figures that `settle` moves: theta, y, and the x of each jaw that has pins.
std::vector<double*> freedoms(Stand& stand) {
  std::vector<double*> list{&stand.theta_rad, &stand.y_mm};
  for (const std::size_t jaw : {0U, 1U}) {
    if (std::ranges::any_of(stand.pins, [&](const Pin& pin) { return side(pin) == jaw; })) {
      list.push_back(&stand.x_mm[jaw]);
    }
  }
  return list;
}

/// How much each of four contact forces takes part in a balance, in mm: the minors of their wrenches.
Eigen::Vector4d balance_mm(const Task& task, const Stand& stand) {
  const Turn turn(stand.theta_rad);
  Eigen::Matrix<double, 3, 4> wrenches;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector2d lever = lever_mm(task, stand, stand.pins[k]);
    const Vector2d n = turn * track_of(task, stand.pins[k]).outward(turn.back(lever));
    wrenches.col(static_cast<Eigen::Index>(k)) << -n.x(), -n.y(), -(lever.x() * n.y() - lever.y() * n.x());
  }
  Eigen::Vector4d balance;
  for (Eigen::Index k = 0; k < 4; ++k) {
    Eigen::Matrix3d others;
    for (Eigen::Index i = 0, to = 0; i < 4; ++i) {
      if (i != k) others.col(to++) = wrenches.col(i);
    }
    balance(k) = (k % 2 == 0 ? 1 : -1) * others.determinant();
  }
  return balance;
}

/// Least multiplier, their absolute values summing to 1; 0 where the forces have no rank 3.
double closure_margin(const Task& task, const Stand& stand) {
  const Eigen::Vector4d balance = balance_mm(task, stand);
  const double sum = balance.cwiseAbs().sum();
  if (sum < 1e-6) return 0;
  return (balance.sum() < 0 ? -balance : balance).minCoeff() / sum;
}

/// Distance by which a rule is kept; what is kept by a hair or broken by a hair is on the border.
class Rules {
 public:
  void keep(double slack, double hair) {
    kept_ = kept_ && slack >= 0;
    border_ = border_ || std::abs(slack) < hair;
    broken_ = broken_ || slack <= -hair;
  }
  [[nodiscard]] bool kept() const { return kept_; }
  [[nodiscard]] bool broken() const { return broken_; }
  [[nodiscard]] bool border() const { return border_ && !broken_; }

 private:
  bool kept_ = true;
  bool border_ = false;
  bool broken_ = false;
};

constexpr double kHair_mm = 1e-8;  // chosen: roots are good to 1e-10

double segment_distance_mm(const geometry::Segment& segment, const Vector2d& p_mm) {
  const Vector2d along = segment.b_mm - segment.a_mm;
  const double share = std::clamp(along.dot(p_mm - segment.a_mm) / along.squaredNorm(), 0.0, 1.0);
  return (segment.a_mm + share * along - p_mm).norm();
}

double arc_distance_mm(const geometry::Arc& arc, const Vector2d& p_mm) {
  const double half_rad = arc.sweep_rad / 2;
  const Vector2d radial = p_mm - arc.center_mm;
  const double off_rad =
      std::remainder(std::atan2(radial.y(), radial.x()) - arc.from_rad - half_rad, 2 * std::numbers::pi);
  const double at_rad = arc.from_rad + half_rad + std::clamp(off_rad, -half_rad, half_rad);
  return (arc.center_mm + arc.radius_mm * geometry::direction(at_rad) - p_mm).norm();
}

double outline_distance_mm(const model::Profile& outline, const Vector2d& p_mm) {
  double least_mm = std::numeric_limits<double>::infinity();
  for (const auto& loop : outline.loops) {
    for (const model::ProfileEdge& edge : loop) {
      const auto* segment = std::get_if<geometry::Segment>(&edge.curve);
      least_mm =
          std::min(least_mm, segment != nullptr ? segment_distance_mm(*segment, p_mm)
                                                : arc_distance_mm(std::get<geometry::Arc>(edge.curve), p_mm));
    }
  }
  return least_mm;
}

/// Room of a foot before the end of what a pin can reach, negative outside.
double room_in_reach_mm(const model::Feature& feature, double along_mm, bool closed) {
  double room_mm = -std::numeric_limits<double>::infinity();
  for (const geometry::Interval& reach_mm : feature.reach_mm) {
    if (closed && reach_mm.length() > geometry::length_mm(feature.curve) - 1e-9) return 1;
    room_mm = std::max(room_mm, std::min(along_mm - reach_mm.lo, reach_mm.hi - along_mm));
  }
  return room_mm;
}

void judge_foot(const Task& task, const Stand& stand, const Pin& pin, Rules& rules) {
  const Turn turn(stand.theta_rad);
  const Vector2d q_mm = turn.back(lever_mm(task, stand, pin));
  const Track& track = track_of(task, pin);
  const model::Feature& feature = task.features[static_cast<std::size_t>(pin.feature)];
  const double n_x = (turn * track.outward(q_mm)).x();
  rules.keep((side(pin) == 0 ? -n_x : n_x) - 1e-6, 1e-8);
  const double along_mm = track.nearest(q_mm) * track.feature_per_track();
  rules.keep(room_in_reach_mm(feature, along_mm, track.closed()) + 1e-7, task.reach_hair_mm);
  if (task.outline != nullptr) {
    rules.keep(outline_distance_mm(*task.outline, q_mm) - task.kit.pins.radius_mm + 1e-6, 2e-7);
  }
  if (task.kit.pins.min_foot_margin_mm > 0 && !track.closed()) {
    const double margin_mm = std::min(along_mm, geometry::length_mm(feature.curve) - along_mm);
    rules.keep(margin_mm - task.kit.pins.min_foot_margin_mm, kHair_mm);
  }
}

void judge_plates(const Task& task, const Stand& told, Rules& rules) {
  const model::Grid& grid = task.kit.grid;
  int most_row = 0;
  int most_column[2] = {0, 0};
  for (const Pin& pin : told.pins) {
    most_row = std::max(most_row, pin.hole.row);
    most_column[side(pin)] = std::max(most_column[side(pin)], pin.hole.column);
    for (const Pin& other : told.pins) {
      if (!(pin < other)) continue;
      const Vector2d apart_mm = lever_mm(task, told, pin) - lever_mm(task, told, other);
      rules.keep(apart_mm.norm() - 2 * task.kit.pins.radius_mm, kHair_mm);
    }
  }
  const bool fits = most_row < grid.rows && std::max(most_column[0], most_column[1]) < grid.columns;
  rules.keep(fits ? 1 : -1, kHair_mm);
  double room_mm = -std::numeric_limits<double>::infinity();
  for (int shift = 0; fits && shift <= 2 * (grid.columns - 1) - most_column[0] - most_column[1]; ++shift) {
    const double s_mm = span_mm(told) - 2 * grid.edge_offset_mm - shift * grid.spacing_mm;
    const geometry::Interval& range_mm = task.kit.jaws.separation_mm;
    room_mm = std::max(room_mm, std::min(s_mm - range_mm.lo, range_mm.hi - s_mm));
  }
  rules.keep(room_mm, kHair_mm);
}

}  // namespace

Task task_of(std::vector<model::Feature> features, const model::Kit& kit, const model::Profile* outline) {
  Task task;
  task.features = std::move(features);
  task.kit = kit;
  task.outline = outline;
  for (const model::Feature& feature : task.features) task.tracks.emplace_back(feature, kit.pins.radius_mm);
  return task;
}

bool settle(const Task& task, Stand& stand) {
  constexpr double kStep = 1e-6;  // rad and mm
  const std::vector<double*> moved = freedoms(stand);
  const auto count = static_cast<Eigen::Index>(moved.size());
  Slopes slope(count, count);
  for (int round = 0; round < 15; ++round) {
    const Misses miss = misses(task, stand);
    if (!miss.allFinite()) return false;
    if (miss.cwiseAbs().maxCoeff() < 1e-11) return true;
    for (Eigen::Index k = 0; k < count; ++k) {
      double& value = *moved[static_cast<std::size_t>(k)];
      const double was = value;
      value = was + kStep;
      const Misses more = misses(task, stand);
      value = was - kStep;
      slope.col(k) = (more - misses(task, stand)) / (2 * kStep);
      value = was;
    }
    const Misses change = slope.partialPivLu().solve(miss);
    if (!(std::abs(change(0)) < 0.3)) return false;
    for (Eigen::Index k = 0; k < count; ++k) *moved[static_cast<std::size_t>(k)] -= change(k);
  }
  return false;
}

bool surely_open(const Task& task, const Stand& stand) {
  const Eigen::Vector4d balance = balance_mm(task, stand);
  const double turns_mm = 1 + 0.1 * balance.cwiseAbs().sum();
  return balance.minCoeff() < -turns_mm && balance.maxCoeff() > turns_mm;
}

Verdict verdict(const Task& task, const Stand& stand) {
  Rules rules;
  const double margin = closure_margin(task, stand);
  // a margin of exactly 0 (parallel or concurrent forces) is no strict closure, to no doubt
  rules.keep(margin - 1e-9, margin < 1e-10 ? 0 : 1e-5);
  for (const Pin& pin : stand.pins) {
    if (!rules.broken()) judge_foot(task, stand, pin, rules);
  }
  if (!rules.broken()) judge_plates(task, canonical(task, stand), rules);
  return {rules.kept(), rules.border(), margin};
}

Stand canonical(const Task& task, Stand stand) {
  const double d_mm = task.kit.grid.spacing_mm;
  int least_row = std::numeric_limits<int>::max();
  int least_column[2] = {least_row, least_row};
  for (const Pin& pin : stand.pins) {
    least_row = std::min(least_row, pin.hole.row);
    least_column[side(pin)] = std::min(least_column[side(pin)], pin.hole.column);
  }
  for (Pin& pin : stand.pins) {
    pin.hole.row -= least_row;
    pin.hole.column -= least_column[side(pin)];
  }
  stand.y_mm -= least_row * d_mm;
  stand.x_mm[0] += least_column[0] * d_mm;
  stand.x_mm[1] -= least_column[1] * d_mm;
  std::ranges::sort(stand.pins);
  stand.theta_rad = geometry::wrapped_rad(stand.theta_rad);
  return stand;
}

Stand stand_of(const PlanarFixture& fixture) {
  Stand stand;
  for (const PlanarPin& pin : fixture.pins) stand.pins.push_back({pin.hole, pin.feature});
  stand.theta_rad = fixture.theta_rad;
  stand.y_mm = fixture.y_mm;
  stand.x_mm[0] = fixture.x_left_mm;
  stand.x_mm[1] = fixture.x_left_mm - fixture.span_mm;
  return stand;
}

double span_mm(const Stand& stand) {
  return stand.x_mm[0] - stand.x_mm[1];
}

}  // namespace pinjaw::planner::slow

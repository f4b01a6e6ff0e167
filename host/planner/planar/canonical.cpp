#include "host/planner/planar/canonical.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "host/planner/planar/constants.hpp"

namespace pinjaw::planner::planar {
namespace {

constexpr double kSameAngle_rad = 1e-7;  // chosen: polished roots agree to 1e-10
constexpr double kSamePlace_mm = 1e-6;
constexpr double kWholeTurn_rad = 1e-9;  // rounding below 0 is told as 0, not as a whole turn

using Key = std::array<int, 4>;

double told_angle(double theta_rad) {
  const double wrapped = geometry::wrapped_rad(theta_rad);
  return kTurn - wrapped < kWholeTurn_rad ? 0.0 : wrapped;
}

std::array<model::Hole, 4> holes(const PlanarFixture& fixture) {
  return {fixture.pins[0].hole, fixture.pins[1].hole, fixture.pins[2].hole, fixture.pins[3].hole};
}

Key features(const PlanarFixture& fixture) {
  return {fixture.pins[0].feature, fixture.pins[1].feature, fixture.pins[2].feature, fixture.pins[3].feature};
}

bool same_pose(const PlanarFixture& a, const PlanarFixture& b) {
  return std::abs(std::remainder(a.theta_rad - b.theta_rad, kTurn)) < kSameAngle_rad &&
         std::abs(a.span_mm - b.span_mm) < kSamePlace_mm && std::abs(a.y_mm - b.y_mm) < kSamePlace_mm &&
         std::abs(a.x_left_mm - b.x_left_mm) < kSamePlace_mm;
}

void sort_pins(PlanarFixture& fixture) {
  std::sort(fixture.pins.begin(), fixture.pins.end(),
            [](const PlanarPin& a, const PlanarPin& b) { return a.hole < b.hole; });
}

/// Of fixtures with equal split and holes, those that no other of the same pose precedes.
void keep_poses(std::vector<const PlanarFixture*>& group, std::vector<PlanarFixture>& out) {
  std::sort(group.begin(), group.end(), [](const PlanarFixture* a, const PlanarFixture* b) {
    return std::make_tuple(a->theta_rad, features(*a)) < std::make_tuple(b->theta_rad, features(*b));
  });
  const std::size_t count = group.size();
  const std::size_t first = out.size();
  for (std::size_t i = 0; i < count; ++i) {
    bool preceded = false;
    const auto look = [&](std::size_t step_size) {
      for (std::size_t step = 1; step < count && !preceded; ++step) {
        const std::size_t k = (i + step * step_size) % count;
        const double apart_rad = std::remainder(group[k]->theta_rad - group[i]->theta_rad, kTurn);
        if (std::abs(apart_rad) >= kSameAngle_rad) break;
        preceded = same_pose(*group[k], *group[i]) &&
                   std::make_tuple(features(*group[k]), k) < std::make_tuple(features(*group[i]), i);
      }
    };
    look(1);
    look(count - 1);
    if (!preceded) out.push_back(*group[i]);
  }
  std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
            [](const PlanarFixture& a, const PlanarFixture& b) {
              return std::make_tuple(features(a), a.theta_rad) < std::make_tuple(features(b), b.theta_rad);
            });
}

/// The same fixture with the gripper turned by 180 degrees.
PlanarFixture twin_of(const PlanarFixture& fixture, double spacing_mm) {
  int top_row = 0;
  for (const PlanarPin& pin : fixture.pins) top_row = std::max(top_row, pin.hole.row);
  PlanarFixture twin = fixture;
  if (fixture.split == model::Split::ThreeOne) twin.split = model::Split::OneThree;
  if (fixture.split == model::Split::OneThree) twin.split = model::Split::ThreeOne;
  twin.theta_rad = told_angle(fixture.theta_rad + std::numbers::pi);
  twin.y_mm = top_row * spacing_mm - fixture.y_mm;
  twin.x_left_mm = fixture.span_mm - fixture.x_left_mm;
  for (PlanarPin& pin : twin.pins) {
    pin.hole.jaw = pin.hole.jaw == model::JawSide::Left ? model::JawSide::Right : model::JawSide::Left;
    pin.hole.row = top_row - pin.hole.row;
  }
  sort_pins(twin);
  return twin;
}

bool stands_for_both(const PlanarFixture& fixture, double spacing_mm) {
  const PlanarFixture twin = twin_of(fixture, spacing_mm);
  return std::make_tuple(holes(fixture), features(fixture), fixture.theta_rad) <=
         std::make_tuple(holes(twin), features(twin), twin.theta_rad);
}

}  // namespace

PlanarFixture fixture_of(const Candidate& candidate, const std::vector<ContactCurve>& curves,
                         const std::vector<model::Feature>& features, const model::Kit& kit) {
  const Judge judge(curves, features, kit);
  int row = candidate.pins[0].row;
  int left_count = 0;
  std::array<int, 2> column{kit.grid.columns, kit.grid.columns};
  for (const CandidatePin& pin : candidate.pins) {
    row = std::min(row, pin.row);
    left_count += pin.left ? 1 : 0;
    int& least = column[pin.left ? 0 : 1];
    least = std::min(least, pin.column);
  }
  const double d_mm = kit.grid.spacing_mm;
  PlanarFixture fixture;
  fixture.split = left_count == 2   ? model::Split::TwoTwo
                  : left_count == 3 ? model::Split::ThreeOne
                                    : model::Split::OneThree;
  fixture.theta_rad = told_angle(candidate.placement.theta_rad);
  fixture.y_mm = candidate.placement.y_mm - row * d_mm;
  fixture.x_left_mm = candidate.placement.x_left_mm + column[0] * d_mm;
  fixture.span_mm = fixture.x_left_mm - candidate.placement.x_right_mm + column[1] * d_mm;
  fixture.closure_margin = candidate.closure_margin;
  const geometry::Pose2 back{-candidate.placement.theta_rad, Vector2d::Zero()};
  for (std::size_t k = 0; k < 4; ++k) {
    const CandidatePin& from = candidate.pins[k];
    const ContactCurve& curve = curves[static_cast<std::size_t>(from.curve)];
    const ContactState state = contact_at(judge.touch(from), candidate.placement);
    const Vector2d q_mm = back.turned(state.lever_mm);
    PlanarPin& pin = fixture.pins[k];
    pin.hole = {from.left ? model::JawSide::Left : model::JawSide::Right,
                from.column - column[from.left ? 0 : 1], from.row - row};
    pin.feature = features[static_cast<std::size_t>(curve.feature)].id;
    pin.along_mm = judge.foot_along_mm(curve, q_mm);
    pin.foot_margin_mm = judge.foot_margin_mm(curve, q_mm);
    pin.n_P = -normal_at(curve, q_mm);
    pin.p_PFoot_mm = q_mm + kit.pins.radius_mm * pin.n_P;
  }
  sort_pins(fixture);
  return fixture;
}

void add_with_twin(const PlanarFixture& fixture, Twins twins, double spacing_mm,
                   std::vector<PlanarFixture>& out) {
  const PlanarFixture twin = twin_of(fixture, spacing_mm);
  const bool once = twins == Twins::Once;
  if (!once || holes(fixture) <= holes(twin)) out.push_back(fixture);
  if (!once || holes(twin) <= holes(fixture)) out.push_back(twin);
}

std::vector<PlanarFixture> listed_once(const std::vector<PlanarFixture>& fixtures, Twins twins,
                                       double spacing_mm) {
  std::vector<const PlanarFixture*> order;
  order.reserve(fixtures.size());
  for (const PlanarFixture& fixture : fixtures) order.push_back(&fixture);
  const auto pattern = [](const PlanarFixture& fixture) {
    return std::make_tuple(fixture.split, holes(fixture));
  };
  std::sort(order.begin(), order.end(),
            [&](const PlanarFixture* a, const PlanarFixture* b) { return pattern(*a) < pattern(*b); });
  std::vector<PlanarFixture> kept;
  std::vector<const PlanarFixture*> group;
  for (std::size_t i = 0; i < order.size(); ++i) {
    group.push_back(order[i]);
    if (i + 1 < order.size() && pattern(*order[i + 1]) == pattern(*order[i])) continue;
    keep_poses(group, kept);
    group.clear();
  }
  if (twins == Twins::Once) {
    std::erase_if(kept, [&](const PlanarFixture& fixture) { return !stands_for_both(fixture, spacing_mm); });
  }
  return kept;
}

}  // namespace pinjaw::planner::planar

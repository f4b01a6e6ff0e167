#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "host/planner/planar/column_shifts.hpp"
#include "tests/host/planner/planar/read_case.hpp"
#include "tests/host/planner/planar/shapes.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;

model::Profile crooked_pentagon() {
  return polygon_profile(
      {Vector2d(0, 0), Vector2d(32, -4), Vector2d(43, 19), Vector2d(21, 38), Vector2d(-6, 24)});
}

std::ptrdiff_t count_of(const std::vector<PlanarFixture>& fixtures, model::Split split) {
  return std::ranges::count_if(fixtures,
                               [&](const PlanarFixture& fixture) { return fixture.split == split; });
}

bool same_bytes(const PlanarFixture& a, const PlanarFixture& b) {
  const auto figures = [](const PlanarFixture& fixture) {
    std::vector<double> all{fixture.theta_rad, fixture.span_mm, fixture.y_mm, fixture.x_left_mm,
                            fixture.closure_margin};
    for (const PlanarPin& pin : fixture.pins) {
      all.insert(all.end(),
                 {static_cast<double>(pin.hole.jaw), static_cast<double>(pin.hole.column),
                  static_cast<double>(pin.hole.row), static_cast<double>(pin.feature), pin.along_mm,
                  pin.foot_margin_mm, pin.p_PFoot_mm.x(), pin.p_PFoot_mm.y(), pin.n_P.x(), pin.n_P.y()});
    }
    return all;
  };
  const std::vector<double> one = figures(a);
  const std::vector<double> other = figures(b);
  return std::memcmp(one.data(), other.data(), one.size() * sizeof(double)) == 0;
}

TEST(PlanarLaws, a_part_without_features_has_no_fixture) {
  EXPECT_TRUE(plan_planar_fixtures({}, small_kit(3, 4)).fixtures.empty());
}

TEST(PlanarLaws, moving_the_part_in_its_frame_only_turns_theta) {
  for (const model::Profile& part : {crooked_pentagon(), rounded_part()}) {
    const geometry::Pose2 motion{0.7, Vector2d(13, -25)};
    const auto still = all_fixtures(part, small_kit(3, 4));
    ASSERT_GT(still.size(), 100U);
    EXPECT_TRUE(same_lists(still, all_fixtures(moved(part, motion), small_kit(3, 4)), -0.7));
  }
}

TEST(PlanarLaws, mirroring_the_part_keeps_the_counts_of_each_split) {
  for (const model::Profile& part : {crooked_pentagon(), rounded_part()}) {
    const auto straight = all_fixtures(part, small_kit(3, 4));
    const auto flipped = all_fixtures(mirrored(part), small_kit(3, 4));
    for (const auto split : {model::Split::TwoTwo, model::Split::ThreeOne, model::Split::OneThree}) {
      EXPECT_EQ(count_of(straight, split), count_of(flipped, split));
    }
  }
}

TEST(PlanarLaws, scaling_part_and_kit_together_scales_the_spans) {
  auto large = all_fixtures(scaled(rounded_part(), 2.5), scaled(small_kit(3, 4), 2.5));
  for (PlanarFixture& fixture : large) fixture.span_mm /= 2.5;
  EXPECT_TRUE(same_lists(all_fixtures(rounded_part(), small_kit(3, 4)), large));
}

TEST(PlanarLaws, turning_the_gripper_gives_the_same_list) {
  for (const model::Profile& part : {crooked_pentagon(), rounded_part()}) {
    const auto fixtures = all_fixtures(part, small_kit(3, 4));
    EXPECT_EQ(fixtures.size() % 2, 0U);
    EXPECT_EQ(count_of(fixtures, model::Split::ThreeOne), count_of(fixtures, model::Split::OneThree));
    EXPECT_EQ(count_of(fixtures, model::Split::TwoTwo) % 2, 0);
    EXPECT_EQ(all_fixtures(part, small_kit(3, 4), Twins::Once).size() * 2, fixtures.size());
  }
}

TEST(PlanarLaws, turning_the_part_by_half_a_turn_gives_the_same_list) {
  const auto still = all_fixtures(rounded_part(), small_kit(3, 4));
  const geometry::Pose2 half{std::numbers::pi, Vector2d::Zero()};
  EXPECT_TRUE(
      same_lists(still, all_fixtures(moved(rounded_part(), half), small_kit(3, 4)), -std::numbers::pi));
}

TEST(PlanarLaws, any_number_of_threads_gives_the_same_bytes) {
  const auto one = all_fixtures(rounded_part(), small_kit(4, 6), Twins::Both, 1);
  for (const int threads : {2, 3, 5, 0}) {
    const auto many = all_fixtures(rounded_part(), small_kit(4, 6), Twins::Both, threads);
    ASSERT_EQ(one.size(), many.size());
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_TRUE(same_bytes(one[i], many[i]));
  }
}

/// `profile` with each loop started `by` edges later.
model::Profile started_later(model::Profile profile, std::ptrdiff_t by) {
  for (auto& loop : profile.loops) std::rotate(loop.begin(), loop.begin() + by, loop.end());
  return profile;
}

TEST(PlanarLaws, the_edge_at_which_a_loop_starts_does_not_matter) {
  for (const model::Profile& part : {crooked_pentagon(), rounded_part()}) {
    const int count = static_cast<int>(part.loops[0].size());
    auto relabelled = all_fixtures(started_later(part, 2), small_kit(3, 4));
    for (PlanarFixture& fixture : relabelled) {
      for (PlanarPin& pin : fixture.pins) pin.feature = (pin.feature + 2) % count;
    }
    EXPECT_TRUE(same_lists(all_fixtures(part, small_kit(3, 4)), relabelled));
  }
}

TEST(PlanarLaws, the_order_of_the_features_does_not_matter) {
  const model::Profile part = rounded_part();
  auto features = model::features_of(part);
  PlanarOptions options;
  options.outline = &part;
  const auto straight = plan_planar_fixtures(features, small_kit(3, 4), options).fixtures;
  std::reverse(features.begin(), features.end());
  EXPECT_TRUE(same_lists(straight, plan_planar_fixtures(features, small_kit(3, 4), options).fixtures));
}

/// `profile` with edge `index` of its outer loop told as two, cut at `share` of its length.
model::Profile cut(model::Profile profile, std::size_t index, double share) {
  auto& loop = profile.loops[0];
  model::ProfileEdge first = loop[index];
  model::ProfileEdge second = first;
  if (const auto* segment = std::get_if<geometry::Segment>(&first.curve)) {
    const Vector2d middle = segment->a_mm + share * (segment->b_mm - segment->a_mm);
    second.curve = geometry::Segment{middle, segment->b_mm};
    first.curve = geometry::Segment{segment->a_mm, middle};
  } else {
    geometry::Arc low = std::get<geometry::Arc>(first.curve);
    geometry::Arc high = low;
    low.sweep_rad *= share;
    high.from_rad += low.sweep_rad;
    high.sweep_rad -= low.sweep_rad;
    first.curve = first.reversed ? high : low;
    second.curve = second.reversed ? low : high;
  }
  loop[index] = first;
  loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(index) + 1, second);
  return profile;
}

TEST(PlanarLaws, an_edge_cut_in_two_holds_the_same_poses_but_for_feet_at_the_cut) {
  for (const model::Profile& part : {crooked_pentagon(), rounded_part()}) {
    const auto whole = all_fixtures(part, small_kit(3, 4));
    for (std::size_t index = 0; index < part.loops[0].size(); ++index) {
      auto halves = all_fixtures(cut(part, index, 0.37), small_kit(3, 4));
      for (PlanarFixture& fixture : halves) {
        for (PlanarPin& pin : fixture.pins) pin.feature -= pin.feature > static_cast<int>(index) ? 1 : 0;
      }
      EXPECT_TRUE(same_lists(whole, halves)) << "edge " << index;  // no foot of these parts is at a cut
    }
  }
}

/// Slopes of the four touches over turn and move of the part and the closing of the jaws, each row a unit
/// normal's; lengths of turn in units of `arm_mm`.
Eigen::Matrix4d contact_slopes(const PlanarFixture& fixture, double arm_mm) {
  Eigen::Matrix4d slopes;
  for (std::size_t k = 0; k < 4; ++k) {
    const PlanarPin& pin = fixture.pins[k];
    const Vector2d n = geometry::Pose2{fixture.theta_rad, Vector2d::Zero()}.turned(pin.n_P);
    const Vector2d p = geometry::Pose2{fixture.theta_rad, Vector2d::Zero()}.turned(pin.p_PFoot_mm);
    const double closing = (pin.hole.jaw == model::JawSide::Left ? n.x() : -n.x());
    slopes.row(static_cast<Eigen::Index>(k)) << n.x(), n.y(), (p.x() * n.y() - p.y() * n.x()) / arm_mm,
        closing;
  }
  return slopes;
}

TEST(PlanarLaws, every_fixture_is_a_simple_root_by_a_bound_of_its_own) {
  for (const char* name : {"triangle", "lshape", "pentagon", "star12", "arcs"}) {
    const KnownCase known = read_case(name);
    for (const PlanarFixture& fixture : all_fixtures(known.profile, known.kit)) {
      const Eigen::Matrix4d slopes = contact_slopes(fixture, 20);
      const Eigen::Matrix<double, 4, 3> wrenches = slopes.leftCols<3>();
      // multipliers that balance the wrenches, summing to 1: positive, and then J x = e gives |closing| <=
      // |e| / sum(multiplier * push) and |motion| <= 2 (|e| + |closing|) / (least singular value of W)
      const Eigen::Vector4d balance =
          Eigen::FullPivLU<Eigen::Matrix<double, 3, 4>>(wrenches.transpose()).kernel().col(0);
      const Eigen::Vector4d multipliers = balance / balance.sum();
      EXPECT_NEAR(multipliers.minCoeff(), fixture.closure_margin, 1e-6);
      const double push = multipliers.dot(slopes.col(3));
      ASSERT_GT(push, 0);
      const double least_wrench = Eigen::JacobiSVD<Eigen::Matrix<double, 4, 3>>(wrenches).singularValues()(2);
      const double closing = 1 / push;
      const double motion = (1 + 2 * closing) / least_wrench;
      const double least = Eigen::JacobiSVD<Eigen::Matrix4d>(slopes).singularValues()(3);
      EXPECT_GE(least * (1 + 1e-9), 1 / std::hypot(closing, motion)) << name;
    }
  }
}

TEST(PlanarLaws, a_larger_kit_loses_no_fixture) {
  const auto small = all_fixtures(crooked_pentagon(), small_kit(2, 3));
  const auto large = all_fixtures(crooked_pentagon(), small_kit(3, 5));
  for (const PlanarFixture& fixture : small) {
    const bool kept = std::ranges::any_of(
        large, [&](const PlanarFixture& other) { return same_lists({fixture}, {other}); });
    EXPECT_TRUE(kept);
  }
}

TEST(PlanarLaws, every_pin_touches_its_feature_and_stays_out_of_the_outline) {
  const model::Profile part = rounded_part();
  const model::Kit kit = small_kit(3, 4);
  for (const PlanarFixture& fixture : all_fixtures(part, kit)) {
    EXPECT_GT(fixture.closure_margin, 0);
    const PlacedFixture placed = placed_least(kit, fixture);
    for (std::size_t k = 0; k < 4; ++k) {
      const PlanarPin& pin = fixture.pins[k];
      const auto features = model::features_of(part);
      const auto& feature = features[static_cast<std::size_t>(pin.feature)];
      EXPECT_LT((geometry::point_at(feature.curve, pin.along_mm) - pin.p_PFoot_mm).norm(), 1e-6);
      EXPECT_LT((model::outward_normal_at(feature, pin.along_mm) + pin.n_P).norm(), 1e-6);
      const Vector2d n_G = placed.part_pose.turned(pin.n_P);
      EXPECT_GT(placed.holes[k].jaw == model::JawSide::Left ? n_G.x() : -n_G.x(), 0);
    }
  }
}

TEST(PlanarLaws, a_foot_margin_keeps_just_the_fixtures_that_have_it) {
  model::Kit kit = small_kit(3, 4);
  const auto all = all_fixtures(rounded_part(), kit);
  kit.pins.min_foot_margin_mm = 2;
  const auto kept = all_fixtures(rounded_part(), kit);
  const auto has_margin = [](const PlanarFixture& fixture) {
    return std::ranges::all_of(fixture.pins, [](const PlanarPin& pin) { return pin.foot_margin_mm >= 2; });
  };
  EXPECT_EQ(static_cast<std::ptrdiff_t>(kept.size()), std::ranges::count_if(all, has_margin));
  EXPECT_LT(kept.size(), all.size());
}

TEST(PlanarLaws, a_stop_request_ends_the_search_without_a_list) {
  const model::Profile part = rounded_part();
  std::stop_source stop;
  stop.request_stop();
  PlanarOptions options;
  options.stop = stop.get_token();
  const PlanarResult result = plan_planar_fixtures(model::features_of(part), small_kit(3, 4), options);
  EXPECT_EQ(result.end, PlanarEnd::Stopped);
  EXPECT_TRUE(result.fixtures.empty());
}

TEST(ColumnShifts, come_least_first_and_move_the_left_jaw_first) {
  model::Kit kit = small_kit(3, 4);
  PlanarFixture fixture;
  fixture.span_mm = 11 + 33;
  for (std::size_t k = 0; k < 4; ++k) {
    fixture.pins[k].hole = {k < 2 ? model::JawSide::Left : model::JawSide::Right, 0, static_cast<int>(k % 2)};
  }
  kit.jaws.separation_mm = {0, 22};
  const auto shifts = column_shifts(kit, fixture);
  ASSERT_EQ(shifts.size(), 2U + 3U + 2U);
  EXPECT_EQ(shifts[0].left, 1);
  EXPECT_EQ(shifts[0].right, 0);
  EXPECT_DOUBLE_EQ(shifts[0].jaw_separation_mm, 22);
  EXPECT_EQ(shifts[1].left, 0);
  EXPECT_EQ(shifts[2].left, 2);
  EXPECT_DOUBLE_EQ(shifts.back().jaw_separation_mm, 0);
  kit.jaws.separation_mm = {0, -1};
  EXPECT_TRUE(column_shifts(kit, fixture).empty());
}

}  // namespace
}  // namespace pinjaw::planner

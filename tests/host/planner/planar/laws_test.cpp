#include <gtest/gtest.h>

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
  const auto many = all_fixtures(rounded_part(), small_kit(4, 6), Twins::Both, 5);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].theta_rad, many[i].theta_rad);
    EXPECT_EQ(one[i].span_mm, many[i].span_mm);
    EXPECT_EQ(one[i].closure_margin, many[i].closure_margin);
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

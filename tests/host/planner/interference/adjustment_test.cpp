#include "host/planner/interference/adjustment.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <set>

#include "host/planner/interference/interference.hpp"
#include "tests/host/planner/interference/test_designs.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Pose2;
using geometry::Vector2d;
using geometry::Vector3d;
using model::Side;
using testing::design_of;
using testing::kit;

constexpr double kPi = std::numbers::pi;

Eigen::Isometry3d spatial(const Pose2& pose) {
  return Eigen::Translation3d(pose.t_mm.x(), pose.t_mm.y(), 0) *
         Eigen::AngleAxisd(pose.theta_rad, Vector3d::UnitZ());
}

/// The part in the handoff frame, written out in space: turn the part to the gripper, pose it, adjust the
/// station, turn back.
Eigen::Isometry3d X_HP(const Hold& hold, const Adjustment& adjustment) {
  const double half_turn = hold.side == Side::Above ? kPi : 0;
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(half_turn, Vector3d::UnitY()));
  return turn * spatial({adjustment.theta_rad, adjustment.offset_mm}) * spatial(hold.part_pose) * turn;
}

Hold random_hold(base::Random& random, Side side) {
  return {side, {random.uniform(-3, 3), {random.uniform(-30, 30), random.uniform(-30, 30)}}};
}

double difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

TEST(Adjustment, equal_holds_need_none) {
  const Hold hold{Side::Below, {0.4, {1, 2}}};
  const Adjustment needed = required_adjustment(hold, {}, hold);
  EXPECT_NEAR(needed.theta_rad, 0, 1e-12);
  EXPECT_NEAR(needed.offset_mm.norm(), 0, 1e-12);
}

TEST(Adjustment, brings_the_part_to_one_place_from_any_sides) {
  base::Random random(51);
  for (int i = 0; i < 400; ++i) {
    const Hold a = random_hold(random, i % 2 == 0 ? Side::Below : Side::Above);
    const Hold b = random_hold(random, i % 4 < 2 ? Side::Below : Side::Above);
    const Adjustment known{random.uniform(-3, 3), {random.uniform(-9, 9), random.uniform(-9, 9)}};
    const Adjustment needed = required_adjustment(a, known, b);
    EXPECT_NEAR(difference(X_HP(a, known), X_HP(b, needed)), 0, 1e-9);
    EXPECT_LE(std::abs(needed.theta_rad), kPi);
  }
}

TEST(Adjustment, bounds_are_closed_and_angles_wrap) {
  const model::Adjust bounds{{-20, 20}, {0, 0}, {-kPi, kPi}};
  EXPECT_TRUE(within({kPi, {20, 0}}, bounds));
  EXPECT_TRUE(within({0, {-20, 1e-9}}, bounds));
  EXPECT_FALSE(within({0, {20.001, 0}}, bounds));
  EXPECT_FALSE(within({0, {0, 0.001}}, bounds));
  EXPECT_TRUE(within({-3, {0, 0}}, {{0, 0}, {0, 0}, {3, 4}})) << "-3 is 3.28";
  EXPECT_FALSE(within({0.1, {0, 0}}, {}));
}

TEST(PairAdjustment, an_arm_that_turns_meets_a_pedestal_that_slides) {
  const model::Adjust arm_bounds{{0, 0}, {0, 0}, {-kPi, kPi}};
  const model::Adjust pedestal_bounds{{-20, 20}, {-20, 20}, {0, 0}};
  base::Random random(52);
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const Hold arm = random_hold(random, Side::Above);
    const Hold pedestal = random_hold(random, Side::Below);
    const auto pair = pair_adjustment(arm, arm_bounds, pedestal, pedestal_bounds);
    const auto back = pair_adjustment(pedestal, pedestal_bounds, arm, arm_bounds);
    ASSERT_EQ(pair.has_value(), back.has_value());
    if (!pair) continue;
    ++found;
    EXPECT_TRUE(within(pair->giver, arm_bounds));
    EXPECT_TRUE(within(pair->receiver, pedestal_bounds));
    EXPECT_NEAR(difference(X_HP(arm, pair->giver), X_HP(pedestal, pair->receiver)), 0, 1e-8);
    EXPECT_NEAR(pair->receiver.offset_mm.x(), back->giver.offset_mm.x(), 1e-8);
  }
  EXPECT_GT(found, 20);
  EXPECT_LT(found, 280);
}

TEST(PairAdjustment, where_both_may_move_the_giver_moves_least) {
  const Hold hold{Side::Below, {0, {0, 0}}};
  const Hold other{Side::Below, {0.2, {8, -3}}};
  const model::Adjust free{{-5, 5}, {-5, 5}, {-kPi, kPi}};
  const auto pair = pair_adjustment(hold, free, hold, free);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->giver.theta_rad, 0);
  EXPECT_EQ(pair->giver.offset_mm, Vector2d(0, 0));
  const auto far = pair_adjustment(hold, free, other, {{-5, 5}, {-5, 5}, {0.5, 0.6}});
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->giver.theta_rad, 0.7, 1e-12);
  EXPECT_NEAR(difference(X_HP(hold, far->giver), X_HP(other, far->receiver)), 0, 1e-9);
}

TEST(PairAdjustment, without_room_there_is_none) {
  const Hold a{Side::Below, {0, {0, 0}}};
  EXPECT_FALSE(pair_adjustment(a, {}, {Side::Below, {0.1, {0, 0}}}, {}));
  EXPECT_FALSE(pair_adjustment(a, {}, {Side::Below, {0, {0.1, 0}}}, {}));
  EXPECT_TRUE(pair_adjustment(a, {}, {Side::Below, {2 * kPi, {0, 0}}}, {}));
}

model::Design shifted_design() {
  model::Design design = design_of({.part_pose = {0.5, {3, 4}}});
  design.alternatives = {{1, 0, 5}, {0, 1, 5}};
  return design;
}

TEST(Stances, start_with_the_design_as_it_stands) {
  const auto stances = stances_of(shifted_design(), kit());
  EXPECT_EQ(stances.size(), 9U) << "rows 0 to 2, three choices of columns";
  EXPECT_EQ(stances.front().row_shift, 0);
  EXPECT_EQ(stances.front().left_shift, 0);
  EXPECT_EQ(stances.front().part_pose.t_mm, Vector2d(3, 4));
  std::set<std::array<int, 3>> distinct;
  for (const Stance& s : stances) distinct.insert({s.row_shift, s.left_shift, s.right_shift});
  EXPECT_EQ(distinct.size(), stances.size());
}

TEST(Stances, keep_every_pin_on_its_contact) {
  const model::Design design = shifted_design();
  for (const Stance& stance : stances_of(design, kit())) {
    const model::Design there = moved(design, kit(), stance);
    EXPECT_EQ(there.jaw_open_mm, 40);
    for (std::size_t i = 0; i < there.pins.size(); ++i) {
      const model::PinDesign& pin = there.pins[i];
      const Vector2d hole_mm = model::p_GHole_mm(kit().grid, pin.hole, there.jaw_separation_mm);
      EXPECT_NEAR((hole_mm + 2.5 * pin.normal - pin.contact_mm).norm(), 0, 1e-9);
      const Vector2d on_part = there.part_pose.inverse() * pin.contact_mm;
      const Vector2d was_on_part = design.part_pose.inverse() * design.pins[i].contact_mm;
      EXPECT_NEAR((on_part - was_on_part).norm(), 0, 1e-9);
    }
    const auto back = stances_of(there, kit());
    EXPECT_EQ(back.size(), 9U);
  }
}

TEST(Stances, a_pallets_only_jaw_decides_its_columns) {
  model::Design pallet = shifted_design();
  pallet.pins.resize(2);
  pallet.jaw_open_mm = pallet.jaw_separation_mm;
  for (const Stance& stance : stances_of(pallet, kit())) {
    const model::Design there = moved(pallet, kit(), stance);
    EXPECT_EQ(there.jaw_open_mm, there.jaw_separation_mm);
    for (const model::PinDesign& pin : there.pins) {
      const Vector2d hole_mm = model::p_GHole_mm(kit().grid, pin.hole, there.jaw_separation_mm);
      EXPECT_NEAR((hole_mm + 2.5 * pin.normal - pin.contact_mm).norm(), 0, 1e-9);
    }
  }
}

TEST(Stances, do_not_move_closed_fingers_in_the_part_frame) {
  const model::Design design = shifted_design();
  const model::Kit on = kit();
  const FingerSet first = fingers_of(design, {&on, Side::Above, true}, 0);
  for (const Stance& stance : stances_of(design, on)) {
    const FingerSet there = fingers_of(moved(design, on, stance), {&on, Side::Above, true}, 0);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR((there.pins[i].closed_mm - first.pins[i].closed_mm).norm(), 0, 1e-9);
  }
}

}  // namespace
}  // namespace pinjaw::planner

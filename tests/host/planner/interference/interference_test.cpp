#include "host/planner/interference/interference.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/host/planner/interference/test_designs.hpp"

namespace pinjaw::planner {
namespace {

using model::Side;
using testing::design_of;
using testing::Grip;
using testing::kit;
using testing::random_design;

constexpr double kPartHeight_mm = 40;
constexpr double kQuarter = std::numbers::pi / 2;

const model::Kit& shared_kit() {
  static const model::Kit kKit = kit();
  return kKit;
}

/// A gripper from below: the part stands on z = 0.
FingerSet below(const Grip& grip, bool grips = true) {
  return fingers_of(design_of(grip), {&shared_kit(), Side::Below, grips}, 0);
}

/// A gripper from above: it sees the part turned, from -40 to 0.
FingerSet above(Grip grip) {
  grip.part_low_mm = -kPartHeight_mm;
  return fingers_of(design_of(grip), {&shared_kit(), Side::Above, true}, -kPartHeight_mm);
}

TEST(Fingers, from_below_stand_where_the_gripper_has_them) {
  const FingerSet set = below({.part_pose = {0, {3, 4}}});
  EXPECT_EQ(set.pin_count, 4);
  EXPECT_NEAR((set.pins[0].closed_mm - Vector2d(-15.5, -14)).norm(), 0, 1e-12);
  EXPECT_NEAR((set.pins[0].open_mm - Vector2d(-28, -14)).norm(), 0, 1e-12);
  EXPECT_EQ(set.pins[0].z_mm, (Interval{-2, 15}));
  EXPECT_EQ(set.plate_count, 2);
  EXPECT_EQ(set.plates_z_mm, (Interval{-12, -2}));
  EXPECT_NEAR((set.plates[1].closed.center_mm - Vector2d(7.5 + 15 - 3, -4)).norm(), 0, 1e-12);
  EXPECT_NEAR((set.plates[1].opening_mm - Vector2d(12.5, 0)).norm(), 0, 1e-12);
  EXPECT_FALSE(set.floor_z_mm);
}

TEST(Fingers, bodies_move_with_their_plates) {
  model::Kit kit = shared_kit();
  kit.jaws.bodies = {{{10, 40}, {-8, 2}, {-50, -10}}};
  const FingerSet set = fingers_of(design_of({}), {&kit, Side::Below, true}, 0);
  ASSERT_EQ(set.plate_count, 4);
  EXPECT_EQ(set.plates_z_mm, (Interval{-52, -2}));
  const FingerSet plain = fingers_of(design_of({}), {&shared_kit(), Side::Below, true}, 0);
  for (const std::size_t jaw : {0U, 1U}) {
    const double outwards = jaw == 0 ? -1 : 1;
    const Vector2d inner_mm = plain.plates[jaw].closed.center_mm -
                              outwards * plain.plates[jaw].closed.half_mm.x() * Vector2d::UnitX();
    EXPECT_NEAR((set.plates[2 + jaw].closed.center_mm - inner_mm - Vector2d(outwards * 25, -3)).norm(), 0,
                1e-12);
    EXPECT_EQ(set.plates[2 + jaw].opening_mm, plain.plates[jaw].opening_mm);
    EXPECT_EQ(set.plates[2 + jaw].z_mm, (Interval{-52, -12}));
  }
}

TEST(Fingers, from_above_are_those_from_below_with_x_and_z_turned) {
  const Grip grip{.part_pose = {0.3, {3, 4}}};
  const FingerSet up = below(grip);
  const FingerSet down = above(grip);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(down.pins[i].closed_mm.x(), -up.pins[i].closed_mm.x(), 1e-12);
    EXPECT_NEAR(down.pins[i].closed_mm.y(), up.pins[i].closed_mm.y(), 1e-12);
    EXPECT_NEAR(down.pins[i].open_mm.x(), -up.pins[i].open_mm.x(), 1e-12);
    EXPECT_EQ(down.pins[i].z_mm, (Interval{25, 42}));
  }
  EXPECT_EQ(down.plates_z_mm, (Interval{42, 52}));
}

TEST(Handoff, short_pins_never_meet) {
  const auto verdict = check_handoff(below({}), above({}));
  EXPECT_TRUE(verdict.compatible());
  EXPECT_TRUE(compatible(below({}), above({})));
}

TEST(Handoff, tall_pins_in_the_same_places_meet_when_both_are_closed) {
  const FingerSet giver = below({.top_mm = 26});
  const FingerSet receiver = above({});
  const auto verdict = check_handoff(giver, receiver);
  EXPECT_EQ(verdict.failed, HandoffCheck::BothClosed);
  EXPECT_EQ(verdict.giver, (FingerName{FingerKind::Pin, 0}));
  EXPECT_EQ(verdict.receiver, (FingerName{FingerKind::Pin, 2}))
      << "the receiver's right jaw is on the giver's left";
  const auto swapped = check_handoff(receiver, giver);
  EXPECT_EQ(swapped.failed, HandoffCheck::BothClosed);
  EXPECT_EQ(swapped.receiver.index, 2);
  EXPECT_FALSE(compatible(receiver, giver));
}

TEST(Handoff, tall_pins_at_right_angles_pass_each_other) {
  const Grip along{.top_mm = 30, .separation_mm = 30};
  const Grip across{.part_pose = {kQuarter, {0, 0}}, .top_mm = 30, .separation_mm = 30};
  EXPECT_TRUE(compatible(below(along), above(across)));
}

TEST(Handoff, tips_at_one_height_pass_and_a_tenth_more_does_not) {
  EXPECT_TRUE(compatible(below({.top_mm = 24.9}), above({})));
  EXPECT_FALSE(compatible(below({.top_mm = 25.1}), above({})));
}

TEST(Handoff, a_pin_in_the_way_of_the_opening_giver_is_told_apart) {
  // The receiver stands 7 wider on each side than the giver: free when closed, in the giver's way when it
  // opens.
  const FingerSet giver = below({.top_mm = 30, .separation_mm = 15});
  const FingerSet receiver = above({.top_mm = 30, .separation_mm = 29});
  EXPECT_EQ(check_handoff(giver, receiver).failed, HandoffCheck::GiverMoves);
  EXPECT_EQ(check_handoff(receiver, giver).failed, HandoffCheck::ReceiverMoves);
  EXPECT_FALSE(compatible(giver, receiver));
}

TEST(Handoff, clearance_keeps_closed_pins_apart) {
  // Side by side, 5 and a gap apart along y: the receiver sees the part moved by as much.
  const auto at_gap = [](double gap_mm) {
    return compatible(below({.top_mm = 30}), above({.part_pose = {0, {0, 5 + gap_mm}}, .top_mm = 30}));
  };
  EXPECT_FALSE(at_gap(0.1));
  EXPECT_FALSE(at_gap(0.19));
  EXPECT_TRUE(at_gap(0.21));
}

TEST(Handoff, a_pin_that_would_reach_the_other_plate_meets_it) {
  const FingerSet giver = below({.part_pose = {kQuarter, {0, 0}}, .top_mm = 43, .separation_mm = 0});
  const FingerSet receiver = above({.top_mm = 5, .separation_mm = 0});
  const auto verdict = check_handoff(giver, receiver);
  EXPECT_EQ(verdict.failed, HandoffCheck::BothClosed);
  EXPECT_EQ(verdict.giver.kind, FingerKind::Pin);
  EXPECT_EQ(verdict.receiver.kind, FingerKind::Plate);
  EXPECT_EQ(check_handoff(receiver, giver).giver.kind, FingerKind::Plate);
}

TEST(Handoff, two_grippers_from_one_side_have_their_plates_in_each_other) {
  const auto verdict = check_handoff(below({.part_pose = {0, {0, 6}}}), below({}));
  EXPECT_EQ(verdict.failed, HandoffCheck::BothClosed);
  const FingerSet lone = below({});
  EXPECT_FALSE(compatible(lone, lone));
}

TEST(Handoff, a_pin_that_reaches_the_pallets_floor_is_incompatible) {
  const Grip beside{.part_pose = {kQuarter, {0, 0}}, .top_mm = kPartHeight_mm, .separation_mm = 30};
  const auto verdict = check_handoff(below({}, false), above(beside));
  EXPECT_EQ(verdict.failed, HandoffCheck::Floor);
  EXPECT_EQ(verdict.giver.kind, FingerKind::Floor);
  EXPECT_EQ(verdict.receiver, (FingerName{FingerKind::Pin, 0}));
  Grip shorter = beside;
  shorter.top_mm = kPartHeight_mm - 0.1;
  EXPECT_TRUE(compatible(below({}, false), above(shorter)));
  EXPECT_EQ(check_handoff(above(beside), below({}, false)).giver.kind, FingerKind::Pin);
}

TEST(Handoff, a_pallet_never_opens) {
  const Grip narrow{.top_mm = 30, .separation_mm = 15};
  const FingerSet arm = above({.part_pose = {0, {0, 0}}, .top_mm = 30, .separation_mm = 38});
  EXPECT_EQ(check_handoff(below(narrow), arm).failed, HandoffCheck::GiverMoves);
  EXPECT_TRUE(compatible(below(narrow, false), arm));
  EXPECT_EQ(below(narrow, false).plate_count, 0);
}

FingerSet random_below(base::Random& random) {
  return fingers_of(random_design(random, 0, kPartHeight_mm), {&shared_kit(), Side::Below, true}, 0);
}
FingerSet random_above(base::Random& random) {
  return fingers_of(random_design(random, -kPartHeight_mm, kPartHeight_mm),
                    {&shared_kit(), Side::Above, true}, -kPartHeight_mm);
}

TEST(HandoffLaws, the_quick_answer_is_the_full_one_and_does_not_depend_on_who_gives) {
  base::Random random(41);
  int fits = 0;
  for (int i = 0; i < 3000; ++i) {
    const FingerSet a = random_below(random);
    const FingerSet b = random_above(random);
    const bool ok = compatible(a, b);
    EXPECT_EQ(ok, compatible(b, a));
    const auto forth = check_handoff(a, b);
    const auto back = check_handoff(b, a);
    EXPECT_EQ(ok, forth.compatible());
    EXPECT_EQ(ok, back.compatible());
    if (forth.failed == HandoffCheck::BothClosed) {
      EXPECT_EQ(back.failed, HandoffCheck::BothClosed);
    }
    fits += ok ? 1 : 0;
  }
  EXPECT_GT(fits, 300);
  EXPECT_LT(fits, 2700);
}

void move(FingerSet& set, const geometry::Pose2& by) {
  for (Finger& pin : set.pins) {
    pin.closed_mm = by * pin.closed_mm;
    pin.open_mm = by * pin.open_mm;
  }
  for (Plate& plate : set.plates) {
    plate.closed.center_mm = by * plate.closed.center_mm;
    plate.closed.direction = by.turned(plate.closed.direction);
    plate.opening_mm = by.turned(plate.opening_mm);
  }
}

TEST(HandoffLaws, moving_both_grippers_together_changes_nothing) {
  base::Random random(42);
  for (int i = 0; i < 1000; ++i) {
    FingerSet a = random_below(random);
    FingerSet b = random_above(random);
    const auto before = check_handoff(a, b);
    const geometry::Pose2 by{random.uniform(-3, 3), {random.uniform(-50, 50), random.uniform(-50, 50)}};
    move(a, by);
    move(b, by);
    const auto after = check_handoff(a, b);
    EXPECT_EQ(before.failed, after.failed) << i;
    if (!before.compatible()) {
      EXPECT_EQ(before.giver, after.giver);
    }
  }
}

/// Where a gripper stands: how far open (0 to 1) and how far gone along z.
struct Instant {
  double open = 0;
  double gone_mm = 0;
};

bool pins_overlap_at(const FingerSet& a, const Instant& at_a, const FingerSet& b, double reach_mm) {
  const double sign = a.side == Side::Below ? -1 : 1;
  for (int i = 0; i < a.pin_count; ++i) {
    const Finger& p = a.pins[static_cast<std::size_t>(i)];
    const Vector2d place = p.closed_mm + at_a.open * (p.open_mm - p.closed_mm);
    const Interval z{p.z_mm.lo + sign * at_a.gone_mm, p.z_mm.hi + sign * at_a.gone_mm};
    for (int j = 0; j < b.pin_count; ++j) {
      const Finger& q = b.pins[static_cast<std::size_t>(j)];
      if ((place - q.closed_mm).norm() < reach_mm && z.lo < q.z_mm.hi && q.z_mm.lo < z.hi) return true;
    }
  }
  return false;
}

bool ever_overlap(const FingerSet& a, const FingerSet& b, double reach_mm) {
  for (int step = 0; step <= 400; ++step) {
    if (pins_overlap_at(a, {step / 400.0, 0}, b, reach_mm)) return true;
    if (pins_overlap_at(a, {1, step * 0.25}, b, reach_mm)) return true;
  }
  return false;
}

TEST(HandoffLaws, agrees_with_dense_samples_in_time_and_space) {
  base::Random random(43);
  const double reach_mm = 2 * 2.5 + 0.2;
  int clashes = 0;
  for (int i = 0; i < 400; ++i) {
    const FingerSet a = random_below(random);
    const FingerSet b = random_above(random);
    if (compatible(a, b)) {
      EXPECT_FALSE(ever_overlap(a, b, reach_mm - 1e-6) || ever_overlap(b, a, reach_mm - 1e-6)) << i;
    } else {
      ++clashes;
      EXPECT_TRUE(ever_overlap(a, b, reach_mm + 1e-3) || ever_overlap(b, a, reach_mm + 1e-3)) << i;
    }
  }
  EXPECT_GT(clashes, 40);
}

TEST(HandoffChecks, each_has_its_own_name) {
  for (const HandoffCheck a : kHandoffChecks) {
    EXPECT_NE(to_string(a), "?");
    for (const HandoffCheck b : kHandoffChecks) {
      if (a != b) {
        EXPECT_NE(to_string(a), to_string(b));
      }
    }
  }
}

}  // namespace
}  // namespace pinjaw::planner

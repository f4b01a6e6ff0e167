#include "host/cell/hold.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "host/base/random.hpp"

namespace pinjaw::cell {
namespace {

using geometry::Interval;
using geometry::Pose2;
using model::Side;
using planner::Adjustment;
using planner::Hold;

constexpr double kPi = std::numbers::pi;

Hold random_hold(base::Random& random, Side side) {
  return {side, {random.uniform(-3, 3), {random.uniform(-20, 20), random.uniform(-20, 20)}}};
}

Interval random_range(base::Random& random, double most) {
  if (random.uniform() < 0.3) return {0, 0};
  const double middle = random.uniform(-0.3, 0.3) * most;
  const double half = random.uniform(0, 0.7) * most;
  return {middle - half, middle + half};
}

model::Adjust random_bounds(base::Random& random) {
  model::Adjust bounds{random_range(random, 15), random_range(random, 15), random_range(random, kPi)};
  if (random.uniform() < 0.3) bounds.theta_rad = {-kPi, kPi};
  return bounds;
}

model::Adjust widened(model::Adjust bounds, double by) {
  for (Interval* range : {&bounds.x_mm, &bounds.y_mm}) *range = {range->lo - 20 * by, range->hi + 20 * by};
  bounds.theta_rad = {bounds.theta_rad.lo - by, bounds.theta_rad.hi + by};
  return bounds;
}

bool in_both(const Interval& a, const Interval& b, double between) {
  return std::max(a.lo, b.lo - between) <= std::min(a.hi, b.hi - between) + 1e-6;
}

/// Turns of the giver in small steps, its offset wherever it suits the receiver's.
bool sampled(const Hold& giver, const model::Adjust& gives, const Hold& receiver,
             const model::Adjust& receives, int steps) {
  for (int i = 0; i <= steps; ++i) {
    const double theta_rad = gives.theta_rad.lo + i * gives.theta_rad.length() / steps;
    const Adjustment there = planner::required_adjustment(giver, {theta_rad, {0, 0}}, receiver);
    const model::Adjust turn_only{{-1e9, 1e9}, {-1e9, 1e9}, receives.theta_rad};
    if (!planner::within(there, turn_only)) continue;
    // Moving the giver by x, y in its own frame moves the receiver as much, mirrored between the sides.
    const double sign = giver.side == receiver.side ? 1 : -1;
    const Interval x_mm = sign > 0 ? receives.x_mm : Interval{-receives.x_mm.hi, -receives.x_mm.lo};
    if (in_both(gives.x_mm, x_mm, sign * there.offset_mm.x()) &&
        in_both(gives.y_mm, receives.y_mm, there.offset_mm.y())) {
      return true;
    }
  }
  return false;
}

bool answer(const Hold& giver, const model::Adjust& gives, const Hold& receiver,
            const model::Adjust& receives) {
  return adjustable(PlanHold(giver), PlanBounds(giver.side, gives), PlanHold(receiver),
                    PlanBounds(receiver.side, receives));
}

TEST(Adjustable, with_nothing_free_only_equal_holds_are) {
  const Hold hold{Side::Below, {0.3, {1, 2}}};
  EXPECT_TRUE(answer(hold, {}, hold, {}));
  EXPECT_TRUE(answer(hold, {}, {Side::Below, {0.3 - 2 * kPi, {1, 2}}}, {})) << "a whole turn is none";
  EXPECT_FALSE(answer(hold, {}, {Side::Below, {0.3, {1, 2.01}}}, {}));
  EXPECT_FALSE(answer(hold, {}, {Side::Below, {0.301, {1, 2}}}, {}));
}

TEST(Adjustable, agrees_with_turning_in_small_steps) {
  base::Random random(61);
  int can = 0;
  for (int i = 0; i < 1500; ++i) {
    const Hold giver = random_hold(random, i % 2 == 0 ? Side::Below : Side::Above);
    const Hold receiver = random_hold(random, i % 4 < 2 ? Side::Below : Side::Above);
    const model::Adjust gives = random_bounds(random);
    const model::Adjust receives = random_bounds(random);
    const bool ours = answer(giver, gives, receiver, receives);
    EXPECT_EQ(ours, answer(receiver, receives, giver, gives)) << i;
    constexpr int kSteps = 1500;
    constexpr double kStep_rad = 2 * kPi / kSteps;
    if (ours) {
      ++can;
      EXPECT_TRUE(sampled(giver, widened(gives, kStep_rad), receiver, widened(receives, kStep_rad), kSteps))
          << i;
    } else {
      EXPECT_FALSE(sampled(giver, gives, receiver, receives, kSteps)) << i;
    }
  }
  EXPECT_GT(can, 200);
  EXPECT_LT(can, 1200);
}

TEST(References, are_the_stations_that_may_turn_and_move_least) {
  const std::array bounds{PlanBounds(Side::Above, {{0, 0}, {0, 0}, {-kPi, kPi}}),
                          PlanBounds(Side::Below, {{-20, 20}, {-20, 20}, {0, 0}}),
                          PlanBounds(Side::Below, {{-20, 20}, {-20, 20}, {-kPi, kPi}})};
  const References references = references_of(bounds);
  EXPECT_EQ(references.theta, 1U);
  EXPECT_EQ(references.offset, 0U);
}

TEST(PartPlace, asks_each_station_for_the_adjustment_that_phase_6_asks_for) {
  base::Random random(62);
  int in_reach = 0;
  for (int i = 0; i < 2000; ++i) {
    const Hold theta = random_hold(random, i % 2 == 0 ? Side::Below : Side::Above);
    const Hold offset = random_hold(random, i % 4 < 2 ? Side::Below : Side::Above);
    const Hold other = random_hold(random, i % 8 < 4 ? Side::Below : Side::Above);
    const model::Adjust bounds = random_bounds(random);
    const Pose2 X_HP = part_in_handoff_frame(PlanHold(theta), PlanBounds(theta.side, {}), PlanHold(offset),
                                             PlanBounds(offset.side, {}));
    const Adjustment of_theta = adjustment_for(PlanHold(theta), theta.side, X_HP);
    const Adjustment of_offset = adjustment_for(PlanHold(offset), offset.side, X_HP);
    EXPECT_NEAR(of_theta.theta_rad, 0, 1e-9);
    EXPECT_NEAR(of_offset.offset_mm.norm(), 0, 1e-9);
    const Adjustment ours = adjustment_for(PlanHold(other), other.side, X_HP);
    const Adjustment needed = planner::required_adjustment(offset, of_offset, other);
    EXPECT_NEAR(std::remainder(ours.theta_rad - needed.theta_rad, 2 * kPi), 0, 1e-9);
    EXPECT_NEAR((ours.offset_mm - needed.offset_mm).norm(), 0, 1e-8);
    const bool reached = reaches(PlanHold(other), PlanBounds(other.side, bounds), PartPlace(X_HP));
    EXPECT_EQ(reached, planner::within(needed, bounds));
    in_reach += reached ? 1 : 0;
  }
  EXPECT_GT(in_reach, 20);
}

TEST(TurnsInReach, is_what_turning_in_small_steps_finds) {
  base::Random random(63);
  std::array<int, 3> seen{};
  for (int i = 0; i < 600; ++i) {
    const Hold offset{Side::Above, {random.uniform(-3, 3), {random.uniform(-9, 9), random.uniform(-9, 9)}}};
    const Hold other{Side::Below, {random.uniform(-3, 3), {random.uniform(-9, 9), random.uniform(-9, 9)}}};
    model::Adjust bounds = random_bounds(random);
    bounds.theta_rad = {-kPi, kPi};
    const PlanBounds stands(Side::Above, {{0, 0}, {0, 0}, {-kPi, kPi}});
    const PlanBounds moves(Side::Below, bounds);
    int reached = 0;
    constexpr int kSteps = 360;
    for (int step = 0; step < kSteps; ++step) {
      const Hold turned{Side::Below, {step * 2 * kPi / kSteps, {0, 0}}};
      const PlanBounds fixed(Side::Below, {});
      const PartPlace place(part_in_handoff_frame(PlanHold(turned), fixed, PlanHold(offset), stands));
      reached += reaches(PlanHold(other), moves, place) ? 1 : 0;
    }
    const TurnsInReach turns = turns_in_reach(PlanHold(other), moves, PlanHold(offset), stands);
    ++seen[static_cast<std::size_t>(turns)];
    if (turns == TurnsInReach::None) {
      EXPECT_EQ(reached, 0) << i;
    }
    if (turns == TurnsInReach::All) {
      EXPECT_EQ(reached, kSteps) << i;
    }
  }
  EXPECT_GT(*std::ranges::min_element(seen), 10);
}

}  // namespace
}  // namespace pinjaw::cell

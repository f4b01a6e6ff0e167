// Promises: SLIP.
/// The planner says what squeeze the present disturbance needs; the world lets the part go exactly where the
/// true squeeze is less. Slip and fall are recomputed here.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/firmware_sim/support/test_cell.hpp"

namespace pinjaw::test {
namespace {

constexpr double kGravity_mm_s2 = 9806.65;
constexpr double kLost_mm = 2.0;

/// One gripper that holds the part with all valves shut.
std::unique_ptr<TestCell> holding(std::uint64_t seed) {
  auto cell = std::make_unique<TestCell>(std::vector<TestGrip>{{.node = 1, .needed_n = 60}}, seed);
  EXPECT_TRUE(cell->commission());
  EXPECT_TRUE(cell->load(1));
  cell->run_ms(500);
  return cell;
}

void disturb(TestCell& cell, double needed_n) {
  EXPECT_TRUE(std::holds_alternative<bench::Done>(cell.ask(bench::Disturb{"push", {{1, needed_n}}})));
}

/// How far a part slides in `time_s` whose holder gives `share` of what it needs.
double slid_mm(double share, double time_s) {
  return kGravity_mm_s2 * (1 - share) * time_s * time_s / 2;
}

TEST(Slip, the_part_stays_where_the_squeeze_is_what_the_disturbance_needs_and_falls_where_it_is_less) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const double excess : {-0.5, -0.1, -0.01, -0.001, 0.001, 0.01, 0.1, 0.5, 3.0}) {
      const auto owner = holding(seed);
      TestCell& cell = *owner;
      const double squeeze_n = cell.truth_of(1).squeeze_n;
      disturb(cell, squeeze_n * (1 + excess));
      const double share = 1 / (1 + excess);
      const double fall_s = std::sqrt(2 * kLost_mm / (kGravity_mm_s2 * std::max(1 - share, 1e-9)));
      const int from_ms = cell.now_ms();
      cell.run_until([&] { return cell.truth().dropped; }, 3000);
      EXPECT_EQ(cell.truth().dropped, excess > 0) << seed << ' ' << excess;
      EXPECT_EQ(cell.truth().slipped, excess > 0) << seed << ' ' << excess;
      if (excess > 0) {
        EXPECT_NEAR((cell.now_ms() - from_ms) * 1e-3, fall_s, 0.003 + 0.02 * fall_s) << excess;
      }
    }
  }
}

TEST(Slip, a_push_that_ends_before_the_part_has_fallen_leaves_it_where_it_slid_to) {
  for (const int push_ms : {5, 10, 20, 30}) {
    const auto owner = holding(3);
    TestCell& cell = *owner;
    const double squeeze_n = cell.truth_of(1).squeeze_n;
    disturb(cell, squeeze_n * 1.25);
    cell.run_ms(push_ms);
    disturb(cell, squeeze_n * 0.5);
    cell.run_ms(1000);
    EXPECT_FALSE(cell.truth().dropped);
    EXPECT_TRUE(cell.truth().slipped);
    const double step_mm = kGravity_mm_s2 * 0.2 * push_ms * 1e-6;  // of one millisecond at the end's speed
    EXPECT_NEAR(cell.truth().slip_mm, slid_mm(0.8, push_ms * 1e-3), step_mm);
  }
}

TEST(Slip, what_the_disturbance_needs_may_change_any_time_and_counts_at_once) {
  const auto owner = holding(4);
  TestCell& cell = *owner;
  const double squeeze_n = cell.truth_of(1).squeeze_n;
  for (int i = 0; i < 50; ++i) {
    disturb(cell, squeeze_n * (i % 2 == 0 ? 0.3 : 0.999));
    cell.run_ms(20);
  }
  EXPECT_FALSE(cell.truth().slipped);
  disturb(cell, squeeze_n * 1.001);
  cell.run_ms(1);
  EXPECT_TRUE(cell.truth().slipped);
}

/// Two grippers that both hold the part: the giver lost its power, the receiver waits for its word.
std::unique_ptr<TestCell> held_by_two() {
  auto cell = std::make_unique<TestCell>(arm_pedestal_pallet());
  EXPECT_TRUE(cell->commission());
  EXPECT_TRUE(cell->load(1));
  cell->ask(bench::Meet{{1, 2}});
  cell->command(1, wire::offer_command(2));
  cell->run_ms(100);
  cell->command(2, wire::accept_command(1));
  EXPECT_TRUE(cell->wait_for(2, wire::State::Seated, 3000));
  EXPECT_TRUE(cell->squeeze(2));
  EXPECT_TRUE(cell->wait_for(2, wire::State::Taken, 3000));
  cell->ask(bench::Power{1, false});
  cell->run_ms(500);
  return cell;
}

TEST(Slip, of_two_that_hold_it_one_that_would_alone_is_enough) {
  for (const bool giver : {false, true}) {
    for (const bool receiver : {false, true}) {
      const auto owner = held_by_two();
      TestCell& cell = *owner;
      EXPECT_EQ(cell.truth().holders, (std::vector<int>{1, 2}));
      const double of_giver_n = cell.truth_of(1).squeeze_n * (giver ? 0.99 : 1.01);
      const double of_receiver_n = cell.truth_of(2).squeeze_n * (receiver ? 0.99 : 1.01);
      cell.ask(bench::Disturb{"push", {{1, of_giver_n}, {2, of_receiver_n}}});
      cell.run_ms(1000);
      EXPECT_EQ(cell.truth().dropped, !giver && !receiver);
      EXPECT_EQ(cell.truth().slipped, !giver && !receiver);
    }
  }
}

}  // namespace
}  // namespace pinjaw::test

// Promises: I2.
// Whole handoffs: firmware, air, bus and world together, by a host that only speaks frames.
#include <gtest/gtest.h>

#include "tests/firmware_sim/support/test_cell.hpp"

namespace pinjaw::world {
namespace {

using test::TestCell;

TEST(Handoff, a_pallet_gives_the_part_to_an_arm) {
  TestCell cell(test::arm_pedestal_pallet());
  ASSERT_TRUE(cell.commission()) << cell.event_log();
  ASSERT_TRUE(cell.load(3)) << cell.event_log();
  ASSERT_TRUE(cell.hand_over(3, 1)) << cell.event_log();
  EXPECT_EQ(cell.ask(bench::Move{.node = 1, .seconds = 2}).index(), 0U);
  cell.run_ms(100);
  EXPECT_EQ(cell.truth().holders, std::vector{1});
  EXPECT_EQ(cell.truth().min_holders, 1);
  EXPECT_FALSE(cell.truth().slipped);
}

TEST(Handoff, two_grippers_hand_the_part_over_and_back) {
  TestCell cell(test::arm_pedestal_pallet());
  ASSERT_TRUE(cell.commission());
  ASSERT_TRUE(cell.load(1)) << cell.event_log();
  ASSERT_TRUE(cell.hand_over(1, 2)) << cell.event_log();
  EXPECT_EQ(cell.truth().holders, std::vector{2});
  ASSERT_TRUE(cell.hand_over(2, 1)) << cell.event_log();
  EXPECT_EQ(cell.truth().holders, std::vector{1});
  ASSERT_TRUE(cell.hand_over(1, 3)) << cell.event_log();
  EXPECT_EQ(cell.truth().holders, std::vector{3});
  EXPECT_EQ(cell.truth().min_holders, 1);
  EXPECT_FALSE(cell.truth().dropped);
  EXPECT_FALSE(cell.truth().slipped);
  for (const bench::NodeTruth& node : cell.truth().nodes) {
    EXPECT_LE(node.max_steady_n, node.limit_n);
  }
}

TEST(Handoff, a_take_lasts_as_long_as_real_grippers_need) {
  TestCell cell(test::arm_pedestal_pallet());
  ASSERT_TRUE(cell.commission());
  ASSERT_TRUE(cell.load(1));
  ASSERT_EQ(cell.ask(bench::Meet{{1, 2}}).index(), 0U);
  cell.command(1, wire::offer_command(2));
  cell.run_ms(100);
  cell.command(2, wire::accept_command(1));
  const int accepted_ms = cell.now_ms();
  ASSERT_TRUE(cell.wait_for(2, wire::State::Seated, 3000));
  const int seated_ms = cell.now_ms();
  ASSERT_TRUE(cell.squeeze(2));
  ASSERT_TRUE(cell.wait_for(2, wire::State::Taken, 3000));
  const int taken_ms = cell.now_ms();
  // The study: approach 0.2 to 0.4 s for 4 mm a jaw, TAKE after 0.6 to 0.8 s; here each jaw travels 12 mm.
  EXPECT_GT(seated_ms - accepted_ms, 100);
  EXPECT_LT(seated_ms - accepted_ms, 900);
  EXPECT_LT(taken_ms - seated_ms, 700);
  EXPECT_LT(taken_ms - accepted_ms, 1500);
}

TEST(Handoff, an_arm_that_grips_with_another_cannot_travel) {
  TestCell cell(test::arm_pedestal_pallet());
  ASSERT_TRUE(cell.commission());
  ASSERT_TRUE(cell.load(1));
  cell.ask(bench::Meet{{1, 2}});
  cell.command(1, wire::offer_command(2));
  cell.run_ms(100);
  cell.command(2, wire::accept_command(1));
  ASSERT_TRUE(cell.wait_for(2, wire::State::Seated, 3000));
  EXPECT_EQ(cell.ask(bench::Move{.node = 1}).index(), 1U);
  EXPECT_EQ(cell.ask(bench::Meet{{1}}).index(), 1U);
}

/// Runs the handoff with a host that dies at `at_ms`, then waits; gives what the world saw.
bench::Truth after_the_host_dies(int at_ms, int& ended_ms) {
  TestCell cell(test::arm_pedestal_pallet());
  cell.kill_host_at(at_ms);
  try {
    if (!cell.commission() || !cell.load(1)) return {};
    cell.hand_over(1, 2);
    ended_ms = cell.now_ms();
    return cell.truth();
  } catch (const test::HostKilled&) {
    cell.run_ms(2500);
  }
  return cell.truth();
}

TEST(Handoff, a_host_that_dies_anywhere_leaves_the_part_held) {
  TestCell sound(test::arm_pedestal_pallet());
  ASSERT_TRUE(sound.commission());
  ASSERT_TRUE(sound.load(1));
  const int first_ms = sound.now_ms();
  ASSERT_TRUE(sound.hand_over(1, 2));
  const int last_ms = sound.now_ms();
  for (int at_ms = first_ms + 1; at_ms < last_ms; at_ms += 20) {
    int ended_ms = 0;
    const bench::Truth truth = after_the_host_dies(at_ms, ended_ms);
    EXPECT_TRUE(truth.placed) << at_ms;
    EXPECT_FALSE(truth.dropped) << at_ms;
    EXPECT_FALSE(truth.slipped) << at_ms;
    EXPECT_GE(truth.min_holders.value_or(0), 1) << at_ms;
  }
}

TEST(Handoff, one_seed_gives_one_log_to_the_byte) {
  const auto logs = [](std::uint64_t seed) {
    TestCell cell(test::arm_pedestal_pallet(), seed);
    EXPECT_TRUE(cell.commission());
    EXPECT_TRUE(cell.load(1));
    EXPECT_TRUE(cell.hand_over(1, 2));
    return cell.frame_log() + cell.event_log();
  };
  const std::string first = logs(1);
  EXPECT_EQ(first, logs(1));
  EXPECT_NE(first, logs(2));
}

}  // namespace
}  // namespace pinjaw::world

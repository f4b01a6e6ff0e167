// Promises: I1.
// Invariant I1: what the guard promises of the true force, and that it is the guard that keeps it.
#include <gtest/gtest.h>

#include "tests/firmware_sim/support/test_cell.hpp"

namespace pinjaw::node {
namespace {

using test::TestCell;
using test::TestGrip;

/// One gripper whose layout limits the squeeze to `limit_n`; its guard on or off.
std::unique_ptr<TestCell> one_gripper(double needed_n, double limit_n, bool guarded, std::uint64_t seed = 1) {
  auto cell = std::make_unique<TestCell>(
      std::vector<TestGrip>{{.node = 1, .separation_mm = 30, .needed_n = needed_n, .limit_n = limit_n}},
      seed);
  Node& node = *cell->world().find(1);
  node.config_for_tests().force_guard_enabled = guarded;
  node.set_power(false);
  node.set_power(true);
  return cell;
}

TEST(ForceLimit, a_hold_needs_its_squeeze_and_stays_under_the_limit) {
  for (const double needed_n : {24.0, 60.0, 100.0, 113.0}) {
    const auto owner = one_gripper(needed_n, 140, true);
    TestCell& cell = *owner;
    ASSERT_TRUE(cell.commission()) << needed_n;
    ASSERT_TRUE(cell.load(1)) << needed_n;
    cell.run_ms(2000);
    const bench::NodeTruth& truth = cell.truth_of(1);
    EXPECT_GE(truth.squeeze_n, needed_n);
    EXPECT_LE(truth.max_steady_n, 140) << needed_n;
    EXPECT_LE(truth.max_squeeze_n, 1.05 * 140) << needed_n;
    EXPECT_LE(truth.over_limit_s, 0.020) << needed_n;
  }
}

TEST(ForceLimit, holds_for_every_specimen_of_sensors_and_regulator) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto owner = one_gripper(73, 100, true, seed);
    TestCell& cell = *owner;
    ASSERT_TRUE(cell.commission()) << seed;
    ASSERT_TRUE(cell.load(1)) << seed;
    cell.run_ms(500);
    const bench::NodeTruth& truth = cell.truth_of(1);
    EXPECT_GE(truth.squeeze_n, 73) << seed;
    EXPECT_LE(truth.max_steady_n, 100) << seed;
    EXPECT_LE(truth.max_squeeze_n, 105) << seed;
  }
}

/// A regulator that sticks open while the part is squeezed.
bench::NodeTruth with_open_regulator(bool guarded) {
  const auto owner = one_gripper(60, 100, guarded);
  TestCell& cell = *owner;
  EXPECT_TRUE(cell.commission());
  EXPECT_TRUE(std::holds_alternative<bench::Done>(
      cell.ask(bench::Place{1, {{.node = 1, .separation_mm = 30, .needed_n = 60}}})));
  cell.ask(bench::Enable{1, true});
  cell.run_ms(50);
  cell.command(1, wire::plain_command(wire::Op::CloseLight));
  EXPECT_TRUE(cell.wait_for(1, wire::State::Seated, 3000));
  EXPECT_TRUE(cell.squeeze(1));
  cell.run_ms(60);
  cell.ask(bench::Break{1, "regulator_open"});
  cell.run_ms(2000);
  return cell.truth_of(1);
}

TEST(ForceLimit, a_regulator_stuck_open_does_not_break_it) {
  const bench::NodeTruth truth = with_open_regulator(true);
  EXPECT_LE(truth.max_steady_n, 100);
  EXPECT_LE(truth.max_squeeze_n, 105);
}

TEST(ForceLimit, without_the_guard_a_regulator_stuck_open_breaks_it) {
  const bench::NodeTruth truth = with_open_regulator(false);
  EXPECT_GT(truth.max_steady_n, 105);
}

TEST(ForceLimit, a_squeeze_over_the_limit_is_refused) {
  const auto owner = one_gripper(60, 100, true);
  TestCell& cell = *owner;
  ASSERT_TRUE(cell.commission());
  cell.ask(bench::Place{1, {{.node = 1, .separation_mm = 30, .needed_n = 60}}});
  cell.ask(bench::Enable{1, true});
  cell.run_ms(50);
  cell.command(1, wire::plain_command(wire::Op::CloseLight));
  ASSERT_TRUE(cell.wait_for(1, wire::State::Seated, 3000));
  const wire::Acknowledge answer =
      cell.command(1, wire::squeeze_command({.set_dn = 1200, .permit_dn = 1400}));
  EXPECT_EQ(answer.result, wire::CommandResult::Limit);
  cell.run_ms(500);
  EXPECT_LT(cell.truth_of(1).max_squeeze_n, 40);
}

}  // namespace
}  // namespace pinjaw::node

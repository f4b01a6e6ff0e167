// All that can happen to nodes that hand a part to each other, by the compiled core: an adversarial host and
// network, power cuts at any moment, timers that run out whenever it suits.
//
// Promises: I2, I2b, I2c, R1, R6.
#include <gtest/gtest.h>

#include "tests/firmware_sim/model_check/report.hpp"
#include "tests/firmware_sim/model_check/search.hpp"

namespace pinjaw::core::model {
namespace {

struct Expected {
  std::size_t states = 0;  ///< at least
  bool complete = true;    ///< nothing is left out below the bound on tokens
  Bounds bounds{};
};

void expect_all_kept(const std::string& name, const Scenario& scenario, const Expected& expected) {
  const Findings findings = search(scenario, expected.bounds);
  EXPECT_FALSE(findings.violation) << trace_of(findings);
  EXPECT_EQ(findings.complete, expected.complete);
  EXPECT_GE(findings.states, expected.states);
  if (expected.complete) {
    EXPECT_GT(findings.resting, 1000U) << "I2c was not looked at";
  }
  state_figures(name, findings);
}

TEST(ModelCheck, a_pallet_and_a_gripper_never_drop_the_part_nor_lose_the_way_back) {
  expect_all_kept("pallet and arm, 1 token", {.nodes = {kArm, kPallet}, .loaded = kPallet},
                  {.states = 100'000});
}

TEST(NightlyModelCheck, nor_do_two_grippers) {
  expect_all_kept("arm and pedestal, 1 token", {.nodes = {kArm, kPedestal}, .loaded = kArm},
                  {.states = 100'000});
}

TEST(NightlyModelCheck, nor_do_two_grippers_that_try_twice_each) {
  expect_all_kept("arm and pedestal, 2 tokens", {.nodes = {kArm, kPedestal}, .loaded = kArm, .tokens = 2},
                  {.states = 300'000, .bounds = {.merge_equals = true, .progress = true}});
}

TEST(NightlyModelCheck, nor_do_three_stations) {
  expect_all_kept(
      "arm, pedestal and pallet, 1 token each", {.nodes = {kArm, kPedestal, kPallet}, .loaded = kPallet},
      {.states = 1'000'000, .bounds = {.most_states = 60'000'000, .merge_equals = true, .progress = true}});
}

/// The same without a merger of states, so that nothing rests on it.
TEST(NightlyModelCheck, nor_do_three_stations_state_by_state_as_far_as_the_search_goes) {
  expect_all_kept(
      "arm, pedestal and pallet, 1 token each, no state merged, nearest states",
      {.nodes = {kArm, kPedestal, kPallet}, .loaded = kPallet},
      {.states = 12'000'000, .complete = false, .bounds = {.most_states = 12'000'000, .progress = true}});
}

/// What the merger is worth: the plain search and the merged one come to the same verdicts.
TEST(NightlyModelCheck, states_that_nobody_can_tell_apart_may_count_as_one) {
  const Scenario scenario{.nodes = {kArm, kPallet}, .loaded = kPallet};
  const Findings plain = search(scenario, {});
  const Findings merged = search(scenario, {.merge_equals = true});
  EXPECT_TRUE(plain.complete && merged.complete);
  EXPECT_FALSE(plain.violation || merged.violation);
  EXPECT_LT(8 * merged.states, plain.states);
  EXPECT_GT(merged.resting, 0U);
}

}  // namespace
}  // namespace pinjaw::core::model

// All that can happen to two nodes with one token each, by the compiled core: an adversarial host and
// network, power cuts at any moment, timers that run out whenever it suits. Nothing is left out below these
// bounds. Promises: I2, I2b, I2c, R1, R6.
#include <gtest/gtest.h>

#include "tests/firmware_sim/model_check/report.hpp"
#include "tests/firmware_sim/model_check/search.hpp"

namespace pinjaw::core::model {
namespace {

void expect_all_kept(const std::string& name, const Cell& cell) {
  const Findings findings = search(cell, {});
  EXPECT_FALSE(findings.violation) << trace_of(findings);
  EXPECT_TRUE(findings.complete);
  EXPECT_GT(findings.states, 100'000U);
  EXPECT_GT(findings.resting, 1000U);
  state_figures(name, findings);
}

TEST(ModelCheck, two_grippers_never_drop_the_part_nor_lose_the_way_back) {
  expect_all_kept("arm and pedestal, 1 token", {.nodes = {kArm, kPedestal}, .loaded = kArm});
}

TEST(ModelCheck, nor_do_a_passive_pallet_and_a_gripper) {
  expect_all_kept("pallet and arm, 1 token", {.nodes = {kArm, kPallet}, .loaded = kPallet});
}

}  // namespace
}  // namespace pinjaw::core::model

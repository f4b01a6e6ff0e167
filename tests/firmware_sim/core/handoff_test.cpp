// Promises: I2, R2, R4, R8.
#include <gtest/gtest.h>

#include "tests/firmware_sim/core/bench.hpp"

namespace pinjaw::core::test {
namespace {

using wire::CommandResult;

/// Something truly holds the part: a jaw with what it needs, or the pallet under it.
bool truly_held(Bench& bench) {
  const bool by_jaw = bench.arm().jaw.squeeze_dn() >= 400 || bench.pedestal().jaw.squeeze_dn() >= 400;
  const bool by_pallet = bench.pallet().jaw.part_on_seats && holds(bench.pallet().id());
  return by_jaw || by_pallet;
}

TEST(Handoff, operator_loads_the_pallet_and_it_holds) {
  Bench bench;
  bench.load_all();
  ASSERT_EQ(bench.pallet().id(), StateId::Loaded);
  bench.load_pallet();
  EXPECT_EQ(bench.pallet().id(), StateId::Hold);
  bench.run(5);
  EXPECT_EQ(bench.pallet().core.announced.fact, wire::Fact::Sole);
}

TEST(Handoff, operator_loads_a_gripper_and_it_holds_within_the_limit) {
  Bench bench;
  bench.load_all();
  bench.load_gripper(kArm);
  ASSERT_EQ(bench.arm().id(), StateId::Hold);
  bench.run(500);
  EXPECT_GE(bench.arm().jaw.squeeze_dn(), 400);
  EXPECT_LE(bench.arm().jaw.squeeze_dn(), 640);
}

TEST(Handoff, goes_round_from_pallet_to_arm_to_pedestal_and_back) {
  Bench bench;
  bench.load_all();
  bench.load_pallet();
  ASSERT_EQ(bench.pallet().id(), StateId::Hold);
  int unheld_ms = 0;
  bench.after_step = [&] { unheld_ms += truly_held(bench) ? 0 : 1; };
  ASSERT_TRUE(bench.hand_over(kPallet, kArm));
  ASSERT_TRUE(bench.hand_over(kArm, kPedestal));
  ASSERT_TRUE(bench.hand_over(kPedestal, kArm));
  ASSERT_TRUE(bench.hand_over(kArm, kPallet));
  bench.run(5);
  EXPECT_EQ(unheld_ms, 0);
  EXPECT_EQ(bench.pallet().core.announced.fact, wire::Fact::Sole);
  EXPECT_EQ(bench.arm().core.announced.fact, wire::Fact::Released);
}

TEST(Handoff, never_leaves_the_part_unheld_on_a_bus_that_loses_and_repeats) {
  int done = 0;
  for (int seed = 0; seed < 10; ++seed) {
    Bench bench;
    bench.load_all();
    bench.load_gripper(kArm);
    ASSERT_EQ(bench.arm().id(), StateId::Hold);
    bench.loss_percent = 15;
    bench.duplicates = seed >= 6;  // each repeated frame costs three good ones: safe, and slow
    bench.run(seed * 7);
    bench.after_step = [&] { ASSERT_TRUE(truly_held(bench)) << "seed " << seed << " at " << bench.now_ms; };
    done += bench.hand_over(kArm, kPedestal) ? 1 : 0;
    bench.run(1000);
  }
  RecordProperty("handoffs_done", done);
  EXPECT_GE(done, 3);
}

TEST(Handoff, giver_never_relaxes_before_it_has_heard_take) {
  Bench bench;
  bench.load_all();
  bench.load_gripper(kArm);
  bench.arm_session(kPedestal);
  ASSERT_EQ(bench.result_of(kArm, wire::offer_command(kPedestal)), CommandResult::Ok);
  bench.after_step = [&] {
    if (bench.pedestal().core.announced.fact == wire::Fact::Take) return;
    ASSERT_EQ(bench.arm().id(), StateId::Offered);
    ASSERT_NE(bench.arm().outputs.valves.spool, Spool::Open);
  };
  bench.run(100);
  ASSERT_EQ(bench.result_of(kPedestal, wire::accept_command(kArm)), CommandResult::Ok);
  bench.bring_part(kPedestal, true);
  ASSERT_TRUE(bench.reaches(kPedestal, StateId::Seated));
  bench.run(2000);
  EXPECT_EQ(bench.arm().id(), StateId::Offered) << "a light squeeze is no take";
}

TEST(Handoff, giver_opens_only_after_its_decision_is_stored) {
  Bench bench;
  bench.load_all();
  bench.load_gripper(kArm);
  bench.after_step = [&] {
    if (bench.arm().outputs.valves.spool != Spool::Open) return;
    const Custody custody = bench.arm().memory.record->custody;
    ASSERT_TRUE(custody == Custody::Decided || custody == Custody::Released);
  };
  ASSERT_TRUE(bench.hand_over(kArm, kPedestal));
}

TEST(Handoff, receiver_takes_only_after_its_latch_is_stored) {
  Bench bench;
  bench.load_all();
  bench.load_gripper(kArm);
  bench.after_step = [&] {
    if (bench.pedestal().core.announced.fact != wire::Fact::Take) return;
    ASSERT_NE(bench.pedestal().memory.record->custody, Custody::Empty);
  };
  ASSERT_TRUE(bench.hand_over(kArm, kPedestal));
}

TEST(Handoff, giver_that_hears_the_receiver_fall_silent_while_relaxing_squeezes_again) {
  Bench bench;
  bench.load_all();
  bench.load_gripper(kArm);
  ASSERT_TRUE(bench.seat(kArm, kPedestal));
  ASSERT_TRUE(bench.squeeze(kPedestal));
  ASSERT_TRUE(bench.reaches(kArm, StateId::Relax));
  bench.pedestal().power_off();
  EXPECT_TRUE(bench.reaches(kArm, StateId::Resqueeze, 100));
  EXPECT_TRUE(bench.reaches(kArm, StateId::Hold));
  bench.run(50);
  EXPECT_EQ(bench.arm().core.announced.fact, wire::Fact::Retain);
  EXPECT_GE(bench.arm().jaw.squeeze_dn(), 400);
}

TEST(Handoff, aborted_offer_is_retained_and_the_receiver_lets_go_on_abort) {
  Bench bench;
  bench.load_all();
  bench.load_gripper(kArm);
  ASSERT_TRUE(bench.seat(kArm, kPedestal));
  ASSERT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::Abort)), CommandResult::Ok);
  ASSERT_EQ(bench.arm().id(), StateId::Hold);
  bench.run(100);
  ASSERT_EQ(bench.arm().core.announced.fact, wire::Fact::Retain);
  EXPECT_EQ(bench.pedestal().id(), StateId::Seated) << "it opens on the host's word, not by itself";
  ASSERT_EQ(bench.result_of(kPedestal, wire::plain_command(wire::Op::Abort)), CommandResult::Ok);
  EXPECT_EQ(bench.pedestal().id(), StateId::Ready);
  bench.run(1000);
  EXPECT_GE(bench.pedestal().jaw.separation_10um, 4900);
}

TEST(Handoff, a_second_try_uses_a_new_token) {
  Bench bench;
  bench.load_all();
  bench.load_gripper(kArm);
  ASSERT_EQ(bench.result_of(kArm, wire::offer_command(kPedestal)), CommandResult::Ok);
  const std::uint16_t first = bench.arm().memory.record->token;
  ASSERT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::Abort)), CommandResult::Ok);
  bench.run(200);
  ASSERT_TRUE(bench.hand_over(kArm, kPedestal));
  EXPECT_EQ(bench.arm().memory.record->token, first + 1);
}

}  // namespace
}  // namespace pinjaw::core::test

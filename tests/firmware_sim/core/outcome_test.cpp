// Promises: R10, R5, I2c.
#include <gtest/gtest.h>

#include <vector>

#include "tests/firmware_sim/core/bench.hpp"

/// A receiver that missed how its handoff ended hears it later, whatever its giver has done since.
namespace pinjaw::core::test {
namespace {

struct Outcomes : testing::Test {
  Outcomes() {
    bench.load_all();
    bench.load_gripper(kArm);
  }
  /// The pedestal has latched, and goes dark before it hears anything more.
  void latch_pedestal_and_cut_its_power() {
    ASSERT_TRUE(bench.seat(kArm, kPedestal));
    ASSERT_TRUE(bench.squeeze(kPedestal));
    ASSERT_TRUE(bench.reaches(kArm, StateId::Relax)) << "it has heard TAKE";
    ASSERT_EQ(bench.pedestal().memory.record->custody, Custody::Latched);
    bench.pedestal().power_off();
  }
  /// The arm gives up its present handoff and tries one with the pallet, which it gives up, too.
  void offer_to_pallet_in_vain() {
    bench.arm_session(kArm);
    ASSERT_EQ(bench.result_of(kArm, wire::offer_command(kPallet)), wire::CommandResult::Ok);
    bench.run(100);
    ASSERT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::Abort)), wire::CommandResult::Ok);
    ASSERT_TRUE(bench.reaches(kArm, StateId::Hold));
    bench.run(100);
  }
  Bench bench;
};

TEST_F(Outcomes, of_a_token_that_was_taken_back_reach_a_receiver_that_was_off) {
  latch_pedestal_and_cut_its_power();
  ASSERT_TRUE(bench.reaches(kArm, StateId::Hold)) << "the giver doubts its peer";
  bench.run(100);
  offer_to_pallet_in_vain();
  bench.pedestal().power_on_again();
  EXPECT_TRUE(bench.reaches(kPedestal, StateId::Taken, 10));
  EXPECT_TRUE(bench.reaches(kPedestal, StateId::Seated, 1000)) << "RETAIN of a token two handoffs old";
}

TEST_F(Outcomes, let_a_receiver_that_was_off_open_again) {
  latch_pedestal_and_cut_its_power();
  ASSERT_TRUE(bench.reaches(kArm, StateId::Hold));
  bench.run(100);
  offer_to_pallet_in_vain();
  bench.pedestal().power_on_again();
  ASSERT_TRUE(bench.reaches(kPedestal, StateId::Seated, 1000));
  bench.run(100);
  ASSERT_EQ(bench.arm_session(kPedestal)->result, wire::CommandResult::Ok);
  EXPECT_EQ(bench.result_of(kPedestal, wire::plain_command(wire::Op::Abort)), wire::CommandResult::Ok);
  EXPECT_TRUE(bench.reaches(kPedestal, StateId::Ready, 10));
}

TEST_F(Outcomes, let_a_receiver_go_on_opening_that_was_stopped_on_its_way) {
  latch_pedestal_and_cut_its_power();
  ASSERT_TRUE(bench.reaches(kArm, StateId::Hold));
  bench.pedestal().power_on_again();
  ASSERT_TRUE(bench.reaches(kPedestal, StateId::Seated, 1000));
  bench.run(100);
  bench.arm_session(kPedestal);
  ASSERT_EQ(bench.result_of(kPedestal, wire::plain_command(wire::Op::Abort)), wire::CommandResult::Ok);
  bench.command(kPedestal, wire::hold_command());  // the jaws are still at the part
  bench.run(100);
  bench.arm_session(kPedestal);
  ASSERT_EQ(bench.pedestal().id(), StateId::Ready);
  EXPECT_EQ(bench.result_of(kPedestal, wire::accept_command(kArm)), wire::CommandResult::Refused);
  EXPECT_EQ(bench.result_of(kPedestal, wire::plain_command(wire::Op::Abort)), wire::CommandResult::Ok);
  EXPECT_TRUE(bench.run_until(2000, [&] { return bench.pedestal().jaw.separation_10um > 4900; }));
}

/// Power goes while the jaws press lightly on a part that the giver answers for: no record of custody, a part
/// felt.
TEST_F(Outcomes, let_a_receiver_open_that_lost_power_before_it_latched) {
  ASSERT_TRUE(bench.seat(kArm, kPedestal));
  bench.pedestal().power_off();
  bench.run(20);
  bench.pedestal().power_on_again();
  bench.run(300);
  ASSERT_EQ(bench.pedestal().id(), StateId::FaultHold);
  bench.arm_session(kPedestal);
  EXPECT_EQ(bench.result_of(kPedestal, wire::plain_command(wire::Op::ClearFault)),
            wire::CommandResult::Refused)
      << "it would become a second custodian";
  EXPECT_EQ(bench.result_of(kPedestal, wire::plain_command(wire::Op::Abort)), wire::CommandResult::Ok);
  EXPECT_TRUE(bench.run_until(2000, [&] { return bench.pedestal().jaw.separation_10um > 4900; }));
  EXPECT_EQ(bench.arm().id(), StateId::Offered);
}

TEST_F(Outcomes, of_another_token_do_not_let_it_open) {
  ASSERT_TRUE(bench.seat(kArm, kPedestal));
  bench.pedestal().power_off();
  NvmRecord record = *bench.pedestal().memory.record;
  --record.token;
  bench.pedestal().memory.record = record;
  bench.pedestal().power_on_again();
  bench.run(300);
  bench.arm_session(kPedestal);
  EXPECT_EQ(bench.result_of(kPedestal, wire::plain_command(wire::Op::Abort)), wire::CommandResult::Refused);
}

TEST_F(Outcomes, survive_a_restart_of_the_giver) {
  latch_pedestal_and_cut_its_power();
  ASSERT_TRUE(bench.reaches(kArm, StateId::Hold));
  bench.run(100);
  offer_to_pallet_in_vain();
  bench.arm().power_off();
  bench.run(20);
  bench.arm().power_on_again();
  bench.pedestal().power_on_again();
  EXPECT_TRUE(bench.reaches(kPedestal, StateId::Seated, 1000));
}

TEST_F(Outcomes, of_a_token_that_was_released_make_the_receiver_sole) {
  ASSERT_TRUE(bench.seat(kArm, kPedestal));
  ASSERT_TRUE(bench.squeeze(kPedestal));
  ASSERT_TRUE(bench.reaches(kArm, StateId::Opening));
  bench.run(3);
  bench.pedestal().power_off();
  bench.bring_part(kArm, false);
  ASSERT_TRUE(bench.reaches(kArm, StateId::Ready, 3000));
  bench.run(50);
  // The arm takes another part from the pallet, so that its own fact is no longer RELEASED.
  bench.load_pallet();
  bench.arm_session(kArm);
  ASSERT_TRUE(bench.hand_over(kPallet, kArm));
  bench.run(5);
  ASSERT_EQ(bench.arm().core.announced.fact, wire::Fact::Sole);
  bench.pedestal().power_on_again();
  EXPECT_TRUE(bench.reaches(kPedestal, StateId::Hold, 1000));
}

TEST_F(Outcomes, go_back_four_handoffs) {
  for (int i = 0; i < 6; ++i) offer_to_pallet_in_vain();
  const auto& outcomes = bench.arm().memory.record->outcomes;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    EXPECT_EQ(outcomes[i], (Outcome{.retained = true,
                                    .peer = kPallet,
                                    .token = static_cast<std::uint16_t>(6 - i),
                                    .pair = layout_for(kArm).peer(kPallet)->pair_crc}));
  }
  std::vector<bool> said(7);
  bench.after_step = [&] {
    for (const wire::Frame& frame : bench.heard) {
      const auto custody = wire::parse<wire::Custody>(frame);
      if (custody && custody->label.node == kArm && custody->message.past())
        said.at(custody->message.token) = true;
    }
  };
  bench.run(500);
  EXPECT_EQ(said, (std::vector<bool>{false, false, false, true, true, true, false}))
      << "6 is the present fact, 1 and 2 are forgotten";
}

TEST_F(Outcomes, are_not_said_before_they_were_true_once) {
  ASSERT_EQ(bench.result_of(kArm, wire::offer_command(kPallet)), wire::CommandResult::Ok);
  bench.run(100);
  bench.arm().jaw.leak_permille = 200;  // the hold is lost: RETAIN may not be said
  ASSERT_TRUE(bench.reaches(kArm, StateId::Hold));
  bench.run(50);
  ASSERT_NE(bench.arm().core.announced.fact, wire::Fact::Retain);
  bench.arm_session(kArm);
  EXPECT_NE(bench.result_of(kArm, wire::offer_command(kPedestal)), wire::CommandResult::Ok);
  bench.arm().jaw.local_enable = true;
  EXPECT_EQ(bench.result_of(kArm, wire::manual_release_ask()), wire::CommandResult::Busy);
}

}  // namespace
}  // namespace pinjaw::core::test

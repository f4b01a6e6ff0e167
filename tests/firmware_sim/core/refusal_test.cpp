// Promises: I3, R7, R8, R9, MANUAL.
#include <gtest/gtest.h>

#include "tests/firmware_sim/core/bench.hpp"

namespace pinjaw::core::test {
namespace {

using wire::CommandResult;
using wire::Op;
using wire::Reason;

struct Refusal : testing::Test {
  Refusal() { bench.load_all(); }

  /// Expects `command` to be refused so, and that nothing of the valves or the state changes by it.
  void expect(std::uint8_t node, const wire::Command& command, CommandResult result, Reason reason) {
    const StateId before = bench.at(node).id();
    const Spool spool = bench.at(node).outputs.valves.spool;
    const auto answer = bench.command(node, command);
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(answer->result, result);
    EXPECT_EQ(answer->reason, reason);
    EXPECT_EQ(bench.at(node).id(), before);
    EXPECT_EQ(bench.at(node).outputs.valves.spool, spool);
  }
  void seat_by_operator() {
    bench.bring_part(kArm, true);
    bench.arm().jaw.local_enable = true;
    bench.arm_session(kArm);
    ASSERT_EQ(bench.result_of(kArm, wire::plain_command(Op::CloseLight)), CommandResult::Ok);
    ASSERT_TRUE(bench.reaches(kArm, StateId::Seated));
  }
  Bench bench;
};

TEST_F(Refusal, of_anything_without_a_session) {
  expect(kArm, wire::plain_command(Op::CloseLight), CommandResult::BadSession, Reason::NotArmed);
}

TEST_F(Refusal, of_another_session) {
  bench.arm_session(kArm);
  wire::Command command = wire::plain_command(Op::Disarm);
  command.session = static_cast<std::uint16_t>(bench.arm().core.gate.session() + 1);
  command.sequence = 9;
  bench.inject(wire::pack(command, {.node = kArm}));
  bench.run(1);
  EXPECT_EQ(bench.arm().id(), StateId::Ready);
}

TEST_F(Refusal, of_arm_for_another_layout) {
  expect(kArm, wire::arm_command(bench.arm().core.layouts.crc ^ 1U, bench.epoch), CommandResult::Refused,
         Reason::LayoutDiffers);
}

TEST_F(Refusal, of_arm_while_no_host_is_heard) {
  bench.host_alive = false;
  bench.run(300);
  expect(kArm, wire::arm_command(bench.arm().core.layouts.crc, bench.epoch), CommandResult::Refused,
         Reason::HostSilent);
}

TEST_F(Refusal, of_arm_when_two_epochs_are_heard) {
  bench.inject(wire::pack(wire::HostHeartbeat{.epoch = 5}, {.node = 0, .counter = 3}));
  bench.run(20);
  expect(kArm, wire::arm_command(bench.arm().core.layouts.crc, bench.epoch), CommandResult::Refused,
         Reason::TwoHosts);
  EXPECT_TRUE(bench.arm().core.host.alive()) << "a second host does not make the first one lost";
  bench.run(250);
  EXPECT_EQ(bench.arm_session(kArm)->result, CommandResult::Ok);
}

TEST_F(Refusal, of_motion_without_a_permit) {
  bench.arm_session(kArm);
  bench.arm().jaw.local_enable = true;
  bench.host_permit = 0;
  bench.run(60);
  expect(kArm, wire::plain_command(Op::CloseLight), CommandResult::NoPermit, Reason::NotPermitted);
}

TEST_F(Refusal, without_a_permit_arm_opens_a_session_and_stays_loaded) {
  bench.host_permit = 0;
  bench.run(60);
  EXPECT_EQ(bench.arm_session(kArm)->result, CommandResult::Ok);
  EXPECT_EQ(bench.arm().id(), StateId::Loaded);
}

TEST_F(Refusal, of_close_light_without_the_local_enable) {
  bench.arm_session(kArm);
  expect(kArm, wire::plain_command(Op::CloseLight), CommandResult::Refused, Reason::NoLocalEnable);
}

TEST_F(Refusal, of_a_squeeze_that_may_exceed_what_it_permits) {
  seat_by_operator();
  expect(kArm, wire::squeeze_command({520, 639}), CommandResult::Limit, Reason::ForceOverPermit);
  expect(kArm, wire::squeeze_command({1300, 1401}), CommandResult::Limit, Reason::ForceOverPermit);
}

TEST_F(Refusal, of_a_squeeze_over_the_limit) {
  seat_by_operator();
  expect(kArm, wire::squeeze_command({520, 1401}), CommandResult::Limit, Reason::ForceOverLimit);
}

TEST_F(Refusal, of_a_squeeze_that_could_not_be_told_from_too_little) {
  seat_by_operator();
  expect(kArm, wire::squeeze_command({519, 1400}), CommandResult::Refused, Reason::ForceUnderRequired);
}

TEST_F(Refusal, of_an_offer_to_a_stranger) {
  bench.load_gripper(kArm);
  expect(kArm, wire::offer_command(9), CommandResult::Refused, Reason::PeerNotInLayout);
}

TEST_F(Refusal, of_accepting_what_nobody_offers) {
  bench.arm_session(kPedestal);
  bench.load_gripper(kArm);
  expect(kPedestal, wire::accept_command(kArm), CommandResult::Refused,
         bench.pedestal().core.peers.find(kArm)->custody_fresh.running() ? Reason::PeerNotOffering
                                                                         : Reason::PeerStale);
}

TEST_F(Refusal, of_every_opening_while_sole) {
  bench.load_gripper(kArm);
  for (const Op op : {Op::OpenEmpty, Op::Abort, Op::Disarm, Op::CloseLight}) {
    expect(kArm, wire::plain_command(op), CommandResult::BadState, Reason::WrongState);
  }
  expect(kArm, wire::squeeze_command({800, 1400}), CommandResult::BadState, Reason::WrongState);
}

TEST_F(Refusal, of_a_used_up_sequence) {
  bench.arm_session(kArm);
  wire::Command last = wire::plain_command(Op::CloseLight);
  last.session = bench.arm().core.gate.session();
  last.sequence = 255;
  bench.inject(wire::pack(last, {.node = kArm}));
  bench.run(1);
  wire::Command next = last;
  next.op = Op::Disarm;
  bench.inject(wire::pack(next, {.node = kArm}));
  bench.run(1);
  EXPECT_EQ(bench.arm().id(), StateId::Ready);
  EXPECT_EQ(bench.arm_session(kArm)->result, CommandResult::Ok) << "a new ARM begins anew";
}

TEST_F(Refusal, of_a_second_effect_of_a_repeated_command) {
  bench.load_gripper(kArm);
  wire::Command offer = wire::offer_command(kPedestal);
  offer.session = bench.arm().core.gate.session();
  offer.sequence = bench.arm().core.gate.next_sequence();
  for (int i = 0; i < 3; ++i) {
    bench.inject(wire::pack(offer, {.node = kArm}));
    bench.run(5);
  }
  EXPECT_EQ(bench.arm().id(), StateId::Offered);
  EXPECT_EQ(bench.arm().memory.record->handoff_number, 1);
}

TEST_F(Refusal, of_manual_release_without_enable_or_with_a_wrong_answer) {
  bench.load_gripper(kArm);
  expect(kArm, wire::manual_release_ask(), CommandResult::Refused, Reason::NoLocalEnable);
  bench.arm().jaw.local_enable = true;
  ASSERT_EQ(bench.result_of(kArm, wire::manual_release_ask()), CommandResult::Ok);
  const std::uint16_t challenge = bench.arm().core.challenge;
  expect(kArm, wire::manual_release_answer(challenge ^ 1U), CommandResult::Refused, Reason::ChallengeWrong);
  bench.run(3000);
  expect(kArm, wire::manual_release_answer(challenge), CommandResult::Refused, Reason::ChallengeWrong);
  ASSERT_EQ(bench.result_of(kArm, wire::manual_release_ask()), CommandResult::Ok);
  ASSERT_EQ(bench.result_of(kArm, wire::manual_release_answer(bench.arm().core.challenge)),
            CommandResult::Ok);
  EXPECT_TRUE(bench.reaches(kArm, StateId::Ready));
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::ManualRelease));
}

TEST_F(Refusal, never_of_hold) {
  bench.arm_session(kArm);
  EXPECT_EQ(bench.result_of(kArm, wire::hold_command()), CommandResult::Ok);
  EXPECT_EQ(bench.result_of(kPallet, wire::hold_command()), CommandResult::Ok);
}

}  // namespace
}  // namespace pinjaw::core::test

#include "host/jaw_client/client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/bus/sim_bus.hpp"
#include "protocol/wire/names.hpp"
#include "tests/host/jaw_client/fake_controller.hpp"
#include "tests/host/jaw_client/nodes.hpp"

namespace pinjaw::jaw_client {
namespace {

using ::testing::AllOf;
using testing::FakeController;
using ::testing::HasSubstr;
using testing::Reply;
using ::testing::SizeIs;
using wire::CommandResult;
using wire::Op;
using wire::Reason;
using wire::State;

constexpr std::uint32_t kCrc = 0x89ABCDEF;

wire::Layout layout_of(std::uint16_t f_limit_dn = 1400) {
  wire::Layout layout{.kit_id = 7,
                      .part_id = 9,
                      .grid_pitch_nm = 11'112'500,
                      .pin_diameter_nm = 4'762'500,
                      .pin_count = 4,
                      .separation_open_10um = 6000,
                      .separation_contact_10um = 3000,
                      .separation_tolerance_10um = 50,
                      .f_light_dn = 120,
                      .f_required_dn = 771,
                      .f_limit_dn = f_limit_dn,
                      .slip_tolerance_um = 200,
                      .stable_ms = 150};
  for (std::uint8_t i = 0; i < 4; ++i) {
    layout.pins.at(i) = {i < 2 ? wire::Jaw::Left : wire::Jaw::Right, 0, static_cast<std::int8_t>(i), 1650};
  }
  return layout;
}

/// A host and two fakes on a simulated bus, a millisecond at a time.
class OnTheBus : public ::testing::Test {
 protected:
  void pass(int ms) {
    for (int i = 0; i < ms; ++i) {
      now_us += 1000;
      bus.advance_to(now_us);
      arm.step();
      pedestal.step();
      client.step(now_us);
    }
  }

  Outcome settled(std::uint8_t node, int patience_ms = 30'000) {
    for (int i = 0; i < patience_ms && client.outcome(node).pending(); ++i) pass(1);
    return client.outcome(node);
  }

  Outcome armed(std::uint8_t node = kArm) {
    client.permit(node, true);
    client.arm(node, kCrc);
    return settled(node);
  }

  std::int64_t now_us = 0;
  bus::SimBus bus;
  std::unique_ptr<bus::Bus> end = bus.open();
  FakeController arm{bus.open(), kArm};
  FakeController pedestal{bus.open(), kPedestal};
  Client client{*end, {.epoch = 0x1234}};
};

TEST_F(OnTheBus, beats_every_50_ms_with_its_epoch_and_permits) {
  client.permit(3, true);
  client.permit(14, true);
  client.permit(3, false);
  client.set_state(wire::HostState::Run);
  pass(1005);
  EXPECT_EQ(arm.heartbeats, 21);
  EXPECT_EQ(arm.last_heartbeat.epoch, 0x1234);
  EXPECT_EQ(arm.last_heartbeat.permit, 1U << 13);
  EXPECT_EQ(arm.last_heartbeat.state, wire::HostState::Run);
}

TEST_F(OnTheBus, knows_who_lives) {
  EXPECT_FALSE(client.alive(kArm)) << "never heard is not alive";
  pass(100);
  EXPECT_TRUE(client.alive(kArm));
  EXPECT_FALSE(client.alive(5));
  arm.silent = true;
  pass(600);
  EXPECT_FALSE(client.alive(kArm));
  EXPECT_TRUE(client.alive(kPedestal));
}

TEST_F(OnTheBus, arms_once_the_node_hears_it) {
  EXPECT_TRUE(armed().done());
  EXPECT_TRUE(client.armed(kArm));
  ASSERT_THAT(arm.commands_done, SizeIs(1));
  EXPECT_EQ(wire::armed_crc24(arm.commands_done[0]), wire::crc24(kCrc));
  EXPECT_EQ(arm.commands_done[0].session, 0x1234) << "an ARM carries the epoch";
  EXPECT_GE(arm.heartbeats, 3);
}

TEST_F(OnTheBus, arms_again_where_the_permission_was_not_heard) {
  arm.arms_without_permission = 2;
  EXPECT_TRUE(armed().done());
  EXPECT_TRUE(client.node(kArm).in(State::Ready) || (pass(50), client.node(kArm).in(State::Ready)));
  EXPECT_THAT(arm.commands_done, SizeIs(3));
}

TEST_F(OnTheBus, arms_without_permission_and_leaves_the_node_loaded) {
  client.arm(kArm, kCrc);
  EXPECT_TRUE(settled(kArm).done());
  EXPECT_TRUE(client.node(kArm).in(State::Loaded));
  EXPECT_THAT(arm.commands_done, SizeIs(1));
}

TEST_F(OnTheBus, cannot_arm_who_is_not_there_or_does_not_hear) {
  client.arm(9, kCrc);
  EXPECT_EQ(settled(9).kind, OutcomeKind::Silent);
  EXPECT_EQ(client.outcome(9).sentence, "node 9 is not heard");
  arm.deaf = true;
  arm.state.host_alive = false;
  pass(50);
  client.arm(kArm, kCrc);
  EXPECT_EQ(settled(kArm).sentence, "node 1 does not hear this host");
}

TEST_F(OnTheBus, repeats_a_command_whose_answer_is_lost_and_it_is_done_once) {
  ASSERT_TRUE(armed().done());
  arm.acknowledges_to_lose = 3;
  const int before = arm.commands_heard;
  client.abort(kArm);
  EXPECT_TRUE(settled(kArm).done());
  EXPECT_EQ(arm.commands_heard - before, 4);
  EXPECT_THAT(arm.commands_done, SizeIs(2));
}

TEST_F(OnTheBus, gives_up_on_who_never_answers) {
  ASSERT_TRUE(armed().done());
  arm.acknowledges_to_lose = 1000;
  client.abort(kArm);
  const Outcome outcome = settled(kArm);
  EXPECT_EQ(outcome.kind, OutcomeKind::Silent);
  EXPECT_EQ(outcome.sentence, "node 1 does not answer");
}

TEST_F(OnTheBus, says_nothing_that_needs_a_session_without_one) {
  pass(100);
  client.squeeze(kArm, {.set_dn = 891, .permit_dn = 1400});
  const Outcome outcome = settled(kArm);
  EXPECT_EQ(outcome.kind, OutcomeKind::Refused);
  EXPECT_EQ(outcome.reason, Reason::NotArmed);
  EXPECT_EQ(arm.commands_heard, 0);
}

TEST_F(OnTheBus, holds_without_a_session) {
  client.hold(kArm);
  EXPECT_TRUE(settled(kArm).done());
  EXPECT_EQ(arm.commands_done.at(0).op, Op::Hold);
}

TEST_F(OnTheBus, numbers_its_commands_upwards_in_one_session) {
  ASSERT_TRUE(armed().done());
  for (int i = 0; i < 5; ++i) {
    client.abort(kArm);
    ASSERT_TRUE(settled(kArm).done());
  }
  for (std::size_t i = 2; i < arm.commands_done.size(); ++i) {
    EXPECT_GT(arm.commands_done[i].sequence, arm.commands_done[i - 1].sequence);
    EXPECT_EQ(arm.commands_done[i].session, 101);
  }
}

TEST_F(OnTheBus, arms_again_when_its_numbers_are_used_up) {
  ASSERT_TRUE(armed().done());
  int done = 0;
  while (done < 1000) {
    client.abort(kArm);
    if (!settled(kArm).done()) break;
    ++done;
  }
  EXPECT_EQ(client.outcome(kArm).reason, Reason::NotArmed);
  EXPECT_GT(done, 120);
  EXPECT_LT(done, 256);
  EXPECT_TRUE(armed().done());
  client.abort(kArm);
  EXPECT_TRUE(settled(kArm).done());
}

TEST_F(OnTheBus, loses_its_session_when_the_node_says_so) {
  ASSERT_TRUE(armed().done());
  client.disarm(kArm);
  ASSERT_TRUE(settled(kArm).done());
  EXPECT_FALSE(client.armed(kArm));
}

TEST_F(OnTheBus, tells_a_force_refusal_from_another) {
  ASSERT_TRUE(armed().done());
  arm.replies[Op::Squeeze] = {CommandResult::Limit, Reason::ForceOverLimit};
  client.squeeze(kArm, {.set_dn = 1300, .permit_dn = 1500});
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::ForceRefused);
  EXPECT_EQ(client.outcome(kArm).sentence, "node 1 refused SQUEEZE in READY: LIMIT (FORCE_OVER_LIMIT)");
  arm.replies[Op::Squeeze] = {CommandResult::BadState, Reason::WrongState};
  client.squeeze(kArm, {.set_dn = 891, .permit_dn = 1400});
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::Refused);
}

TEST_F(OnTheBus, closes_and_squeezes_until_the_part_is_held) {
  ASSERT_TRUE(armed().done());
  arm.replies[Op::CloseLight].then = {State::Seating, State::Seated};
  client.close_light(kArm);
  EXPECT_TRUE(settled(kArm).done());
  EXPECT_TRUE(client.node(kArm).in(State::Seated));
  arm.replies[Op::Squeeze].then = {State::Squeezing, State::Squeezing, State::Hold};
  client.squeeze(kArm, {.set_dn = 891, .permit_dn = 1400});
  EXPECT_TRUE(settled(kArm).done());
  EXPECT_TRUE(client.node(kArm).in(State::Hold));
  EXPECT_EQ(wire::squeeze_forces(arm.commands_done.back()).set_dn, 891);
}

TEST_F(OnTheBus, reports_a_squeeze_that_falls_back) {
  ASSERT_TRUE(armed().done());
  arm.state.state = State::Seated;
  pass(50);
  arm.state.fault = wire::FaultCode::OverForce;
  arm.replies[Op::Squeeze].then = {State::Squeezing, State::Seated};
  client.squeeze(kArm, {.set_dn = 891, .permit_dn = 1400});
  const Outcome outcome = settled(kArm);
  EXPECT_EQ(outcome.kind, OutcomeKind::Fault);
  EXPECT_EQ(outcome.fault, wire::FaultCode::OverForce);
  EXPECT_THAT(outcome.sentence, AllOf(HasSubstr("SEATED"), HasSubstr("OVER_FORCE")));
}

TEST_F(OnTheBus, reports_a_close_on_nothing) {
  ASSERT_TRUE(armed().done());
  arm.state.fault = wire::FaultCode::NoPart;
  arm.replies[Op::CloseLight].then = {State::Seating, State::FaultEmpty};
  client.close_light(kArm);
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::Fault);
  EXPECT_EQ(client.outcome(kArm).fault, wire::FaultCode::NoPart);
}

TEST_F(OnTheBus, does_not_wait_for_ever_for_a_state) {
  ASSERT_TRUE(armed().done());
  arm.replies[Op::CloseLight].then = {State::Seating};
  client.close_light(kArm);
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::Silent);
  EXPECT_THAT(client.outcome(kArm).sentence, HasSubstr("SEATING"));
}

TEST_F(OnTheBus, accepts_only_what_is_offered_to_this_node) {
  ASSERT_TRUE(armed(kPedestal).done());
  client.accept(kPedestal, kArm);
  arm.custody = wire::Custody{.fact = wire::Fact::Offer, .peer = 3, .token = 5};
  pass(300);
  EXPECT_TRUE(client.outcome(kPedestal).pending());
  EXPECT_THAT(pedestal.commands_done, SizeIs(1)) << "ARM only";
  pedestal.replies[Op::Accept].then = {State::Seating, State::Seated};
  arm.custody->peer = kPedestal;
  EXPECT_TRUE(settled(kPedestal).done());
  EXPECT_EQ(pedestal.commands_done.back().argument, kArm);
}

TEST_F(OnTheBus, accepts_again_while_the_offer_is_on_its_way) {
  ASSERT_TRUE(armed(kPedestal).done());
  arm.custody = wire::Custody{.fact = wire::Fact::Offer, .peer = kPedestal, .token = 5};
  pedestal.replies[Op::Accept] = {CommandResult::Refused, Reason::PeerNotOffering};
  client.accept(kPedestal, kArm);
  pass(200);
  EXPECT_TRUE(client.outcome(kPedestal).pending());
  pedestal.replies[Op::Accept] = {CommandResult::Ok, Reason::None, {State::Seating, State::Seated}};
  EXPECT_TRUE(settled(kPedestal).done());
}

TEST_F(OnTheBus, has_two_operations_at_once_on_two_nodes) {
  ASSERT_TRUE(armed(kArm).done());
  ASSERT_TRUE(armed(kPedestal).done());
  arm.replies[Op::Offer].then = {State::Offered};
  arm.effects[Op::Offer] = [this](const wire::Command& command) {
    arm.custody = wire::Custody{.fact = wire::Fact::Offer, .peer = command.argument, .token = 6};
  };
  pedestal.replies[Op::Accept].then = {State::Seating, State::Seated};
  client.offer(kArm, kPedestal);
  client.accept(kPedestal, kArm);
  EXPECT_TRUE(settled(kPedestal).done());
  EXPECT_TRUE(client.outcome(kArm).done());
}

TEST_F(OnTheBus, releases_by_answering_a_fresh_challenge) {
  ASSERT_TRUE(armed().done());
  arm.fault = wire::FaultReport{.code = wire::FaultCode::ManualRelease, .active = true, .argument = 0x111};
  pass(500);
  arm.fault.reset();
  arm.effects[Op::ManualRelease] = [this](const wire::Command& command) {
    if (command.argument != 1) return;
    arm.fault = wire::FaultReport{.code = wire::FaultCode::ManualRelease, .active = true, .argument = 0xABC};
    arm.replies[Op::ManualRelease].then = {State::Opening, State::Ready};
  };
  arm.state.state = State::Hold;
  client.release(kArm);
  EXPECT_TRUE(settled(kArm).done());
  ASSERT_THAT(arm.commands_done, SizeIs(3));
  EXPECT_EQ(arm.commands_done[2].argument, 2);
  EXPECT_EQ(arm.commands_done[2].b, 0xABC);
}

TEST_F(OnTheBus, sends_a_layout_and_reads_it_back) {
  client.send_layout(kArm, layout_of());
  const Outcome outcome = settled(kArm);
  EXPECT_TRUE(outcome.done()) << outcome.sentence;
  EXPECT_EQ(arm.committed, layout_of());
}

TEST_F(OnTheBus, sends_a_layout_over_a_line_that_loses_a_tenth) {
  bus.add_fault({.kind = bus::FaultKind::Drop, .share = 0.1});
  int done = 0;
  for (int i = 0; i < 20; ++i) {
    client.send_layout(kArm, layout_of());
    const Outcome outcome = settled(kArm, 60'000);
    EXPECT_FALSE(outcome.pending());
    done += outcome.done() ? 1 : 0;
    if (outcome.done()) {
      EXPECT_EQ(arm.committed, layout_of());
    }
  }
  EXPECT_GT(done, 0);
}

TEST_F(OnTheBus, asks_again_when_an_answer_to_the_layout_is_lost) {
  arm.responses_to_lose = 2;
  client.send_layout(kArm, layout_of());
  EXPECT_TRUE(settled(kArm).done());
}

TEST_F(OnTheBus, tells_why_a_layout_was_refused) {
  arm.target.f_hardware_dn = 1000;
  client.send_layout(kArm, layout_of());
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::ForceRefused);
  EXPECT_EQ(client.outcome(kArm).status, wire::TransferStatus::ForceOverHardware);
  EXPECT_EQ(client.outcome(kArm).sentence, "node 1: WRITE was refused: FORCE_OVER_HARDWARE");
  arm.target.kit_id = 8;
  client.send_layout(kArm, layout_of());
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::Refused);
  EXPECT_EQ(client.outcome(kArm).status, wire::TransferStatus::Kit);
}

TEST_F(OnTheBus, notices_a_layout_that_came_back_different) {
  arm.garbles_readback = true;
  client.send_layout(kArm, layout_of());
  EXPECT_EQ(settled(kArm).status, wire::TransferStatus::CommitDiffers);
}

TEST_F(OnTheBus, says_when_nobody_answers_a_layout) {
  client.send_layout(9, layout_of());
  EXPECT_EQ(settled(9).kind, OutcomeKind::Silent);
}

TEST_F(OnTheBus, tells_everyone_to_hold_three_times) {
  client.hold_everyone(Reason::CauseRemains);
  pass(100);
  EXPECT_EQ(arm.global_holds, 3);
  EXPECT_EQ(pedestal.global_holds, 3);
}

TEST_F(OnTheBus, notices_another_host) {
  pass(100);
  EXPECT_FALSE(client.other_host());
  const auto second_end = bus.open();
  Client second(*second_end, {.epoch = 0x9999});
  second.step(now_us);
  pass(10);
  EXPECT_TRUE(client.other_host());
  pass(1100);
  EXPECT_FALSE(client.other_host());
}

TEST_F(OnTheBus, watches_without_a_word) {
  const auto quiet_end = bus.open();
  Client watcher(*quiet_end, {.epoch = 1, .speaks = false});
  for (int i = 0; i < 500; ++i) {
    pass(1);
    watcher.step(now_us);
  }
  EXPECT_TRUE(watcher.alive(kArm));
  EXPECT_TRUE(watcher.other_host());
  EXPECT_EQ(quiet_end->statistics().sent, 0U);
}

TEST_F(OnTheBus, counts_frames_that_are_no_messages) {
  const auto noise = bus.open();
  wire::Frame bad = wire::pack(wire::Force{}, {.node = kArm});
  bad.data[3] ^= 1U;
  ASSERT_TRUE(noise->send(bad).has_value());
  ASSERT_TRUE(noise->send(wire::Frame{.id = 0x7FF}).has_value());
  pass(10);
  EXPECT_EQ(client.rejected(wire::FrameError::Checksum), 1U);
  EXPECT_EQ(client.rejected(wire::FrameError::UnknownId), 1U);
}

TEST_F(OnTheBus, keeps_the_active_faults_of_a_node) {
  arm.fault =
      wire::FaultReport{.code = wire::FaultCode::Leak, .severity = wire::Severity::Warning, .active = true};
  pass(450);
  ASSERT_NE(client.node(kArm).fault(wire::FaultCode::Leak), nullptr);
  EXPECT_THAT(client.node(kArm).faults, SizeIs(1));
  arm.fault->active = false;
  pass(150);
  EXPECT_EQ(client.node(kArm).fault(wire::FaultCode::Leak), nullptr);
}

/// A bus whose interface goes away.
class BrokenBus final : public bus::Bus {
 public:
  bus::Expected<void> send(const wire::Frame& /*frame*/) override { return tl::unexpected(why()); }
  bus::Expected<std::optional<bus::Received>> receive() override { return std::nullopt; }
  [[nodiscard]] bus::Statistics statistics() const override { return {}; }

 private:
  static bus::Failure why() { return {bus::FailureKind::Down, "the interface is down"}; }
};

TEST(BrokenBus, ends_what_is_under_way) {
  BrokenBus bus;
  Client client(bus, {});
  client.arm(kArm, kCrc);
  client.step(0);
  EXPECT_EQ(client.outcome(kArm).kind, OutcomeKind::BusFailed);
  ASSERT_TRUE(client.bus_failure().has_value());
  EXPECT_EQ(client.outcome(kArm).sentence, "the interface is down");
}

}  // namespace
}  // namespace pinjaw::jaw_client

// Promises: I4.
#include "protocol/wire/session.hpp"

#include <gtest/gtest.h>

#include "protocol/wire/commands.hpp"

namespace pinjaw::wire {
namespace {

Command numbered(Command command, std::uint16_t session, std::uint8_t sequence) {
  command.session = session;
  command.sequence = sequence;
  return command;
}

TEST(SequenceIssuer, counts_from_where_it_begins_to_255_and_stops) {
  SequenceIssuer issuer;
  EXPECT_EQ(issuer.take(), 0);
  EXPECT_EQ(issuer.take(), 1);
  issuer.begin(254);
  EXPECT_EQ(issuer.take(), 254);
  EXPECT_EQ(issuer.take(), 255);
  EXPECT_EQ(issuer.take(), std::nullopt);
  EXPECT_EQ(issuer.take(), std::nullopt) << "and it does not come round";
}

TEST(CommandGate, at_first_has_no_session_and_would_take_sequence_0) {
  const CommandGate gate;
  EXPECT_FALSE(gate.armed());
  EXPECT_EQ(gate.session(), 0);
  EXPECT_EQ(gate.next_sequence(), 0);
  EXPECT_EQ(gate.last_answer(), Acknowledge{});
  CommandGate open;
  open.open(7);
  EXPECT_TRUE(open.armed());
  EXPECT_EQ(open.session(), 7);
  EXPECT_EQ(open.admit(numbered(plain_command(Op::Abort), 7, 0)), Admission::New);
}

TEST(CommandGate, takes_the_next_sequence_and_every_later_one_but_none_before) {
  CommandGate gate;
  gate.open(7);
  gate.remember(numbered(plain_command(Op::Abort), 7, 9), {});
  for (int sequence = 0; sequence < 256; ++sequence) {
    const Command command = numbered(offer_command(2), 7, static_cast<std::uint8_t>(sequence));
    EXPECT_EQ(gate.admit(command), sequence < 10 ? Admission::OldSequence : Admission::New) << sequence;
  }
}

TEST(CommandGate, says_255_for_the_next_sequence_also_when_nothing_is_left) {
  CommandGate gate;
  gate.open(7);
  gate.remember(numbered(plain_command(Op::Abort), 7, 253), {});
  EXPECT_EQ(gate.next_sequence(), 254);
  gate.remember(numbered(plain_command(Op::Abort), 7, 254), {});
  EXPECT_EQ(gate.next_sequence(), 255);
  EXPECT_EQ(gate.admit(numbered(plain_command(Op::Disarm), 7, 255)), Admission::New);
  gate.remember(numbered(plain_command(Op::Abort), 7, 255), {});
  EXPECT_EQ(gate.next_sequence(), 255);
  EXPECT_EQ(gate.admit(numbered(plain_command(Op::Disarm), 7, 255)), Admission::UsedUp);
}

TEST(CommandGate, repeats_no_hold_for_hold_is_always_done_again) {
  CommandGate gate;
  gate.open(7);
  gate.remember(hold_command(), {});
  EXPECT_EQ(gate.admit(hold_command()), Admission::New);
}

TEST(CommandGate, when_closed_still_answers_the_last_command_alike_unless_it_opened_the_session) {
  CommandGate gate;
  gate.open(7);
  const Command abort = numbered(plain_command(Op::Abort), 7, 3);
  gate.remember(abort, {.sequence = 3, .op = Op::Abort});
  gate.close();
  EXPECT_EQ(gate.admit(abort), Admission::Repeated);
  EXPECT_EQ(gate.last_answer().sequence, 3);
  gate.open(8);
  const Command arm = arm_command(1, 2);
  gate.remember(arm, {});
  EXPECT_EQ(gate.admit(arm), Admission::Repeated);
  gate.close();
  EXPECT_EQ(gate.admit(arm), Admission::New);
  EXPECT_EQ(gate.session(), 0);
}

TEST(CommandGate, may_be_closed_before_anything_was_commanded) {
  CommandGate gate;
  gate.open(7);
  gate.close();
  EXPECT_EQ(gate, CommandGate{});
}

TEST(CommandGate, differs_from_another_in_whatever_it_keeps) {
  CommandGate one;
  one.open(7);
  CommandGate other = one;
  EXPECT_EQ(one, other);
  other.remember(numbered(plain_command(Op::Abort), 7, 1), {});
  EXPECT_NE(one, other);
  other = one;
  other.open(8);
  EXPECT_NE(one, other);
}

CommandGate armed_gate() {
  CommandGate gate;
  const Command arm = arm_command(0x123456, 77);
  gate.open(900);
  gate.remember(arm, {.op = Op::Arm, .session = 900, .next_sequence = 1});
  return gate;
}

TEST(CommandGate, lets_nothing_but_hold_and_arm_pass_without_a_session) {
  const CommandGate gate;
  for (std::size_t op = 0; op < kOpCount; ++op) {
    const Command command = numbered(plain_command(static_cast<Op>(op)), 900, 5);
    const bool free = command.op == Op::Hold || command.op == Op::Arm;
    EXPECT_EQ(gate.admit(command), free ? Admission::New : Admission::NotArmed);
  }
}

TEST(CommandGate, answers_a_repeat_the_same_and_does_it_once) {
  CommandGate gate = armed_gate();
  const Command command = numbered(offer_command(2), 900, 1);
  ASSERT_EQ(gate.admit(command), Admission::New);
  gate.remember(command, {.sequence = 1, .op = Op::Offer, .result = CommandResult::BadState});
  EXPECT_EQ(gate.admit(command), Admission::Repeated);
  EXPECT_EQ(gate.last_answer().result, CommandResult::BadState);
  Command other = command;
  other.argument = 3;
  EXPECT_EQ(gate.admit(other), Admission::OldSequence) << "same SEQ, other bytes";
}

TEST(CommandGate, refuses_old_numbers_and_foreign_sessions) {
  CommandGate gate = armed_gate();
  gate.remember(numbered(plain_command(Op::Abort), 900, 9), {});
  EXPECT_EQ(gate.next_sequence(), 10);
  EXPECT_EQ(gate.admit(numbered(plain_command(Op::Abort), 900, 8)), Admission::OldSequence);
  EXPECT_EQ(gate.admit(numbered(plain_command(Op::Abort), 901, 10)), Admission::WrongSession);
  EXPECT_EQ(gate.admit(numbered(plain_command(Op::Abort), 900, 200)), Admission::New);
}

TEST(CommandGate, never_wraps_within_a_session) {
  CommandGate gate = armed_gate();
  gate.remember(numbered(plain_command(Op::Abort), 900, 255), {});
  for (int sequence = 0; sequence < 256; ++sequence) {
    EXPECT_EQ(gate.admit(numbered(offer_command(1), 900, static_cast<std::uint8_t>(sequence))),
              Admission::UsedUp);
  }
}

TEST(CommandGate, a_replayed_arm_opens_no_old_session) {
  CommandGate gate = armed_gate();
  const Command arm = arm_command(0x123456, 77);
  EXPECT_EQ(gate.admit(arm), Admission::Repeated);
  gate.close();
  EXPECT_FALSE(gate.armed());
  EXPECT_EQ(gate.admit(arm), Admission::New) << "it gets a new session, never the closed one";
}

TEST(Commands, carry_their_arguments) {
  const Command arm = arm_command(0xAB123456, 77);
  EXPECT_EQ(armed_crc24(arm), 0x123456U);
  EXPECT_EQ(armed_crc24(arm), crc24(0xAB123456));
  EXPECT_EQ(arm.session, 77);
  const SqueezeForces forces = squeeze_forces(squeeze_command({.set_dn = 891, .permit_dn = 1400}));
  EXPECT_EQ(forces.set_dn, 891);
  EXPECT_EQ(forces.permit_dn, 1400);
  EXPECT_EQ(manual_release_ask().argument, 1);
  EXPECT_EQ(manual_release_answer(0xABC).argument, 2);
  EXPECT_EQ(manual_release_answer(0xABC).b, 0xABC);
}

}  // namespace
}  // namespace pinjaw::wire

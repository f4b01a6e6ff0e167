// Promises: I4.
#include "protocol/wire/session.hpp"

#include <gtest/gtest.h>

#include "protocol/wire/commands.hpp"
#include "protocol/wire/reception.hpp"
#include "protocol/wire/timing.hpp"

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

TEST(Countdown, runs_until_its_time_has_passed_and_never_below) {
  Countdown countdown;
  EXPECT_FALSE(countdown.running());
  EXPECT_EQ(countdown.left_ms(), 0);
  countdown.start(3);
  countdown.advance(2);
  EXPECT_TRUE(countdown.running());
  EXPECT_EQ(countdown.left_ms(), 1);
  countdown.advance(2);
  EXPECT_FALSE(countdown.running());
  EXPECT_EQ(countdown.left_ms(), 0);
  countdown.start(60000);
  EXPECT_NE(countdown, Countdown{});
  countdown.stop();
  EXPECT_FALSE(countdown.running());
  EXPECT_EQ(countdown, Countdown{});
}

TEST(Times, are_those_of_the_specification) {
  EXPECT_EQ(kPeerFresh_ms, 70);
  EXPECT_EQ(kHostFresh_ms, 200);
  EXPECT_EQ(kHostHeartbeat_ms, 50);
  EXPECT_EQ(kAcknowledge_ms, 50);
  EXPECT_EQ(kStatePeriod_ms, 20);
  EXPECT_EQ(kForceOffset_ms, 10);
  EXPECT_EQ(kCustodyHandoff_ms, 20);
  EXPECT_EQ(kCustodyIdle_ms, 100);
  EXPECT_EQ(kFaultPeriod_ms, 100);
  EXPECT_EQ(kPneumaticsPeriod_ms, 100);
  EXPECT_EQ(kLayoutStatusPeriod_ms, 500);
  EXPECT_EQ(kIdentityPeriod_ms, 1000);
  EXPECT_EQ(kGlobalHoldSpacing_ms, 5);
  EXPECT_EQ(kGlobalHoldRepeats, 3);
  EXPECT_EQ(kCounterModulus, 15);
}

TEST(Reception, tells_whether_anything_was_heard_and_whether_it_qualified) {
  Reception reception;
  EXPECT_FALSE(reception.heard());
  EXPECT_FALSE(reception.accept(0, 70));
  EXPECT_TRUE(reception.heard());
  EXPECT_FALSE(reception.qualified());
  EXPECT_FALSE(reception.accept(1, 70));
  EXPECT_TRUE(reception.accept(2, 70));
  EXPECT_TRUE(reception.qualified());
  EXPECT_TRUE(reception.fresh());
  EXPECT_FALSE(reception.accept(2, 70)) << "a repeat";
  EXPECT_FALSE(reception.qualified());
  EXPECT_FALSE(reception.fresh()) << "not even while the time of the last good one runs";
  reception.forget();
  EXPECT_EQ(reception, Reception{});
}

TEST(CounterCheck, begins_with_any_counter_and_has_heard_nothing_before) {
  CounterCheck check;
  EXPECT_FALSE(check.heard());
  EXPECT_FALSE(check.qualified());
  EXPECT_EQ(check.accept(9), CounterVerdict::Qualifying);
  EXPECT_TRUE(check.heard());
  EXPECT_EQ(check.accept(10), CounterVerdict::Qualifying);
  EXPECT_EQ(check.accept(11), CounterVerdict::Qualified);
  EXPECT_EQ(next_counter(13), 14);
  EXPECT_EQ(next_counter(14), 0);
}

}  // namespace
}  // namespace pinjaw::wire

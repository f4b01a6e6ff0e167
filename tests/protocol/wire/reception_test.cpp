// Promises: I4.
#include "protocol/wire/reception.hpp"

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>

#include "protocol/wire/commands.hpp"
#include "protocol/wire/session.hpp"

namespace pinjaw::wire {
namespace {

CounterCheck after(std::initializer_list<int> counters) {
  CounterCheck check;
  for (const int counter : counters) check.accept(static_cast<std::uint8_t>(counter));
  return check;
}

TEST(CounterCheck, needs_three_in_a_row_at_the_start) {
  EXPECT_FALSE(after({}).qualified());
  EXPECT_FALSE(after({4}).qualified());
  EXPECT_FALSE(after({4, 5}).qualified());
  EXPECT_TRUE(after({4, 5, 6}).qualified());
}

TEST(CounterCheck, forgives_two_losses_and_the_wrap) {
  for (std::uint8_t last = 0; last < kCounterModulus; ++last) {
    for (unsigned step = 0; step < kCounterModulus; ++step) {
      CounterCheck check;
      auto counter = static_cast<std::uint8_t>((last + kCounterModulus - 2U) % kCounterModulus);
      for (int i = 0; i < 3; ++i, counter = next_counter(counter)) check.accept(counter);
      ASSERT_TRUE(check.qualified());
      const auto verdict = check.accept(static_cast<std::uint8_t>((last + step) % kCounterModulus));
      EXPECT_EQ(verdict, step >= 1 && step <= 3 ? CounterVerdict::Qualified : CounterVerdict::Discarded)
          << int{last} << " + " << step;
    }
  }
}

TEST(CounterCheck, starts_over_after_a_repeat_or_a_jump) {
  for (const int odd : {6, 10}) {
    CounterCheck check = after({4, 5, 6});
    EXPECT_EQ(check.accept(static_cast<std::uint8_t>(odd)), CounterVerdict::Discarded);
    EXPECT_EQ(check.accept(static_cast<std::uint8_t>(odd + 1)), CounterVerdict::Qualifying);
    EXPECT_EQ(check.accept(static_cast<std::uint8_t>(odd + 2)), CounterVerdict::Qualifying);
    EXPECT_EQ(check.accept(static_cast<std::uint8_t>(odd + 3)), CounterVerdict::Qualified);
  }
}

TEST(CounterCheck, is_in_order_again_with_the_third_frame_after_one_stray) {
  for (std::uint8_t stray = 0; stray < kCounterModulus; ++stray) {
    if (stray >= 7 && stray <= 9) continue;  // it would be next
    CounterCheck check = after({4, 5, 6});
    EXPECT_EQ(check.accept(stray), CounterVerdict::Discarded) << int{stray};
    EXPECT_EQ(check.accept(7), CounterVerdict::Qualifying) << int{stray};
    EXPECT_EQ(check.accept(8), CounterVerdict::Qualifying) << int{stray};
    EXPECT_EQ(check.accept(9), CounterVerdict::Qualified) << int{stray};
  }
}

TEST(CounterCheck, takes_a_second_stray_for_a_new_row_only_where_it_goes_on_from_the_first) {
  for (std::uint8_t second = 0; second < kCounterModulus; ++second) {
    if (second >= 7 && second <= 9) continue;  // it would be next after 6
    CounterCheck check = after({4, 5, 6});
    ASSERT_EQ(check.accept(11), CounterVerdict::Discarded);
    EXPECT_EQ(check.accept(second), second >= 12 ? CounterVerdict::Qualifying : CounterVerdict::Discarded)
        << int{second};
  }
}

TEST(CounterCheck, forgets_a_stray_once_the_row_goes_on) {
  for (const int stray : {0, 1, 2, 3, 4, 5, 6, 10, 11, 12, 13, 14}) {
    EXPECT_EQ(after({4, 5, 6, stray, 7, 8, 9}), after({4, 5, 6, 7, 8, 9})) << stray;
  }
  CounterCheck check = after({4, 5, 6, 13, 7, 8, 9});
  EXPECT_EQ(check.accept(0), CounterVerdict::Discarded) << "13 is no longer where a row may begin";
}

TEST(CounterCheck, differs_from_another_in_each_thing_it_keeps) {
  EXPECT_NE(after({4}), after({5})) << "the last counter";
  EXPECT_NE(after({4, 11}), after({4, 12})) << "the stray";
  EXPECT_NE(after({4, 5}), after({5})) << "how many in a row";
  EXPECT_NE(after({0, 0}), after({})) << "whether one was heard";
}

TEST(Reception, never_heard_is_not_fresh) {
  EXPECT_FALSE(Reception{}.fresh());
}

TEST(Reception, is_fresh_for_its_time_and_no_longer) {
  Reception reception;
  for (std::uint8_t counter = 0; counter < 3; ++counter) reception.accept(counter, kPeerFresh_ms);
  EXPECT_TRUE(reception.fresh());
  reception.advance(kPeerFresh_ms - 1);
  EXPECT_TRUE(reception.fresh());
  reception.advance(1);
  EXPECT_FALSE(reception.fresh());
}

TEST(Reception, is_fresh_from_the_frame_that_may_be_used_not_from_those_before) {
  Reception reception;
  for (std::uint8_t counter = 0; counter < 3; ++counter) {
    reception.advance(60);
    reception.accept(counter, kPeerFresh_ms);
  }
  reception.advance(kPeerFresh_ms - 1);
  EXPECT_TRUE(reception.fresh());
}

TEST(Reception, a_repeated_frame_keeps_nothing_alive) {
  Reception reception;
  for (std::uint8_t counter = 0; counter < 3; ++counter) reception.accept(counter, kPeerFresh_ms);
  for (int i = 0; i < 10; ++i) {
    reception.advance(20);
    EXPECT_FALSE(reception.accept(2, kPeerFresh_ms));
  }
  EXPECT_FALSE(reception.fresh());
}

Command with(Command command, std::uint16_t session, std::uint8_t sequence) {
  command.session = session;
  command.sequence = sequence;
  return command;
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
    const Command command = with(plain_command(static_cast<Op>(op)), 900, 5);
    const bool free = command.op == Op::Hold || command.op == Op::Arm;
    EXPECT_EQ(gate.admit(command), free ? Admission::New : Admission::NotArmed);
  }
}

TEST(CommandGate, answers_a_repeat_the_same_and_does_it_once) {
  CommandGate gate = armed_gate();
  const Command command = with(offer_command(2), 900, 1);
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
  gate.remember(with(plain_command(Op::Abort), 900, 9), {});
  EXPECT_EQ(gate.next_sequence(), 10);
  EXPECT_EQ(gate.admit(with(plain_command(Op::Abort), 900, 8)), Admission::OldSequence);
  EXPECT_EQ(gate.admit(with(plain_command(Op::Abort), 901, 10)), Admission::WrongSession);
  EXPECT_EQ(gate.admit(with(plain_command(Op::Abort), 900, 200)), Admission::New);
}

TEST(CommandGate, never_wraps_within_a_session) {
  CommandGate gate = armed_gate();
  gate.remember(with(plain_command(Op::Abort), 900, 255), {});
  for (int sequence = 0; sequence < 256; ++sequence) {
    EXPECT_EQ(gate.admit(with(offer_command(1), 900, static_cast<std::uint8_t>(sequence))),
              Admission::UsedUp);
  }
  SequenceIssuer issuer;
  issuer.begin(255);
  EXPECT_EQ(issuer.take(), 255);
  EXPECT_FALSE(issuer.take().has_value());
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

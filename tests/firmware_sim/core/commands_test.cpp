// Promises: I3, R9, MANUAL.
#include "firmware_sim/core/commands.hpp"

#include <gtest/gtest.h>

#include <tuple>
#include <utility>
#include <vector>

#include "tests/firmware_sim/core/made_state.hpp"

/// How a command is taken in and answered, and what it brings with it.
namespace pinjaw::core::test {
namespace {

using enum wire::State;
using wire::CommandResult;
using wire::Op;
using wire::Reason;

constexpr std::uint16_t kSession = 5;

State in_session(StateId id) {
  State state = made(id);
  state.gate.open(kSession);
  state.session_epoch = 77;
  return state;
}

wire::Command numbered(wire::Command command, std::uint8_t sequence, std::uint16_t session = kSession) {
  command.sequence = sequence;
  command.session = session;
  return command;
}

wire::Acknowledge answered(Op op, std::uint8_t sequence, const Answer& answer, std::uint8_t next,
                           StateId id = Ready, std::uint16_t session = kSession) {
  return {.sequence = sequence,
          .op = op,
          .result = answer.result,
          .session = session,
          .reason = answer.reason,
          .state = id,
          .next_sequence = next};
}

constexpr Answer kDone{};

TEST(Obey, answers_what_is_turned_away_by_why_and_with_what_would_be_taken) {
  State state = in_session(Ready);
  const wire::Command clear = wire::plain_command(Op::ClearFault);
  EXPECT_EQ(obey(state, numbered(clear, 1, 6)),
            answered(Op::ClearFault, 1, {CommandResult::BadSession, Reason::WrongSession}, 0));
  EXPECT_EQ(obey(state, numbered(clear, 10)), answered(Op::ClearFault, 10, kDone, 11));
  EXPECT_EQ(obey(state, numbered(clear, 9)),
            answered(Op::ClearFault, 9, {CommandResult::BadSequence, Reason::SequenceOld}, 11));
  EXPECT_EQ(obey(state, numbered(clear, 254)), answered(Op::ClearFault, 254, kDone, 255));
  EXPECT_EQ(obey(state, numbered(clear, 255)), answered(Op::ClearFault, 255, kDone, 255));
  EXPECT_EQ(obey(state, numbered(wire::plain_command(Op::OpenEmpty), 255)),
            answered(Op::OpenEmpty, 255, {CommandResult::BadSequence, Reason::SequenceUsedUp}, 255));
  state.gate.close();
  EXPECT_EQ(obey(state, numbered(wire::plain_command(Op::OpenEmpty), 255)),
            answered(Op::OpenEmpty, 255, {CommandResult::BadSession, Reason::NotArmed}, 255, Ready, 0));
}

TEST(Obey, answers_a_repeat_as_before_and_does_nothing) {
  State state = in_session(Ready);
  const wire::Command disarm = numbered(wire::plain_command(Op::Disarm), 3);
  const wire::Acknowledge first = obey(state, disarm);
  EXPECT_EQ(first, answered(Op::Disarm, 3, kDone, 4, Loaded, 0));
  state.id = Ready;
  EXPECT_EQ(obey(state, disarm), first);
  EXPECT_EQ(state.id, Ready);
}

TEST(Obey, uses_up_the_number_of_a_command_that_it_refuses) {
  State state = in_session(Ready);
  const wire::Command offer = numbered(wire::offer_command(kPedestal), 3);
  const auto refused = answered(Op::Offer, 3, {CommandResult::BadState, Reason::WrongState}, 4);
  EXPECT_EQ(obey(state, offer), refused);
  EXPECT_EQ(state.gate.next_sequence(), 4);
  state.id = Hold;
  EXPECT_EQ(obey(state, offer), refused) << "it was said once";
}

TEST(Obey, counts_no_hold_and_no_arm_that_opens_nothing) {
  State state = in_session(Ready);
  obey(state, numbered(wire::plain_command(Op::ClearFault), 10));
  EXPECT_EQ(obey(state, numbered(wire::hold_command(), 200)), answered(Op::Hold, 200, kDone, 11, Ready, 0));
  EXPECT_EQ(state.gate.next_sequence(), 11);
  const wire::Command arm = numbered(wire::arm_command(state.layouts.crc ^ 1U, 77), 100, 77);
  EXPECT_EQ(obey(state, arm),
            answered(Op::Arm, 100, {CommandResult::Refused, Reason::LayoutDiffers}, 11, Ready, 0));
  EXPECT_EQ(state.gate.next_sequence(), 11);
}

TEST(Obey, opens_one_session_with_an_arm_however_often_it_comes) {
  State state = made(Loaded);
  state.frozen = true;
  state.next_session = 0x1'0008;
  state.store.record.session_block = 0x1'0020;
  const wire::Command arm = numbered(wire::arm_command(state.layouts.crc, 77), 100, 77);
  const auto open = answered(Op::Arm, 100, kDone, 101, Ready, 9);
  EXPECT_EQ(obey(state, arm), open);
  EXPECT_EQ(obey(state, arm), open);
  EXPECT_EQ(state.next_session, 0x1'0009U);
  EXPECT_EQ(state.session_epoch, 77);
  EXPECT_FALSE(state.frozen);
}

TEST(Obey, has_the_next_block_of_sessions_stored_while_one_number_is_left) {
  for (const auto& [left, stores] : std::vector<std::pair<std::uint32_t, bool>>{
           {0xFFFF'FFFF, true}, {0, true}, {1, true}, {2, false}, {15, false}, {16, false}, {17, true}}) {
    State state = made(Loaded);
    state.next_session = 100;
    state.store.record.session_block = 101 + left;
    obey(state, numbered(wire::arm_command(state.layouts.crc, 77), 1, 77));
    EXPECT_EQ(state.store.record.session_block, stores ? 117 : 101 + left);
    EXPECT_EQ(state.store.record_waits, stores) << left;
  }
}

TEST(TakenUp, by_close_light_and_accept_is_who_gives_the_part) {
  State state = in_session(Ready);
  state.measurement.separation_10um = 5000;
  state.measurement.local_enable = true;
  state.receiving = {.giver = kPallet, .token = 1, .pair = 2, .retained = true};
  State by_hand = state;
  EXPECT_EQ(obey(by_hand, numbered(wire::plain_command(Op::CloseLight), 1)).result, CommandResult::Ok);
  EXPECT_EQ(by_hand.id, Seating);
  EXPECT_EQ(by_hand.receiving.giver, wire::kOperatorPeer);
  EXPECT_EQ(by_hand.receiving.token, 0);
  EXPECT_EQ(by_hand.receiving.pair, 0);
  EXPECT_FALSE(by_hand.receiving.retained);
  const std::uint16_t pair = state.layouts.layout.peer(kPedestal)->pair_crc;
  hear_peer(state, kPedestal,
            {.fact = wire::Fact::Offer, .peer = kArm, .token = 7, .pair = pair, .f_low_n = 40});
  EXPECT_EQ(obey(state, numbered(wire::accept_command(kPedestal), 1)).result, CommandResult::Ok);
  EXPECT_EQ(state.receiving.giver, kPedestal);
  EXPECT_EQ(state.receiving.token, 7);
  EXPECT_EQ(state.receiving.pair, pair);
  EXPECT_FALSE(state.receiving.retained);
}

TEST(TakenUp, by_squeeze_and_offer_are_forces_and_receiver) {
  State state = in_session(Seated);
  state.receiving.giver = wire::kOperatorPeer;
  EXPECT_EQ(obey(state, numbered(wire::squeeze_command({530, 700}), 1)).result, CommandResult::Ok);
  EXPECT_EQ(state.force_set_dn, 530);
  EXPECT_EQ(state.permit_dn, 700);
  State giver = in_session(Hold);
  EXPECT_EQ(obey(giver, numbered(wire::offer_command(kPallet), 1)).result, CommandResult::Ok);
  EXPECT_EQ(giver.id, Offered);
  EXPECT_EQ(giver.store.record.peer, kPallet);
}

TEST(TakenUp, is_nothing_that_another_command_brings) {
  State accepts = in_session(Ready);
  accepts.measurement.separation_10um = 5000;
  accepts.force_set_dn = 530;
  const std::uint16_t pair = accepts.layouts.layout.peer(kPedestal)->pair_crc;
  hear_peer(accepts, kPedestal,
            {.fact = wire::Fact::Offer, .peer = kArm, .token = 7, .pair = pair, .f_low_n = 40});
  EXPECT_EQ(obey(accepts, numbered(wire::accept_command(kPedestal), 1)).result, CommandResult::Ok);
  EXPECT_EQ(accepts.force_set_dn, 530);
  State squeezes = in_session(Seated);
  squeezes.receiving.giver = wire::kOperatorPeer;
  squeezes.store.record.peer = kPallet;
  EXPECT_EQ(obey(squeezes, numbered(wire::squeeze_command({530, 700}), 1)).result, CommandResult::Ok);
  EXPECT_EQ(squeezes.store.record.peer, kPallet);
  State offers = in_session(Hold);
  offers.timers.challenge.start(50);
  EXPECT_EQ(obey(offers, numbered(wire::offer_command(kPallet), 1)).result, CommandResult::Ok);
  EXPECT_TRUE(offers.timers.challenge.running());
  State asks = in_session(Hold);
  asks.measurement.local_enable = true;
  asks.store.failed = true;
  EXPECT_EQ(obey(asks, numbered(wire::manual_release_ask(), 1)).result, CommandResult::Ok);
  EXPECT_TRUE(asks.store.failed);
}

TEST(TakenUp, by_a_manual_release_is_a_challenge_for_three_seconds_and_one_answer) {
  State state = in_session(Hold);
  state.measurement.local_enable = true;
  state.counters.steps = 1000;
  state.next_session = 3;
  EXPECT_EQ(obey(state, numbered(wire::manual_release_ask(), 1)).result, CommandResult::Ok);
  EXPECT_EQ(state.challenge, 1416);
  EXPECT_EQ(state.timers.challenge.left_ms(), 3000);
  EXPECT_EQ(state.faults.take_report(), wire::FaultCode::ManualRelease);
  EXPECT_EQ(state.id, Hold);
  EXPECT_EQ(obey(state, numbered(wire::manual_release_answer(1415), 2)).reason, Reason::ChallengeWrong);
  EXPECT_TRUE(state.timers.challenge.running());
  EXPECT_EQ(obey(state, numbered(wire::manual_release_answer(1416), 3)).result, CommandResult::Ok);
  EXPECT_EQ(state.id, Opening);
  EXPECT_FALSE(state.timers.challenge.running());
}

TEST(TakenUp, by_a_manual_release_is_another_number_each_step_and_never_none) {
  // mixed by 2^32 over the golden ratio, so that the next one is not the one after
  const std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint16_t>> numbers = {
      {0U, 0U, 1},           {1U, 0U, 3649},          {2U, 0U, 3186},          {1000U, 3U, 1416},
      {1001U, 3U, 954},      {123456U, 65537U, 1354}, {4294967295U, 1U, 1552}, {1U, 1U, 2560},
      {341U, 699045U, 3433}, {77777U, 40U, 3598}};
  for (const auto& [steps, sessions, challenge] : numbers) {
    State state = in_session(Hold);
    state.measurement.local_enable = true;
    state.counters.steps = steps;
    state.next_session = sessions;
    obey(state, numbered(wire::manual_release_ask(), 1));
    EXPECT_EQ(state.challenge, challenge);
  }
}

TEST(TakenUp, by_clear_fault_is_another_try_to_store) {
  for (const bool committed : {false, true}) {
    State state = in_session(Hold);
    state.store.failed = true;
    state.layouts.committed = committed;
    obey(state, numbered(wire::plain_command(Op::ClearFault), 1));
    EXPECT_FALSE(state.store.failed);
    EXPECT_TRUE(state.store.record_waits);
    EXPECT_EQ(state.store.layout_waits, committed);
  }
  State sound = in_session(Hold);
  obey(sound, numbered(wire::plain_command(Op::ClearFault), 1));
  EXPECT_FALSE(sound.store.record_waits);
  EXPECT_FALSE(sound.store.layout_waits);
}

TEST(TakenUp, by_clear_fault_is_a_part_that_no_record_tells_of) {
  for (const auto& [id, custody, left] :
       std::vector<std::tuple<StateId, Custody, Custody>>{{FaultHold, Custody::Empty, Custody::Sole},
                                                          {FaultHold, Custody::Released, Custody::Sole},
                                                          {FaultHold, Custody::Latched, Custody::Latched},
                                                          {Seated, Custody::Empty, Custody::Empty},
                                                          {Hold, Custody::Sole, Custody::Sole}}) {
    State state = in_session(id);
    state.measurement.local_enable = true;
    state.store.record.custody = custody;
    obey(state, numbered(wire::plain_command(Op::ClearFault), 1));
    EXPECT_EQ(state.store.record.custody, left);
    EXPECT_EQ(state.store.record_waits, left != custody);
  }
}

TEST(TakenUp, by_clear_fault_is_nothing_where_there_is_no_part) {
  State state = in_session(FaultHold);
  state.measurement.separation_10um = 5000;
  state.store.failed = true;
  EXPECT_EQ(obey(state, numbered(wire::plain_command(Op::ClearFault), 1)).state, Loaded);
  EXPECT_EQ(state.store.record.custody, Custody::Empty);
  EXPECT_TRUE(state.store.failed);
  EXPECT_FALSE(state.store.layout_waits);
}

}  // namespace
}  // namespace pinjaw::core::test

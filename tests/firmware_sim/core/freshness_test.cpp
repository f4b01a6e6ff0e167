// Promises: AUTH-COMMAND, AUTH-LOCKOUT, AUTH-FRESH, AUTH-FD.
#include <gtest/gtest.h>

#include "firmware_sim/core/authentication.hpp"
#include "firmware_sim/core/commands.hpp"
#include "firmware_sim/core/sending.hpp"
#include "protocol/wire/seal.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// Each word of what a controller with a key makes of commands and numbers, where each limit lies.
namespace pinjaw::core::test {
namespace {

using wire::CommandResult;
using wire::Op;
using wire::Reason;

constexpr wire::Key kSecret{7, 1, 8, 2, 8, 1, 8, 2, 8, 4, 5, 9, 0, 4, 5, 2};
constexpr std::uint32_t kMost = 0xFFFF'FFFF;

State with_key(StateId id = StateId::Loaded, bool can_fd = false) {
  State state = made(id);
  state.config.key = kSecret;
  state.config.can_fd = can_fd;
  return state;
}

/// A session is open, and none of its commands was given yet.
State in_session() {
  State state = with_key(StateId::Ready);
  state.next_session = 9;
  state.session_epoch = 77;
  state.gate.open(9);
  return state;
}

wire::Command sealed_arm(const State& state) {
  return wire::sealed(kSecret, kArm, wire::arm_command(state.layouts.crc, 77),
                      {next_session_number(state), 77});
}

TEST(LockOut, comes_with_the_third_miss_and_goes_a_minute_after_it) {
  LockOut lock_out;
  EXPECT_FALSE(lock_out.locked());
  lock_out.miss();
  lock_out.advance(59'999);
  lock_out.miss();
  EXPECT_FALSE(lock_out.locked());
  lock_out.advance(59'999);
  lock_out.miss();
  EXPECT_TRUE(lock_out.locked()) << "none was forgiven yet";
  lock_out.advance(59'999);
  EXPECT_TRUE(lock_out.locked());
  lock_out.miss();
  lock_out.advance(1);
  EXPECT_FALSE(lock_out.locked()) << "a miss that nobody judged prolongs nothing";
  lock_out.miss();
  lock_out.miss();
  EXPECT_FALSE(lock_out.locked()) << "counted anew";
}

TEST(SessionNumbers, rise_and_leave_out_those_that_end_in_sixteen_zeros) {
  State state;
  for (const auto& [now, next] : {std::pair{0U, 1U},
                                  {1U, 2U},
                                  {0xFFFEU, 0xFFFFU},
                                  {0xFFFFU, 0x10001U},
                                  {0x10001U, 0x10002U},
                                  {0x1FFFFU, 0x20001U}}) {
    state.next_session = now;
    EXPECT_EQ(next_session_number(state), next);
  }
}

TEST(SessionNumbers, end_four_blocks_before_the_last) {
  State state;
  state.next_session = kMost - 65;
  EXPECT_TRUE(numbers_are_left(state));
  state.next_session = kMost - 64;
  EXPECT_FALSE(numbers_are_left(state));
}

TEST(Unseal, judges_no_arm_that_would_be_refused_anyway) {
  const auto answer_with = [](void (*change)(State&)) {
    State state = with_key();
    change(state);
    wire::Command arm = wire::arm_command(state.layouts.crc, 77);
    const auto answer = unseal(state, arm);
    EXPECT_EQ(state.counters.wrong_macs, answer->reason == Reason::Authentication ? 1U : 0U);
    return answer;
  };
  EXPECT_EQ(answer_with([](State& s) { s.store.readable = false; }),
            (Answer{CommandResult::Refused, Reason::CauseRemains}));
  EXPECT_EQ(answer_with([](State& s) { s.next_session = kMost; }),
            (Answer{CommandResult::Refused, Reason::CauseRemains}));
  EXPECT_EQ(answer_with([](State& s) { hear_host(s, 78); }),
            (Answer{CommandResult::Refused, Reason::TwoHosts}));
  EXPECT_EQ(answer_with([](State& s) { s.host = {}; }), (Answer{CommandResult::Refused, Reason::HostSilent}));
  EXPECT_EQ(answer_with([](State&) {}), (Answer{CommandResult::BadSession, Reason::Authentication}));
}

TEST(Unseal, passes_everything_without_a_key_and_hold_with_one) {
  State open = made(StateId::Ready);
  wire::Command command = wire::plain_command(Op::Disarm);
  EXPECT_EQ(unseal(open, command), std::nullopt);
  State state = with_key();
  wire::Command hold = wire::hold_command();
  EXPECT_EQ(unseal(state, hold), std::nullopt);
  EXPECT_EQ(hold, wire::hold_command());
}

TEST(Unseal, makes_of_a_right_mac_the_session_or_epoch_that_it_stands_for) {
  State state = in_session();
  wire::Command command = wire::sealed(kSecret, kArm, wire::plain_command(Op::Disarm), {9, 77});
  EXPECT_EQ(unseal(state, command), std::nullopt);
  EXPECT_EQ(command.session, 9);
  wire::Command arm = sealed_arm(state);
  EXPECT_EQ(unseal(state, arm), std::nullopt);
  EXPECT_EQ(arm.session, 77);
  EXPECT_EQ(state.counters.wrong_macs, 0U);
  state.gate.close();
  EXPECT_EQ(unseal(state, command), (Answer{CommandResult::BadSession, Reason::NotArmed}));
}

TEST(Unseal, counts_misses_tells_of_each_and_ends_the_session_with_the_third) {
  State state = in_session();
  wire::Command wrong = wire::sealed(kSecret, kArm, wire::plain_command(Op::Disarm), {8, 77});
  for (std::uint32_t miss = 1; miss <= 3; ++miss) {
    EXPECT_TRUE(state.gate.armed());
    EXPECT_EQ(unseal(state, wrong), (Answer{CommandResult::BadSession, Reason::Authentication}));
    EXPECT_EQ(state.counters.wrong_macs, miss);
    EXPECT_EQ(state.faults.active(wire::FaultCode::Authentication), miss == 3);
    EXPECT_EQ(state.faults.take_report(), wire::FaultCode::Authentication);
    EXPECT_EQ(state.faults.take_report(), wire::FaultCode::None);
  }
  EXPECT_FALSE(state.gate.armed());
  EXPECT_EQ(unseal(state, wrong), (Answer{CommandResult::Refused, Reason::LockedOut}));
  wire::Command arm = sealed_arm(state);
  EXPECT_EQ(unseal(state, arm), (Answer{CommandResult::Refused, Reason::LockedOut}));
  EXPECT_EQ(state.counters.wrong_macs, 3U);
  advance_lock_out(state, 59'999);
  EXPECT_TRUE(state.faults.active(wire::FaultCode::Authentication));
  EXPECT_EQ(unseal(state, arm), (Answer{CommandResult::Refused, Reason::LockedOut}));
  advance_lock_out(state, 1);
  EXPECT_FALSE(state.faults.active(wire::FaultCode::Authentication));
  EXPECT_EQ(unseal(state, arm), std::nullopt);
}

TEST(Questions, are_answered_where_they_ask_a_node_with_a_key_for_its_number) {
  State state = in_session();
  const wire::Nonce nonce{.session = 1, .a = 2, .b = 3};
  const auto asked = [&](wire::ArmStep step) {
    return answer_question(state, wire::ask_number(step, nonce));
  };
  EXPECT_FALSE(asked(wire::ArmStep::Open).has_value());
  wire::Command other = wire::ask_number(wire::ArmStep::LowHalf, nonce);
  other.op = Op::Offer;
  EXPECT_FALSE(answer_question(state, other).has_value());
  state.next_session = 0x1'0009;
  EXPECT_EQ(asked(wire::ArmStep::LowHalf).value().session, 0x000A);
  EXPECT_EQ(asked(wire::ArmStep::HighHalf).value().session, 1);
  EXPECT_EQ(asked(wire::ArmStep::Proof).value().session,
            wire::number_answer(kSecret, kArm, wire::ArmStep::Proof, 0x1'000A, nonce));
  EXPECT_EQ(asked(wire::ArmStep::Proof).value().reason, Reason::Authentication) << "it opens nothing";
  EXPECT_EQ(asked(static_cast<wire::ArmStep>(4)).value().reason, Reason::BadArgument);
  for (int miss = 0; miss < 3; ++miss) state.lock_out.miss();
  EXPECT_EQ(asked(wire::ArmStep::Proof).value().reason, Reason::LockedOut);
  State open = made(StateId::Ready);
  EXPECT_EQ(answer_question(open, wire::ask_number(wire::ArmStep::LowHalf, nonce)).value().reason,
            Reason::BadArgument);
}

TEST(FrameNumbers, begin_with_a_block_that_no_earlier_start_was_given) {
  State state = with_key(StateId::Loaded, true);
  NvmRecord record;
  for (const auto& [found, left] : {std::pair{5U, 21U}, {kMost - 17, kMost - 1}, {kMost - 16, kMost - 16}}) {
    record.frame_block = found;
    start_link(state, record);
    EXPECT_EQ(state.link.next_number(), (std::uint64_t{found} << 16) + 1);
    EXPECT_EQ(record.frame_block, left);
  }
  State classic = with_key();
  const auto number = classic.link.next_number();
  record.frame_block = 5;
  start_link(classic, record);
  EXPECT_EQ(classic.link.next_number(), number);
  EXPECT_EQ(record.frame_block, 5U);
}

/// The node is in block 10 of its numbers, and those below `stored` are stored as given out.
State in_block_10(std::uint32_t stored) {
  State state = with_key(StateId::Loaded, true);
  NvmRecord record{.frame_block = 10};
  start_link(state, record);
  state.store.record.frame_block = stored;
  return state;
}

TEST(FrameNumbers, of_the_next_block_are_stored_two_before_this_one_ends) {
  State early = in_block_10(13);
  keep_link(early);
  EXPECT_EQ(early.frame_block, 13U);
  EXPECT_EQ(early.store.record.frame_block, 13U);
  EXPECT_FALSE(early.store.record_waits);
  State late = in_block_10(12);
  keep_link(late);
  EXPECT_EQ(late.frame_block, 12U) << "the next is not stored yet";
  EXPECT_EQ(late.store.record.frame_block, 28U);
  EXPECT_TRUE(late.store.record_waits);
  State last = in_block_10(12);
  NvmRecord record{.frame_block = kMost - 16};
  start_link(last, record);
  last.store.record.frame_block = kMost - 16;
  keep_link(last);
  EXPECT_FALSE(last.store.record_waits) << "there is no next one";
}

TEST(FrameNumbers, are_given_out_by_a_record_that_is_stored_and_can_be_read) {
  for (void (*const change)(State&) :
       {+[](State& s) { s.store.requested = 1; }, +[](State& s) { s.store.readable = false; },
        +[](State& s) { s.config.can_fd = false; }}) {
    State state = in_block_10(12);
    change(state);
    keep_link(state);
    EXPECT_EQ(state.frame_block, 0U);
    EXPECT_EQ(state.store.record.frame_block, 12U);
  }
}

TEST(FrameNumbers, are_used_only_below_what_is_stored_as_given_out) {
  const wire::Frame frame = wire::pack(wire::Force{}, {.node = kArm});
  for (const std::uint32_t stored : {10U, 11U}) {
    State state = in_block_10(stored);
    state.frame_block = stored;
    SendQueue queue;
    send(state, queue, frame);
    EXPECT_EQ(queue.size, stored - 10);
    EXPECT_EQ(state.counters.frames_not_sent, 11 - stored);
    EXPECT_EQ(queue.frames[0].kind, stored == 11 ? wire::FrameKind::Fd : wire::FrameKind::Data);
    State other = in_block_10(stored);
    const Outputs outputs = step(other, {});
    EXPECT_EQ(outputs.send.frames[0].id, stored == 11 ? wire::kSynchronisationId + kArm : 0U)
        << "asks whom it hears";
  }
  State classic = made(StateId::Loaded);
  SendQueue queue;
  send(classic, queue, frame);
  EXPECT_EQ(queue.frames[0], frame);
  step(classic, {});
  EXPECT_EQ(classic.link.next_number(), 0U);
}

/// Whether `link` looks at a sealed frame of node `node`, 0 being a host, at all.
bool listens_to(State& state, std::uint8_t node) {
  const auto id = node == 0 ? wire::Identifier{wire::MessageType::HostHeartbeat, 0}
                            : wire::Identifier{wire::MessageType::State, node};
  const auto before = state.link.refused();
  state.link.open(kSecret, {.id = wire::id_of(id), .kind = wire::FrameKind::Fd, .length = wire::kFdLength});
  return state.link.refused() == before + 1;
}

TEST(Link, hears_hosts_and_the_peers_of_the_committed_layout) {
  State state = in_block_10(100);
  keep_link(state);
  for (std::uint8_t node = 0; node <= 14; ++node) {
    EXPECT_EQ(listens_to(state, node), node == 0 || node == kPedestal || node == kPallet) << int{node};
  }
  state.layouts.committed = false;
  keep_link(state);
  for (std::uint8_t node = 0; node <= 14; ++node) EXPECT_EQ(listens_to(state, node), node == 0) << int{node};
}

TEST(Link, tells_when_three_frames_of_one_it_knew_were_not_authentic) {
  State state = in_block_10(100);
  keep_link(state);
  EXPECT_EQ(state.faults.take_report(), wire::FaultCode::None);
  wire::SecuredLink<wire::kLastNode> host(wire::kHostNode, 1000);
  const auto question = state.link.speak(kSecret, 1);
  ASSERT_TRUE(question.has_value());
  host.open(kSecret, *question);
  const auto answer = host.speak(kSecret, 1);
  ASSERT_TRUE(answer.has_value());
  state.link.open(kSecret, *answer);
  ASSERT_TRUE(state.link.knows(wire::kHostNode));
  for (int frame = 1; frame <= 3; ++frame) {
    wire::Frame forged = host.seal(kSecret, wire::pack(wire::HostHeartbeat{}, {}));
    forged.tail[1] ^= 1U;
    state.link.open(kSecret, forged);
    keep_link(state);
    EXPECT_EQ(state.faults.take_report(),
              frame == 3 ? wire::FaultCode::Authentication : wire::FaultCode::None);
  }
}

}  // namespace
}  // namespace pinjaw::core::test

// Promises: T-GUARD, R4, R6, MANUAL.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/firmware_sim/core/bench.hpp"

/// The channel beside the state machine: neither alone opens.
namespace pinjaw::core::test {
namespace {

constexpr auto place(Event event) {
  return static_cast<std::size_t>(event);
}
constexpr auto place(StateId state) {
  return static_cast<std::size_t>(state);
}

/// A state machine that lets go where it must not.
StateTable with(StateId state, Event event, Cell cell) {
  StateTable table = kStateTable;
  table[place(event)][place(state)] = cell;
  return table;
}

struct TwoChannels : testing::Test {
  TwoChannels() { bench.load_all(); }
  /// The arm holds, and its state machine is replaced.
  void mistake(const StateTable& mistaken, bool guard_on) {
    table = mistaken;
    bench.arm().core.config.table = &table;
    bench.arm().core.config.release_guard_enabled = guard_on;
  }
  bool drops_within(int ms) {
    return bench.run_until(ms, [&] { return bench.arm().jaw.squeeze_dn() == 0; });
  }
  /// The pedestal takes what the arm offers; both channels of the arm see it from now on.
  void let_pedestal_take() {
    bench.load_gripper(kArm);
    ASSERT_TRUE(bench.seat(kArm, kPedestal));
    ASSERT_TRUE(bench.squeeze(kPedestal));
    ASSERT_TRUE(bench.reaches(kPedestal, StateId::Taken));
  }
  StateTable table = kStateTable;
  Bench bench;
};

TEST_F(TwoChannels, hold_though_the_state_machine_opens_at_a_commands_word) {
  for (const bool guard_on : {false, true}) {
    bench.load_gripper(kArm);
    bench.arm_session(kArm);
    mistake(with(StateId::Hold, Event::CmdDisarm, Cell::Op), guard_on);
    bench.command(kArm, wire::plain_command(wire::Op::Disarm));
    ASSERT_EQ(bench.arm().id(), StateId::Opening);
    EXPECT_EQ(drops_within(3000), !guard_on);
    EXPECT_EQ(bench.arm().core.faults.active(wire::FaultCode::MemorySelfTest), guard_on);
    bench = Bench();
    bench.load_all();
  }
}

TEST_F(TwoChannels, hold_though_the_state_machine_decides_without_a_peer) {
  for (const bool guard_on : {false, true}) {
    bench.load_gripper(kArm);
    mistake(with(StateId::Offered, Event::OfferUnanswered, Cell::Op), guard_on);
    bench.command(kArm, wire::offer_command(kPedestal));
    ASSERT_TRUE(bench.reaches(kArm, StateId::Opening, 40'000));
    EXPECT_EQ(drops_within(3000), !guard_on);
    EXPECT_NE(bench.arm().memory.record->custody == Custody::Decided, guard_on) << "nor is it stored";
    bench = Bench();
    bench.load_all();
  }
}

TEST_F(TwoChannels, keep_the_full_force_until_both_see_the_peer_hold) {
  let_pedestal_take();
  for (int ms = 0; ms < 500; ++ms) {
    bench.arm().core.release_guard.peer_faulty.start(100);
    bench.run(1);
    ASSERT_EQ(bench.arm().id(), StateId::Offered) << ms << " ms";
  }
  bench.arm().core.release_guard.peer_faulty.stop();
  EXPECT_TRUE(bench.reaches(kArm, StateId::Relax, 200));
}

TEST_F(TwoChannels, hold_though_the_state_machine_opens_on_a_permit_of_a_handoff_that_was_taken_back) {
  let_pedestal_take();
  ASSERT_TRUE(bench.reaches(kArm, StateId::Relax));
  bench.arm().core.release_guard.peer_permits = true;
  bench.arm_session(kArm);
  bench.command(kArm, wire::plain_command(wire::Op::Abort));
  ASSERT_TRUE(bench.reaches(kArm, StateId::Hold));
  ASSERT_TRUE(bench.reaches(kPedestal, StateId::Seated));
  mistake(with(StateId::Hold, Event::CmdDisarm, Cell::Op), true);
  bench.command(kArm, wire::plain_command(wire::Op::Disarm));
  ASSERT_EQ(bench.arm().id(), StateId::Opening);
  EXPECT_FALSE(drops_within(3000));
}

/// A decision that only one channel took stays one, also when both begin to listen anew.
TEST_F(TwoChannels, hold_though_the_bus_is_off_for_a_while_after_one_decided_alone) {
  bench.load_gripper(kArm);
  mistake(with(StateId::Offered, Event::OfferUnanswered, Cell::Op), true);
  bench.command(kArm, wire::offer_command(kPedestal));
  ASSERT_TRUE(bench.reaches(kArm, StateId::Opening, 40'000));
  bench.arm().bus.off = true;
  bench.run(20);
  bench.arm().bus.off = false;
  EXPECT_FALSE(drops_within(3000));
  EXPECT_NE(bench.arm().memory.record->custody, Custody::Decided);
}

TEST_F(TwoChannels, open_on_though_the_bus_is_off_for_a_while_after_both_decided) {
  let_pedestal_take();
  ASSERT_TRUE(bench.reaches(kArm, StateId::Opening));
  bench.arm().bus.off = true;
  bench.run(2);
  bench.arm().bus.off = false;
  EXPECT_TRUE(drops_within(3000));
}

TEST_F(TwoChannels, open_after_a_restart_in_the_middle_of_a_decided_opening) {
  bench.load_gripper(kArm);
  NvmRecord record = *bench.arm().memory.record;
  record.custody = Custody::Decided;
  record.peer = kPedestal;
  bench.arm().memory.record = record;
  bench.arm().power_on_again();
  EXPECT_TRUE(drops_within(1000)) << "what was decided before is not decided again";
}

// --- the guard's own decoder against the codec's

const Release kRelease{
    .peer = kPedestal, .token = 7, .pair = 0xBEEF, .peer_required_dn = 400, .decided = false};

wire::Custody take() {
  return {.fact = wire::Fact::Take, .peer = kArm, .token = 7, .pair = 0xBEEF, .f_low_n = 52};
}
wire::NodeState taken() {
  return {.state = StateId::Taken, .hold_stable = true, .custody = wire::Fact::Take, .f_low_dn = 520};
}

Config arm_config() {
  Config config;
  config.node = kArm;
  return config;
}

/// What the guard permits after `ms` of both messages every 20 ms, made by `change` from good ones.
template <class Change>
bool permits_after(int ms, Change change) {
  ReleaseGuard guard;
  NvmRecord record;
  record.custody = Custody::Decided;
  record.peer = kPedestal;
  record.token = 7;
  std::uint8_t counter = 0;
  for (int now = 0; now < ms; ++now) {
    std::vector<wire::Frame> frames;
    if (now % 20 == 0) {
      counter = wire::next_counter(counter);
      frames = {wire::pack(take(), {.node = kPedestal, .counter = counter}),
                wire::pack(taken(), {.node = kPedestal, .counter = counter})};
      change(now, frames);
    }
    watch(guard, arm_config(), kRelease, frames, false, 1);
  }
  return permits_decision(guard, arm_config(), record);
}

constexpr auto kUnchanged = [](int, std::vector<wire::Frame>&) {};

TEST(ReleaseGuard, permits_after_200_ms_of_a_good_peer_and_not_before) {
  EXPECT_FALSE(permits_after(239, kUnchanged)) << "the third frame in a row comes at 40 ms";
  EXPECT_TRUE(permits_after(240, kUnchanged));
}

/// Nothing is lost of what comes in the very step that begins the handoff.
TEST(ReleaseGuard, hears_frames_that_come_alone_for_the_handoff_that_is_present) {
  ReleaseGuard guard;
  for (std::uint8_t counter = 1; counter <= 3; ++counter) {
    const wire::Label label{.node = kPedestal, .counter = counter};
    watch(guard, arm_config(), kRelease, wire::pack(take(), label), false);
    watch(guard, arm_config(), kRelease, wire::pack(taken(), label), false);
  }
  EXPECT_FALSE(sees_peer_hold(guard, arm_config())) << "no time has passed";
  watch(guard, arm_config(), kRelease, {}, false, 1);
  EXPECT_TRUE(sees_peer_hold(guard, arm_config()));
}

TEST(ReleaseGuard, wants_every_term_of_the_peers_hold) {
  const auto refuses = [](auto tamper) {
    return !permits_after(1000, [&](int, std::vector<wire::Frame>& frames) {
      wire::Custody custody = take();
      wire::NodeState state = taken();
      tamper(custody, state);
      const std::uint8_t counter = frames[0].data[1] & 0xFU;
      frames = {wire::pack(custody, {.node = kPedestal, .counter = counter}),
                wire::pack(state, {.node = kPedestal, .counter = counter})};
    });
  };
  EXPECT_FALSE(refuses([](auto&, auto&) {}));
  EXPECT_FALSE(refuses([](auto&, auto& state) { state.f_low_dn = 400; }));
  EXPECT_TRUE(refuses([](auto& custody, auto&) { custody.fact = wire::Fact::Sole; }));
  EXPECT_TRUE(refuses([](auto& custody, auto&) { custody.peer = kPallet; }));
  EXPECT_TRUE(refuses([](auto& custody, auto&) { custody.token = 8; }));
  EXPECT_TRUE(refuses([](auto& custody, auto&) { custody.pair = 0xBEEE; }));
  EXPECT_TRUE(refuses([](auto&, auto& state) { state.state = StateId::Hold; }));
  EXPECT_TRUE(refuses([](auto&, auto& state) { state.hold_stable = false; }));
  EXPECT_TRUE(refuses([](auto&, auto& state) { state.f_low_dn = 399; }));
  EXPECT_TRUE(refuses([](auto&, auto& state) { state.f_low_dn = std::nullopt; }));
}

TEST(ReleaseGuard, wants_both_messages_fresh_all_the_time) {
  for (const std::size_t missing : {std::size_t{0}, std::size_t{1}}) {
    EXPECT_FALSE(permits_after(400, [&](int now, std::vector<wire::Frame>& frames) {
      if (now >= 120 && now < 200) frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(missing));
    })) << "70 ms of silence in the middle";
  }
}

TEST(ReleaseGuard, counts_no_frame_twice) {
  EXPECT_FALSE(permits_after(1000, [](int, std::vector<wire::Frame>& frames) {
    for (wire::Frame& frame : frames) {
      frame = frame.id == 0x042 ? wire::pack(take(), {.node = kPedestal, .counter = 3})
                                : wire::pack(taken(), {.node = kPedestal, .counter = 3});
    }
  }));
}

TEST(ReleaseGuard, is_stopped_by_a_fault_for_which_the_peer_must_hold) {
  const auto permitted = [](wire::Severity severity, bool active) {
    return permits_after(600, [&](int now, std::vector<wire::Frame>& frames) {
      if (now % 100 != 0) return;
      frames.push_back(
          wire::pack(wire::FaultReport{.code = wire::FaultCode::Slip, .severity = severity, .active = active},
                     {.node = kPedestal, .counter = static_cast<std::uint8_t>(now / 100)}));
    });
  };
  EXPECT_FALSE(permitted(wire::Severity::Hold, true));
  EXPECT_TRUE(permitted(wire::Severity::Hold, false));
  EXPECT_TRUE(permitted(wire::Severity::Warning, true));
}

/// One frame of a good peer in a row of them is damaged: the guard must take or leave it as the codec does.
TEST(ReleaseGuard, reads_damaged_frames_as_the_codec_does) {
  std::mt19937 random(5);
  int whole = 0;
  for (int i = 0; i < 200'000; ++i) {
    wire::Frame frame = wire::pack(take(), {.node = kPedestal, .counter = 4});
    if (random() % 2 == 0) {
      for (std::size_t byte = 1; byte < 8; ++byte) {
        if (random() % 4 == 0) frame.data[byte] = static_cast<std::uint8_t>(random());
      }
      if (random() % 2 == 0)
        frame.data[0] = wire::detail::checksum({wire::MessageType::Custody, kPedestal}, frame.data);
    } else {
      frame.data[random() % 8] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    if (random() % 16 == 0) frame.id ^= 1U << random() % 11;
    if (random() % 16 == 0) frame.extended = true;
    if (random() % 16 == 0) frame.kind = wire::FrameKind::Remote;
    if (random() % 16 == 0) frame.length = static_cast<std::uint8_t>(random() % 8);
    ReleaseGuard guard;
    guard.peer = kPedestal;
    guard.token = 7;
    guard.custody.counter = 3;
    guard.custody.in_a_row = 3;
    watch(guard, arm_config(), kRelease, std::vector<wire::Frame>{frame}, false, 0);
    const auto parsed = wire::parse<wire::Custody>(frame);
    wire::CounterCheck check;
    for (std::uint8_t counter = 1; counter <= 3; ++counter) check.accept(counter);
    const bool used = parsed && parsed->label.node == kPedestal && !parsed->message.past() &&
                      check.accept(parsed->label.counter) == wire::CounterVerdict::Qualified;
    wire::Custody wanted = take();
    if (parsed) wanted.f_low_n = parsed->message.f_low_n;
    ASSERT_EQ(guard.custody.good, used && parsed->message == wanted) << i;
    whole += used ? 1 : 0;
  }
  EXPECT_GT(whole, 1000);
}

TEST(ReleaseGuard, lets_only_how_a_past_handoff_ended_stand_beside_what_was_said) {
  for (unsigned fact = 0; fact < 16; ++fact) {
    wire::Frame frame = wire::pack(take(), {.node = kPedestal, .counter = 4});
    frame.data[2] = static_cast<std::uint8_t>((frame.data[2] & 0xF0U) | fact);
    frame.data[7] = 0xFF;
    frame.data[0] = wire::detail::checksum({wire::MessageType::Custody, kPedestal}, frame.data);
    ReleaseGuard guard;
    guard.peer = kPedestal;
    guard.token = 7;
    guard.custody.counter = 3;
    guard.custody.in_a_row = 3;
    guard.custody.good = true;
    watch(guard, arm_config(), kRelease, std::vector<wire::Frame>{frame}, false, 0);
    const auto is = [fact](wire::Fact other) { return fact == static_cast<unsigned>(other); };
    const bool stands = is(wire::Fact::Take) || is(wire::Fact::Released) || is(wire::Fact::Retain);
    EXPECT_EQ(guard.custody.good, stands) << fact;
  }
}

TEST(ReleaseGuard, after_bus_off_takes_a_decision_for_made_only_where_one_was_and_it_permitted_it) {
  NvmRecord record;
  ReleaseGuard permitted;
  permitted.peer_permits = true;
  permitted.peer = record.peer = kPedestal;
  permitted.token = record.token = 7;
  for (const bool decided : {false, true}) {
    record.custody = decided ? Custody::Decided : Custody::Sole;
    EXPECT_EQ(guard_after_bus_off(permitted, arm_config(), record).decided_before, decided);
    EXPECT_FALSE(guard_after_bus_off(ReleaseGuard{}, arm_config(), record).decided_before);
  }
}

TEST(ReleaseGuard, permits_no_answer_by_hand_where_nothing_was_asked) {
  for (std::uint16_t answer = 0; answer < 3; ++answer) {
    ReleaseGuard guard;
    guard.asked.start(3000);
    const Release by_hand{.peer = wire::kOperatorPeer};
    watch(guard, arm_config(), by_hand,
          std::vector<wire::Frame>{wire::pack(wire::manual_release_answer(answer), {.node = kArm})}, true, 1);
    EXPECT_FALSE(guard.hand_permits) << answer;
  }
}

TEST(ReleaseGuard, permits_a_release_by_hand_only_as_asked_and_answered_with_the_local_enable) {
  NvmRecord record;
  record.custody = Custody::Decided;
  record.peer = wire::kOperatorPeer;
  const auto permitted = [&](bool enable_at_ask, int wait_ms, bool enable_at_answer, std::uint8_t node,
                             std::uint16_t challenge = 99) {
    const Release by_hand{.peer = wire::kOperatorPeer, .challenge = challenge};
    ReleaseGuard guard;
    const auto say = [&](const wire::Command& command, bool enable) {
      watch(guard, arm_config(), by_hand, std::vector<wire::Frame>{wire::pack(command, {.node = node})},
            enable, 1);
    };
    say(wire::manual_release_ask(), enable_at_ask);
    for (int i = 0; i < wait_ms; ++i) watch(guard, arm_config(), by_hand, {}, enable_at_answer, 1);
    say(wire::manual_release_answer(99), enable_at_answer);
    return permits_decision(guard, arm_config(), record);
  };
  EXPECT_TRUE(permitted(true, 0, true, kArm));
  EXPECT_TRUE(permitted(true, 2998, true, kArm));
  EXPECT_FALSE(permitted(true, 2999, true, kArm));
  EXPECT_FALSE(permitted(false, 10, true, kArm));
  EXPECT_FALSE(permitted(true, 10, false, kArm));
  EXPECT_FALSE(permitted(true, 10, true, kPedestal));
  EXPECT_FALSE(permitted(true, 10, true, kArm, 98)) << "another answer than was asked for";
  EXPECT_FALSE(permitted(true, 10, true, kArm, 0)) << "nothing was asked";
}

}  // namespace
}  // namespace pinjaw::core::test

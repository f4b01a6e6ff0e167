// Promises: AUTH-COMMAND, AUTH-REPLAY, AUTH-LOCKOUT, AUTH-FRESH.
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "firmware_sim/core/commands.hpp"
#include "protocol/wire/seal.hpp"
#include "tests/firmware_sim/core/bench.hpp"
#include "tests/support/figures.hpp"

/// A controller with a key: who does not know it can neither arm, move, raise force nor release.
namespace pinjaw::core::test {
namespace {

using wire::CommandResult;
using wire::Op;
using wire::Reason;

constexpr wire::Key kKey{7, 1, 8, 2, 8, 1, 8, 2, 8, 4, 5, 9, 0, 4, 5, 2};

/// What a node does and remembers, but for what it says of bad commands.
struct Doing {
  StateId id{};
  Valves valves;
  NvmRecord record;
  std::uint16_t session = 0;
  std::uint32_t number = 0;
  friend bool operator==(const Doing&, const Doing&) = default;
};

/// Runs a copy of `station` for `ms`, `frames` coming with the first.
Doing after(Station station, const std::vector<wire::Frame>& frames, int ms = 20) {
  for (int i = 0; i < ms; ++i) station.step(i == 0 ? frames : std::vector<wire::Frame>{});
  return {station.core.id, station.outputs.valves, station.core.store.record, station.core.gate.session(),
          station.core.next_session};
}

wire::Acknowledge answer_of(Station& station, const wire::Command& command) {
  return obey(station.core, command);
}

/// The arm holds a part and the pedestal has taken an offer: sessions are open at both.
struct Authenticated : testing::Test {
  Authenticated() {
    bench.share_key(kKey);
    bench.load_all();
  }
  void seat_pedestal() {
    bench.load_gripper(kArm);
    ASSERT_TRUE(bench.seat(kArm, kPedestal));
  }
  /// A command of the open session with its next number and MAC.
  wire::Command next(std::uint8_t node, wire::Command command) {
    command.sequence = bench.at(node).core.gate.next_sequence();
    return bench.sealed_for(node, command);
  }
  Bench bench;
};

TEST_F(Authenticated, a_part_goes_from_hand_to_hand_as_it_does_without_a_key) {
  bench.load_pallet();
  ASSERT_EQ(bench.pallet().id(), StateId::Hold);
  ASSERT_TRUE(bench.hand_over(kPallet, kArm));
  ASSERT_TRUE(bench.hand_over(kArm, kPedestal));
  EXPECT_EQ(bench.arm().core.counters.wrong_macs, 0U);
}

TEST(WithoutAKey, who_has_seen_the_session_can_command) {
  Bench bench;
  bench.load_all();
  bench.arm_session(kArm);
  bench.arm().jaw.local_enable = true;
  bench.bring_part(kArm, true);
  wire::Command forged = wire::plain_command(Op::CloseLight);
  forged.session = bench.arm().core.gate.session();
  forged.sequence = 200;
  bench.inject(wire::pack(forged, {.node = kArm}));
  EXPECT_TRUE(bench.reaches(kArm, StateId::Seated)) << "this is what a key is for";
}

TEST_F(Authenticated, a_flipped_bit_makes_a_command_worthless) {
  seat_pedestal();
  const wire::Frame right =
      wire::pack(next(kPedestal, wire::squeeze_command({520, 1400})), {.node = kPedestal});
  const Doing untouched = after(bench.pedestal(), {});
  ASSERT_NE(after(bench.pedestal(), {right}), untouched) << "the command itself is obeyed";
  constexpr unsigned kMakesItHold = 18;  // OP 4 to OP 0, which anyone may say
  for (unsigned bit = 8; bit < 64; ++bit) {
    if (bit == kMakesItHold) continue;
    wire::Frame flipped = right;
    flipped.data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    flipped.data[0] = wire::detail::checksum({wire::MessageType::Command, kPedestal}, flipped.data);
    EXPECT_EQ(after(bench.pedestal(), {flipped}), untouched) << "bit " << bit;
  }
  for (std::uint8_t length = 0; length < 8; ++length) {
    wire::Frame cut = right;
    cut.length = length;
    EXPECT_EQ(after(bench.pedestal(), {cut}), untouched) << "length " << int{length};
  }
}

TEST_F(Authenticated, hold_is_obeyed_from_anyone) {
  seat_pedestal();
  EXPECT_EQ(answer_of(bench.pedestal(), wire::hold_command()).result, CommandResult::Ok);
  EXPECT_TRUE(bench.pedestal().core.frozen);
}

TEST_F(Authenticated,
       what_was_recorded_of_a_session_is_worthless_in_it_after_it_after_a_reset_and_elsewhere) {
  std::vector<std::pair<std::uint8_t, wire::Frame>> said;
  bench.bring_part(kArm, true);
  bench.arm().jaw.local_enable = true;
  const auto say = [&](const wire::Command& command) {
    said.emplace_back(kArm, wire::pack(command, {.node = kArm}));
    bench.inject(said.back().second);
    bench.run(2);
  };
  wire::Command arm = wire::arm_command(bench.arm().core.layouts.crc, bench.epoch);
  arm.sequence = 3;
  say(bench.sealed_for(kArm, arm));
  ASSERT_TRUE(bench.arm().core.gate.armed());
  say(next(kArm, wire::plain_command(Op::CloseLight)));
  ASSERT_TRUE(bench.reaches(kArm, StateId::Seated));
  say(next(kArm, wire::squeeze_command({520, 1400})));
  ASSERT_TRUE(bench.reaches(kArm, StateId::Hold));

  int replays = 0;
  const auto expect_worthless = [&](const Station& station, const char* when) {
    const Doing untouched = after(station, {});
    for (const auto& [node, frame] : said) {
      wire::Frame there = frame;
      there.id = wire::id_of({wire::MessageType::Command, station.config.node});
      there.data[0] = wire::detail::checksum({wire::MessageType::Command, station.config.node}, there.data);
      EXPECT_EQ(after(station, {there}), untouched) << when;
      ++replays;
    }
    std::vector<wire::Frame> all;
    all.reserve(said.size());
    for (const auto& entry : said) all.push_back(entry.second);
    EXPECT_EQ(after(station, all).id, untouched.id) << when;
  };
  expect_worthless(bench.arm(), "in the session");
  bench.arm_session(kPedestal);
  expect_worthless(bench.pedestal(), "at another node");
  Station cut = bench.arm();
  cut.power_off();
  cut.power_on_again();
  for (int ms = 0; ms < 300; ++ms) cut.step({});
  expect_worthless(cut, "after a reset");
  bench.bring_part(kArm, false);
  Station fresh = bench.arm();
  fresh.memory.record->custody = Custody::Empty;
  fresh.power_on_again();
  for (int ms = 0; ms < 300; ++ms) fresh.step({});
  expect_worthless(fresh, "after a reset, empty");
  pinjaw::test::figure("AUTH-REPLAY", "recorded commands said again without an effect", replays);
}

TEST_F(Authenticated, an_arm_of_another_host_or_of_one_that_is_not_heard_is_not_judged) {
  wire::Command arm = bench.sealed_for(kArm, wire::arm_command(bench.arm().core.layouts.crc, bench.epoch));
  bench.inject(wire::pack(wire::HostHeartbeat{.epoch = 5}, {.node = 0, .counter = 3}));
  bench.run(20);
  EXPECT_EQ(answer_of(bench.arm(), arm).reason, Reason::TwoHosts);
  bench.host_alive = false;
  bench.run(300);
  EXPECT_EQ(answer_of(bench.arm(), arm).reason, Reason::HostSilent);
  EXPECT_EQ(bench.arm().core.counters.wrong_macs, 0U);
}

TEST_F(Authenticated, an_arm_is_only_good_for_the_epoch_it_was_made_for) {
  wire::Command arm = wire::arm_command(bench.arm().core.layouts.crc, bench.epoch);
  bench.epoch = 78;
  arm = bench.sealed_for(kArm, arm);
  EXPECT_EQ(answer_of(bench.arm(), arm).reason, Reason::Authentication) << "the node still follows epoch 77";
}

TEST_F(Authenticated, three_wrong_macs_end_the_session_and_leave_nothing_but_hold_for_a_minute) {
  seat_pedestal();
  for (int i = 0; i < 3; ++i) {
    wire::Command guess = next(kPedestal, wire::squeeze_command({520, 1400}));
    guess.session ^= static_cast<std::uint16_t>(i + 1);
    EXPECT_EQ(answer_of(bench.pedestal(), guess).reason, Reason::Authentication);
    // what is right in between forgives nothing
    if (i == 0) {
      EXPECT_EQ(answer_of(bench.pedestal(), next(kPedestal, wire::plain_command(Op::ClearFault))).result,
                CommandResult::Ok);
    }
  }
  EXPECT_FALSE(bench.pedestal().core.gate.armed());
  EXPECT_TRUE(bench.pedestal().core.faults.active(wire::FaultCode::Authentication));
  EXPECT_EQ(bench.pedestal().id(), StateId::Seated) << "nothing opens";
  EXPECT_EQ(bench.arm_session(kPedestal)->reason, Reason::LockedOut);
  EXPECT_EQ(bench.command(kPedestal, wire::hold_command())->result, CommandResult::Ok);
  bench.run(LockOut::kForgiven_ms);
  EXPECT_FALSE(bench.pedestal().core.faults.active(wire::FaultCode::Authentication));
  EXPECT_EQ(bench.arm_session(kPedestal)->result, CommandResult::Ok);
}

TEST_F(Authenticated, a_babbler_gets_three_guesses_a_minute_however_fast_he_sends) {
  constexpr int kMinutes = 10;
  wire::Command guess = wire::arm_command(bench.arm().core.layouts.crc, bench.epoch);
  std::uint8_t counter = 0;
  for (int ms = 0; ms < kMinutes * 60000; ++ms) {
    std::vector<wire::Frame> frames;
    if (ms % wire::kHostHeartbeat_ms == 0) {
      counter = wire::next_counter(counter);
      frames.push_back(wire::pack(wire::HostHeartbeat{.permit = 0x3FFF, .epoch = bench.epoch},
                                  {.node = 0, .counter = counter}));
    }
    for (int i = 0; i < 4; ++i) {  // as many as 500 kbit/s carries
      guess.session = static_cast<std::uint16_t>(guess.session * 31 + 17);
      guess.sequence = static_cast<std::uint8_t>(guess.session >> 8);
      frames.push_back(wire::pack(guess, {.node = kArm}));
    }
    bench.arm().step(frames);
  }
  EXPECT_FALSE(bench.arm().core.gate.armed());
  const std::uint32_t judged = bench.arm().core.counters.wrong_macs;
  EXPECT_LE(judged, 3U * (kMinutes + 1));
  EXPECT_GE(judged, 3U);
  const double per_minute = static_cast<double>(judged) / kMinutes;
  pinjaw::test::figure("AUTH-LOCKOUT", "guesses judged of 4 a millisecond", per_minute, "a minute");
  pinjaw::test::figure("AUTH-LOCKOUT", "mean time to one right guess", 65536.0 / per_minute / 60 / 24,
                       "days");
}

TEST_F(Authenticated, no_number_is_given_twice_across_power_cuts_at_any_moment) {
  std::set<std::uint32_t> given;
  std::uint32_t random = 99;
  const auto draw = [&random](std::uint32_t below) {
    random = random * 1664525U + 1013904223U;
    return (random >> 8) % below;
  };
  Station& arm = bench.arm();
  arm.memory.record->session_block = 0xFFF0;  // soon over the end of what travels in one ACK
  arm.power_on_again();
  int cuts = 0;
  for (int i = 0; i < 2000; ++i) {
    bench.run(1 + static_cast<int>(draw(3)));
    wire::Command command = wire::arm_command(arm.core.layouts.crc, bench.epoch);
    command.sequence = static_cast<std::uint8_t>(draw(128));
    const std::uint32_t number = next_session_number(arm.core);
    const wire::Acknowledge answer = answer_of(arm, bench.sealed_for(kArm, command));
    if (answer.result == CommandResult::Ok) {
      EXPECT_TRUE(given.insert(number).second) << number;
      EXPECT_NE(answer.session, 0);
    }
    if (draw(20) == 0) {  // before or after what was asked of the memory is stored
      if (draw(2) == 0) bench.run(1);
      arm.power_off();
      arm.power_on_again();
      bench.run(200);
      ++cuts;
    }
  }
  EXPECT_GT(given.size(), 1000U);
  EXPECT_GT(*given.rbegin(), 0x10000U);
  pinjaw::test::figure("AUTH-FRESH", "sessions across power cuts, none twice", given.size());
  pinjaw::test::figure("AUTH-FRESH", "power cuts between them", cuts);
}

TEST_F(Authenticated, a_node_whose_numbers_may_come_twice_is_not_armed) {
  bench.arm().memory.record->session_block = std::numeric_limits<std::uint32_t>::max() - 100;
  for (int i = 0; i < 20; ++i) bench.arm().power_on_again(), bench.run(300);
  EXPECT_EQ(bench.arm_session(kArm)->reason, Reason::CauseRemains) << "used up, and not begun anew";
  EXPECT_GT(bench.arm().memory.record->session_block, std::numeric_limits<std::uint32_t>::max() - 100);

  bench.pedestal().memory.readable = false;
  bench.pedestal().power_on_again();
  bench.run(300);
  EXPECT_EQ(bench.arm_session(kPedestal)->reason, Reason::CauseRemains) << "lost";
}

TEST_F(Authenticated, whoever_asks_learns_the_number_and_a_proof_of_it_and_changes_nothing) {
  bench.arm().core.next_session = 0x2FFFE;
  const wire::Nonce nonce{0x1234, 0x567, 0x89A};
  const auto ask = [&](wire::ArmStep step) {
    const wire::Acknowledge answer = answer_of(bench.arm(), wire::ask_number(step, nonce));
    EXPECT_EQ(answer.result, CommandResult::BadSession);
    EXPECT_EQ(answer.reason, Reason::Authentication);
    return answer.session;
  };
  EXPECT_EQ(ask(wire::ArmStep::LowHalf), 0xFFFF);
  EXPECT_EQ(ask(wire::ArmStep::HighHalf), 2);
  EXPECT_EQ(ask(wire::ArmStep::Proof), wire::number_answer(kKey, kArm, wire::ArmStep::Proof, 0x2FFFF, nonce));
  EXPECT_EQ(bench.arm().core.next_session, 0x2FFFEU);
  EXPECT_EQ(bench.arm().core.counters.wrong_macs, 0U);
  EXPECT_FALSE(bench.arm().core.gate.armed());
}

TEST(WithoutAKey, a_question_for_the_number_is_refused) {
  Bench bench;
  bench.load_all();
  const auto answer = bench.command(kArm, wire::ask_number(wire::ArmStep::LowHalf, {bench.epoch, 0, 0}));
  EXPECT_EQ(answer->result, CommandResult::Refused);
  EXPECT_EQ(answer->reason, Reason::BadArgument);
}

}  // namespace
}  // namespace pinjaw::core::test

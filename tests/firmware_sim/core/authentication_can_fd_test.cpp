// Promises: AUTH-FD.
/// A MAC in every frame on CAN FD: what is forged is not heard, custody facts included, and numbers of frames
/// never come twice.
#include <gtest/gtest.h>

#include <functional>

#include "firmware_sim/core/commands.hpp"
#include "tests/firmware_sim/core/bench.hpp"

namespace pinjaw::core::test {
namespace {

constexpr wire::Key kKeyOfTheCell{7, 1, 8, 2, 8, 1, 8, 2, 8, 4, 5, 9, 0, 4, 5, 2};

/// A forger on the bus says in the pedestal's name that it has taken the part that the arm offers.
bool giver_lets_go(Bench& bench, const std::function<wire::Frame(const wire::Frame&)>& disguise) {
  bench.load_gripper(kArm);
  EXPECT_EQ(bench.result_of(kArm, wire::offer_command(kPedestal)), wire::CommandResult::Ok);
  bench.run(100);
  const NvmRecord& record = *bench.arm().memory.record;
  for (int i = 0; i < 60 && bench.arm().id() != StateId::Opening; ++i) {
    const wire::Label label{.node = kPedestal, .counter = static_cast<std::uint8_t>(i % 15)};
    const wire::Custody take{
        .fact = wire::Fact::Take, .peer = kArm, .token = record.token, .pair = record.pair, .f_low_n = 60};
    const wire::NodeState taken{.state = wire::State::Taken,
                                .armed = true,
                                .hold_stable = true,
                                .custody = wire::Fact::Take,
                                .f_low_dn = 600,
                                .separation_50um = 600};
    bench.inject(disguise(wire::pack(take, label)));
    bench.inject(disguise(wire::pack(taken, label)));
    bench.run(20);
  }
  return bench.arm().id() == StateId::Opening || bench.arm().id() == StateId::Ready;
}

TEST(AuthenticatedOnClassicCan, forged_custody_facts_make_a_giver_with_a_key_let_go) {
  Bench bench;
  bench.share_key(kKeyOfTheCell);
  bench.load_all();
  bench.pedestal().power_off();  // so that only the forger speaks in its name
  EXPECT_TRUE(giver_lets_go(bench, [](const wire::Frame& frame) { return frame; }))
      << "what docs/authentication.md says that a key on classic CAN does not protect";
}

struct OnCanFd : testing::Test {
  OnCanFd() {
    bench.share_key(kKeyOfTheCell, true);
    bench.load_all();
    bench.run(700);
  }
  Bench bench;
};

TEST_F(OnCanFd, a_part_goes_from_hand_to_hand_as_on_classic_can) {
  bench.load_pallet();
  ASSERT_EQ(bench.pallet().id(), StateId::Hold);
  ASSERT_TRUE(bench.hand_over(kPallet, kArm));
  ASSERT_TRUE(bench.hand_over(kArm, kPedestal));
  EXPECT_EQ(bench.arm().core.counters.wrong_macs, 0U);
}

TEST_F(OnCanFd, forged_custody_facts_are_not_heard) {
  bench.pedestal().power_off();
  EXPECT_FALSE(giver_lets_go(bench, [](const wire::Frame& frame) { return frame; }));
  EXPECT_EQ(bench.arm().id(), StateId::Offered);
  std::uint32_t random = 7;
  Bench other;
  other.share_key(kKeyOfTheCell, true);
  other.load_all();
  other.run(700);
  other.pedestal().power_off();
  EXPECT_FALSE(giver_lets_go(other, [&random](const wire::Frame& frame) {
    random = random * 1664525U + 1013904223U;
    wire::Frame forged = frame;
    forged.kind = wire::FrameKind::Fd;
    forged.length = wire::kFdLength;
    for (std::size_t i = 0; i < 4; ++i) forged.tail[i] = static_cast<std::uint8_t>(random >> (8 * i));
    return forged;
  }));
}

TEST_F(OnCanFd, hold_is_obeyed_from_anyone) {
  bench.bring_part(kArm, true);
  bench.arm().jaw.local_enable = true;
  bench.arm_session(kArm);
  ASSERT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::CloseLight)), wire::CommandResult::Ok);
  ASSERT_TRUE(bench.reaches(kArm, StateId::Seated));
  bench.inject(wire::pack(wire::GlobalHold{}, {.node = 9}));
  bench.run(2);
  EXPECT_TRUE(bench.arm().core.frozen);
}

TEST_F(OnCanFd, frame_numbers_only_rise_across_power_cuts_and_wait_until_their_block_is_stored) {
  Station& arm = bench.arm();
  wire::FrameNumber highest = 0;
  std::uint32_t random = 5;
  for (int cut = 0; cut < 300; ++cut) {
    random = random * 1664525U + 1013904223U;
    for (std::uint32_t ms = 0; ms <= random >> 28; ++ms) arm.step({});
    EXPECT_GT(arm.core.link.next_number(), highest);
    if (arm.core.frame_block != 0) highest = arm.core.link.next_number() - 1;
    arm.power_off();
    arm.power_on_again();
  }
  arm.memory_fails = true;
  arm.power_on_again();
  for (int ms = 0; ms < 500; ++ms) {
    arm.step({});
    ASSERT_EQ(arm.outputs.send.size, 0U) << "nothing is said with a number that might come again";
  }
}

TEST_F(OnCanFd, a_node_that_was_reset_is_heard_again_and_hears_the_others) {
  bench.load_gripper(kArm);
  bench.pedestal().power_off();
  bench.run(200);
  bench.pedestal().power_on_again();
  bench.run(700);
  EXPECT_TRUE(bench.arm().core.link.knows(kPedestal));
  EXPECT_TRUE(bench.pedestal().core.link.knows(kArm));
  EXPECT_TRUE(bench.hand_over(kArm, kPedestal));
}

TEST_F(OnCanFd, block_after_block_of_numbers_is_stored_in_time) {
  Station& arm = bench.arm();
  const std::uint32_t before = arm.memory.record->frame_block;
  for (int i = 0; i < 1'300'000; ++i) {
    (void)arm.core.link.seal(kKeyOfTheCell, {});
    if (i % 1000 == 0) {
      arm.step({});
      ASSERT_LT(arm.core.link.next_number() >> 16, arm.core.frame_block);
    }
  }
  EXPECT_GT(arm.memory.record->frame_block, before);
}

}  // namespace
}  // namespace pinjaw::core::test

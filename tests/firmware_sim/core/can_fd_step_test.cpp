// Promises: AUTH-FD, T-GUARD.
#include <gtest/gtest.h>

#include <vector>

#include "protocol/wire/secured_link.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// What one step does with frames of CAN FD: each is looked at once its MAC was found right, and in no other
/// way than a classic one.
namespace pinjaw::core::test {
namespace {

using Frames = std::vector<wire::Frame>;

constexpr wire::Key kSharedKey{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};

/// The arm, that has offered token 7, and the pedestal's end of the bus.
struct FdNode {
  State state = held(StateId::Hold);  // where no event takes the record away
  wire::SecuredLink<2> pedestal{kPedestal, wire::FrameNumber{1} << 20};
  Outputs outputs{};

  FdNode() {
    state.config.key = kSharedKey;
    state.config.can_fd = true;
    state.store.record = {
        .custody = Custody::Offered, .peer = kPedestal, .token = 7, .pair = 8, .frame_block = 32};
    state.frame_block = 32;
    state.link = {kArm, (wire::FrameNumber{1} << 16) + 1};
  }
  void step(const Frames& frames, std::uint32_t elapsed_ms = 1) {
    Inputs inputs;
    inputs.elapsed_ms = elapsed_ms;
    inputs.received = frames;
    inputs.sensors.close_mbar = {2500, 2500};
    inputs.sensors.supply_mbar = 6000;
    inputs.sensors.separation_10um = 3000;
    core::step(state, inputs, outputs);
  }
  /// The arm asks who the pedestal is, and is told.
  void get_acquainted() {
    step({});
    for (const wire::Frame& frame : outputs.send.view()) (void)pedestal.open(kSharedKey, frame);
    if (const auto answer = pedestal.speak(kSharedKey, 1)) step({*answer});
    ASSERT_TRUE(state.link.knows(kPedestal));
  }
  template <class Message>
  wire::Frame from_pedestal(const Message& message, int counter = 0) {
    return pedestal.seal(
        kSharedKey,
        wire::pack(message, {.node = kPedestal, .counter = static_cast<std::uint8_t>(counter % 15)}));
  }
  /// How often the link spoke for itself in the last step.
  [[nodiscard]] int said_by_link() const {
    int count = 0;
    for (const wire::Frame& frame : outputs.send.view()) count += frame.id == 0x0E0U + kArm ? 1 : 0;
    return count;
  }
};

TEST(CanFdStep, shows_the_release_guard_each_frame_and_lets_it_no_time_pass_but_its_own) {
  FdNode node;
  ASSERT_NO_FATAL_FAILURE(node.get_acquainted());
  int good_ms = 0;
  for (int ms = 0; ms < 300; ++ms) {
    Frames frames;
    if (ms % 20 == 0) {
      const int counter = ms / 20;
      frames = {
          node.from_pedestal(
              wire::Custody{.fact = wire::Fact::Take, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40},
              counter),
          node.from_pedestal(wire::NodeState{.state = StateId::Taken, .hold_stable = true, .f_low_dn = 400},
                             counter),
          node.from_pedestal(wire::Force{}, counter), node.from_pedestal(wire::Pneumatics{}, counter)};
    }
    node.step(frames);
    if (ms > 40) ++good_ms;
    ASSERT_EQ(node.state.release_guard.good_ms, good_ms) << ms << " ms: good from the third of both on";
    ASSERT_EQ(node.state.release_guard.peer_permits, good_ms >= 200);
  }
}

TEST(CanFdStep, lets_the_release_guard_doubt_in_the_step_that_gives_it_reason) {
  FdNode node;
  ASSERT_NO_FATAL_FAILURE(node.get_acquainted());
  wire::Custody take{.fact = wire::Fact::Take, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40};
  const wire::NodeState taken{.state = StateId::Taken, .hold_stable = true, .f_low_dn = 400};
  for (int counter = 0; counter < 4; ++counter)
    node.step({node.from_pedestal(take, counter), node.from_pedestal(taken, counter)}, 20);
  EXPECT_EQ(node.state.release_guard.good_ms, 20);
  wire::Custody other = take;
  other.token = 8;
  node.step({node.from_pedestal(other, 4), node.from_pedestal(take, 5)}, 20);
  EXPECT_EQ(node.state.release_guard.good_ms, 0) << "in between it was not good";
}

TEST(CanFdStep, lets_the_release_guard_see_no_frame_without_the_mac) {
  FdNode node;
  ASSERT_NO_FATAL_FAILURE(node.get_acquainted());
  for (int counter = 0; counter < 10; ++counter) {
    const wire::Label label{.node = kPedestal, .counter = static_cast<std::uint8_t>(counter)};
    node.step({wire::pack(
                  wire::Custody{.fact = wire::Fact::Take, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40},
                  label)},
              20);
  }
  EXPECT_EQ(node.state.release_guard.custody.counter, 15);
  EXPECT_FALSE(node.state.peers.find(kPedestal)->custody_fresh.running());
}

TEST(CanFdStep, counts_what_nobody_sealed_and_learns_nothing_from_it) {
  FdNode node;
  node.step({});
  for (const wire::Frame& frame : node.outputs.send.view()) (void)node.pedestal.open(kSharedKey, frame);
  auto answer = node.pedestal.speak(kSharedKey, 1);
  ASSERT_TRUE(answer);
  answer->tail[3] ^= 1U;
  node.step({*answer});
  EXPECT_FALSE(node.state.link.knows(kPedestal));
  EXPECT_EQ(node.state.link.refused(), 1U);
  wire::Frame nobodys = node.from_pedestal(wire::Force{});
  nobodys.id = 0x7F0;  // of no message
  node.step({nobodys});
  EXPECT_EQ(node.state.link.refused(), 2U);
  EXPECT_EQ(node.state.counters.bad_frames, 0U);
}

TEST(CanFdStep, counts_a_frame_that_is_authentic_and_means_nothing) {
  FdNode node;
  ASSERT_NO_FATAL_FAILURE(node.get_acquainted());
  node.step({node.from_pedestal(wire::Force{})});
  EXPECT_EQ(node.state.counters.bad_frames, 0U);
  wire::Frame bad = wire::pack(wire::Force{}, {.node = kPedestal});
  bad.data[0] ^= 1U;
  node.step({node.pedestal.seal(kSharedKey, bad), node.pedestal.seal(kSharedKey, bad)});
  EXPECT_EQ(node.state.counters.bad_frames, 2U);
}

TEST(CanFdStep, lets_its_link_speak_where_there_is_room_and_counts_what_is_left_out) {
  const wire::Frame hold = wire::pack(wire::hold_command(), {.node = kArm});
  std::size_t wanted_beside = 0;
  for (const std::size_t answers : {0U, 22U, 23U, 24U, 25U}) {
    FdNode node;
    node.state.store.record.custody = Custody::Sole;
    node.step(Frames(answers, hold));
    EXPECT_EQ(node.said_by_link(), answers < 24 ? 1 : 0) << answers << " answers before it";
    ASSERT_LE(node.outputs.send.size, SendQueue::kCapacity);
    if (answers == 0) wanted_beside = node.outputs.send.size;
    EXPECT_EQ(node.outputs.send.size + node.state.counters.frames_not_sent, answers + wanted_beside);
  }
}

TEST(CanFdStep, says_nothing_of_its_own_on_classic_can_or_with_a_number_that_is_not_stored) {
  FdNode node;
  node.state.config.can_fd = false;
  node.step({});
  EXPECT_EQ(node.said_by_link(), 0);
  FdNode unstored;
  unstored.state.frame_block = 1;
  unstored.state.store.requested = 1;
  unstored.step({});
  EXPECT_EQ(unstored.said_by_link(), 0);
  EXPECT_EQ(unstored.outputs.send.size, 0U);
}

}  // namespace
}  // namespace pinjaw::core::test

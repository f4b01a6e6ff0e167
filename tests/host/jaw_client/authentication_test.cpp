// Promises: AUTH-HOST.
#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <vector>

#include "host/jaw_client/client.hpp"
#include "host/jaw_client/command_channel.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/seal.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/host/jaw_client/nodes.hpp"

/// Hosts with the key, without it and with another one, against real controllers with and without a key.
namespace pinjaw::jaw_client {
namespace {

using testing::HasSubstr;
using wire::State;

constexpr wire::Key kKey{0xDE, 0xAD, 0xBE, 0xEF, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
constexpr wire::Key kOther{0xDE, 0xAD, 0xBE, 0xEF, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13};

/// A cell whose controllers have `nodes_key`, and a host with `hosts_key`.
class Keyed {
 public:
  Keyed(std::optional<wire::Key> nodes_key, std::optional<wire::Key> hosts_key, bool can_fd = false)
      : grips(keyed(nodes_key, can_fd)),
        client(*end, {.epoch = 0x4242, .key = hosts_key, .can_fd = can_fd, .nonces = 42}) {
    cell.kill_host_at(0);
    pass(200);
  }

  void pass(int ms) {
    for (int i = 0; i < ms; ++i) {
      cell.advance();
      client.step(std::int64_t{1000} * cell.now_ms());
    }
  }
  Outcome settled(std::uint8_t node, int patience_ms = 30'000) {
    for (int i = 0; i < patience_ms && client.outcome(node).pending(); ++i) pass(1);
    return client.outcome(node);
  }
  bool reaches(std::uint8_t node, State state, int patience_ms = 5000) {
    for (int i = 0; i < patience_ms && !client.node(node).in(state); ++i) pass(1);
    return client.node(node).in(state);
  }
  wire::Layout layout(std::uint8_t node) { return cell.layout_of(grips.at(node - 1U)); }
  Outcome send_and_arm(std::uint8_t node) {
    client.send_layout(node, layout(node));
    if (const Outcome sent = settled(node); !sent.done()) return sent;
    client.permit(node, true);
    client.arm(node, wire::layout_crc_of(layout(node)));
    return settled(node);
  }
  Outcome squeeze(std::uint8_t node) {
    const wire::Layout record = layout(node);
    wire::SqueezeForces forces;
    if (!record.passive) forces = {static_cast<std::uint16_t>(record.f_required_dn + 120), record.f_limit_dn};
    client.squeeze(node, forces);
    return settled(node);
  }
  bool hand_over(std::uint8_t giver, std::uint8_t receiver) {
    cell.ask(bench::Meet{{giver, receiver}});
    client.offer(giver, receiver);
    client.accept(receiver, giver);
    return settled(giver).done() && settled(receiver).done() && squeeze(receiver).done() &&
           reaches(receiver, State::Hold) && reaches(giver, State::Ready);
  }
  void load_pallet() {
    bench::Place place{.on = kPallet, .grasps = {}};
    for (const test::TestGrip& grip : grips)
      place.grasps.push_back({grip.node, grip.separation_mm, grip.needed_n});
    cell.ask(place);
    cell.ask(bench::Enable{.node = kPallet, .on = true});
    pass(300);
    client.close_light(kPallet);
    EXPECT_TRUE(settled(kPallet).done()) << client.outcome(kPallet).sentence;
    EXPECT_TRUE(squeeze(kPallet).done()) << client.outcome(kPallet).sentence;
  }
  const core::State& firmware(std::uint8_t node) { return cell.world().find(node)->firmware(); }

  static std::vector<test::TestGrip> keyed(const std::optional<wire::Key>& key, bool can_fd) {
    std::vector<test::TestGrip> grips = test::arm_pedestal_pallet();
    for (test::TestGrip& grip : grips) grip.key = key, grip.can_fd = can_fd;
    return grips;
  }

  std::vector<test::TestGrip> grips;
  test::TestCell cell{grips};
  std::unique_ptr<bus::Bus> end = cell.bus().open();
  Client client;
};

class HostOnEitherBus : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Buses, HostOnEitherBus, testing::Bool(),
                         [](const auto& fd) { return fd.param ? "can_fd" : "classic"; });

TEST_P(HostOnEitherBus, with_the_key_arms_and_hands_a_part_over) {
  Keyed keyed(kKey, kKey, GetParam());
  keyed.pass(600);
  for (const std::uint8_t node : {kArm, kPedestal, kPallet}) {
    const Outcome armed = keyed.send_and_arm(node);
    ASSERT_TRUE(armed.done()) << armed.sentence;
  }
  keyed.load_pallet();
  EXPECT_TRUE(keyed.hand_over(kPallet, kArm));
  EXPECT_TRUE(keyed.hand_over(kArm, kPedestal));
  EXPECT_FALSE(keyed.cell.truth().dropped);
  for (const std::uint8_t node : {kArm, kPedestal, kPallet})
    EXPECT_EQ(keyed.firmware(node).counters.wrong_macs, 0U);
}

TEST_P(HostOnEitherBus, with_the_key_arms_though_a_fifth_of_all_frames_is_lost) {
  Keyed keyed(kKey, kKey, GetParam());
  keyed.pass(600);
  ASSERT_TRUE(keyed.send_and_arm(kArm).done());
  keyed.cell.bus().add_fault({.kind = bus::FaultKind::Drop, .share = 0.2});
  int done = 0;
  for (int i = 0; i < 20; ++i) {
    keyed.client.arm(kArm, wire::layout_crc_of(keyed.layout(kArm)));
    if (keyed.settled(kArm).done()) ++done;
  }
  EXPECT_GE(done, 15);
  EXPECT_FALSE(keyed.firmware(kArm).lock_out.locked());
}

TEST(HostWithTheKey, takes_over_from_a_host_that_fell_silent) {
  Keyed keyed(kKey, kKey);
  ASSERT_TRUE(keyed.send_and_arm(kArm).done());
  Client next(*keyed.end, {.epoch = 0x4343, .key = kKey, .nonces = 43});
  next.permit(kArm, true);
  next.arm(kArm, wire::layout_crc_of(keyed.layout(kArm)));
  for (int i = 0; i < 3000 && next.outcome(kArm).pending(); ++i) {
    keyed.cell.advance();
    next.step(std::int64_t{1000} * keyed.cell.now_ms());
  }
  EXPECT_TRUE(next.outcome(kArm).done()) << next.outcome(kArm).sentence;
}

TEST(HostWithoutTheKey, is_told_that_the_controller_requires_authentication) {
  Keyed keyed(kKey, std::nullopt);
  const Outcome outcome = keyed.send_and_arm(kArm);
  EXPECT_EQ(outcome.kind, OutcomeKind::Refused);
  EXPECT_THAT(outcome.sentence, HasSubstr("node 1 requires authentication"));
  EXPECT_FALSE(keyed.firmware(kArm).gate.armed());
}

TEST(HostWithAnotherKey, learns_it_before_it_says_anything_that_counts_as_a_guess) {
  Keyed keyed(kKey, kOther);
  const Outcome outcome = keyed.send_and_arm(kArm);
  EXPECT_EQ(outcome.kind, OutcomeKind::Refused);
  EXPECT_THAT(outcome.sentence, HasSubstr("node 1 has another key"));
  EXPECT_EQ(keyed.firmware(kArm).counters.wrong_macs, 0U);
}

TEST(HostWithAKey, insists_on_controllers_that_have_it) {
  Keyed keyed(std::nullopt, kKey);
  const Outcome outcome = keyed.send_and_arm(kArm);
  EXPECT_EQ(outcome.kind, OutcomeKind::Refused);
  EXPECT_THAT(outcome.sentence, HasSubstr("node 1 has no key"));
  EXPECT_FALSE(keyed.firmware(kArm).gate.armed());
}

TEST(HostWithTheKey, releases_by_hand) {
  Keyed keyed(kKey, kKey);
  for (const std::uint8_t node : {kArm, kPallet}) ASSERT_TRUE(keyed.send_and_arm(node).done());
  keyed.load_pallet();
  ASSERT_TRUE(keyed.hand_over(kPallet, kArm));
  keyed.cell.ask(bench::Enable{.node = kArm, .on = true});
  keyed.pass(50);
  keyed.client.release(kArm);
  EXPECT_TRUE(keyed.settled(kArm).done()) << keyed.client.outcome(kArm).sentence;
}

/// Plays a node that answers the questions of `channel`: the number as `number`, the proof as of `proven`.
/// Gives how many sealed ARMs came.
int sealed_arms(CommandChannel& channel, std::uint32_t number, std::uint32_t proven, const wire::Key& key) {
  int arms = 0;
  for (std::int64_t now_us = 0; channel.state() == ChannelState::Waiting && now_us < 1'000'000;
       now_us += 1000) {
    const auto command = channel.due(now_us);
    if (!command) continue;
    const auto step = static_cast<wire::ArmStep>(command->argument);
    if (step == wire::ArmStep::Open) {
      ++arms;
      continue;
    }
    const std::uint32_t said = step == wire::ArmStep::Proof ? proven : number;
    channel.take({.sequence = command->sequence,
                  .op = wire::Op::Arm,
                  .result = wire::CommandResult::BadSession,
                  .session = wire::number_answer(key, kArm, step, said, wire::nonce_of(*command)),
                  .reason = wire::Reason::Authentication});
  }
  return arms;
}

TEST(HostWithTheKey, seals_nothing_for_a_number_that_is_not_proven) {
  const auto channel = [] {
    CommandChannel made;
    made.share(kArm, {kKey, 1});
    made.begin(wire::arm_command(0x123456, 77));
    return made;
  };
  CommandChannel honest = channel();
  EXPECT_GT(sealed_arms(honest, 70000, 70000, kKey), 0);
  CommandChannel misled = channel();
  EXPECT_EQ(sealed_arms(misled, 70005, 70000, kKey), 0)
      << "the node proves its own number, not the forged one";
  EXPECT_EQ(misled.state(), ChannelState::OtherKey);
  CommandChannel forged = channel();
  EXPECT_EQ(sealed_arms(forged, 70005, 70005, kOther), 0);
  EXPECT_EQ(forged.state(), ChannelState::OtherKey);
}

TEST(HostWithTheKey, asks_with_another_nonce_each_time) {
  CommandChannel channel;
  channel.share(kArm, {kKey, 1});
  channel.begin(wire::arm_command(0x123456, 77));
  const wire::Nonce first = wire::nonce_of(*channel.due(0));
  channel.begin(wire::arm_command(0x123456, 77));
  EXPECT_FALSE(wire::nonce_of(*channel.due(0)) == first);
}

}  // namespace
}  // namespace pinjaw::jaw_client

#include <gtest/gtest.h>

#include "host/jaw_client/client.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/names.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/host/jaw_client/nodes.hpp"

/// The client against real controllers: firmware, pneumatics and world, on a simulated bus.
namespace pinjaw::jaw_client {
namespace {

using wire::State;

class WithControllers : public ::testing::Test {
 protected:
  WithControllers() { cell.kill_host_at(0); }

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

  bool does(const bench::Request& request) { return std::holds_alternative<bench::Done>(cell.ask(request)); }

  wire::Layout layout(std::uint8_t node) { return cell.layout_of(grips.at(node - 1U)); }

  void arm(std::uint8_t node) {
    client.permit(node, true);
    client.arm(node, wire::layout_crc_of(layout(node)));
    const Outcome outcome = settled(node);
    ASSERT_TRUE(outcome.done()) << outcome.sentence;
  }
  void commission() {
    pass(200);
    for (const std::uint8_t node : {kArm, kPedestal, kPallet}) {
      client.send_layout(node, layout(node));
      const Outcome outcome = settled(node);
      ASSERT_TRUE(outcome.done()) << outcome.sentence;
      arm(node);
    }
  }
  wire::SqueezeForces forces(std::uint8_t node) {
    const wire::Layout record = layout(node);
    if (record.passive) return {};
    return {.set_dn = static_cast<std::uint16_t>(record.f_required_dn + 120), .permit_dn = record.f_limit_dn};
  }
  void squeeze(std::uint8_t node) {
    client.squeeze(node, forces(node));
    const Outcome outcome = settled(node);
    ASSERT_TRUE(outcome.done()) << outcome.sentence;
  }
  void hand_over(std::uint8_t giver, std::uint8_t receiver) {
    ASSERT_TRUE(does(bench::Meet{{giver, receiver}}));
    client.offer(giver, receiver);
    client.accept(receiver, giver);
    for (const std::uint8_t node : {giver, receiver}) {
      const Outcome outcome = settled(node);
      ASSERT_TRUE(outcome.done()) << outcome.sentence;
    }
    squeeze(receiver);
    ASSERT_TRUE(reaches(receiver, State::Hold));
    ASSERT_TRUE(reaches(giver, State::Ready));
  }
  void load_pallet() {
    bench::Place place{.on = kPallet, .grasps = {}};
    for (const test::TestGrip& grip : grips)
      place.grasps.push_back({grip.node, grip.separation_mm, grip.needed_n});
    ASSERT_TRUE(does(place));
    ASSERT_TRUE(does(bench::Enable{.node = kPallet, .on = true}));
    pass(300);
    client.close_light(kPallet);
    ASSERT_TRUE(settled(kPallet).done()) << client.outcome(kPallet).sentence;
    squeeze(kPallet);
  }

  std::vector<test::TestGrip> grips = test::arm_pedestal_pallet();
  test::TestCell cell{grips};
  std::unique_ptr<bus::Bus> end = cell.bus().open();
  Client client{*end, {.epoch = 0x4242}};
};

TEST_F(WithControllers, brings_a_layout_and_arms) {
  commission();
  for (const std::uint8_t node : {kArm, kPedestal, kPallet}) {
    EXPECT_TRUE(client.node(node).in(State::Ready) || reaches(node, State::Ready));
    EXPECT_TRUE(client.armed(node));
  }
  EXPECT_TRUE(reaches(kArm, State::Ready));
  pass(600);
  EXPECT_EQ(client.node(kArm).layout->layout_crc, wire::layout_crc_of(layout(kArm)));
}

TEST_F(WithControllers, proves_a_layout_by_arming_without_permission_and_leaves_it_loaded) {
  pass(200);
  client.send_layout(kArm, layout(kArm));
  ASSERT_TRUE(settled(kArm).done());
  client.arm(kArm, wire::layout_crc_of(layout(kArm)));
  ASSERT_TRUE(settled(kArm).done());
  client.disarm(kArm);
  ASSERT_TRUE(settled(kArm).done()) << client.outcome(kArm).sentence;
  EXPECT_TRUE(reaches(kArm, State::Loaded));
}

TEST_F(WithControllers, hands_the_part_on_and_back) {
  commission();
  load_pallet();
  ASSERT_TRUE(reaches(kPallet, State::Hold));
  hand_over(kPallet, kArm);
  hand_over(kArm, kPedestal);
  hand_over(kPedestal, kArm);
  EXPECT_FALSE(cell.truth().dropped);
}

/// An attempt may end anywhere, but never with the part on the floor.
TEST_F(WithControllers, drops_no_part_on_a_bus_that_loses_doubles_and_delays) {
  commission();
  load_pallet();
  const std::int64_t now_us = std::int64_t{1000} * cell.now_ms();
  for (const bus::FaultKind kind : {bus::FaultKind::Drop, bus::FaultKind::Duplicate, bus::FaultKind::Delay}) {
    cell.bus().add_fault({.kind = kind, .from_us = now_us, .share = 0.02, .delay_us = 5000});
  }
  ASSERT_TRUE(does(bench::Meet{{kPallet, kArm}}));
  int done = 0;
  for (int attempt = 0; attempt < 6; ++attempt) {
    const bool at_arm = client.node(kArm).in(State::Hold);
    const std::uint8_t giver = at_arm ? kArm : kPallet;
    const std::uint8_t receiver = at_arm ? kPallet : kArm;
    client.offer(giver, receiver);
    client.accept(receiver, giver);
    (void)settled(giver);
    if (settled(receiver).done()) {
      client.squeeze(receiver, forces(receiver));
      (void)settled(receiver);
    }
    if (reaches(receiver, State::Hold, 3000) && reaches(giver, State::Ready, 3000)) {
      ++done;
      continue;
    }
    client.abort(giver);
    (void)settled(giver);
    pass(1000);
    client.abort(receiver);
    (void)settled(receiver);
    pass(1000);
    for (const std::uint8_t node : {giver, receiver}) {
      client.arm(node, wire::layout_crc_of(layout(node)));
      (void)settled(node);
    }
  }
  EXPECT_GT(done, 0);
  EXPECT_FALSE(std::get<bench::Truth>(cell.ask(bench::AskTruth{})).dropped);
}

TEST_F(WithControllers, is_refused_a_squeeze_over_the_limit) {
  commission();
  load_pallet();
  ASSERT_TRUE(does(bench::Meet{{kPallet, kArm}}));
  client.offer(kPallet, kArm);
  client.accept(kArm, kPallet);
  ASSERT_TRUE(settled(kArm).done()) << client.outcome(kArm).sentence;
  client.squeeze(kArm, {.set_dn = 1390, .permit_dn = 1400});
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::ForceRefused);
  client.squeeze(kArm, {.set_dn = 1390, .permit_dn = 1600});
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::ForceRefused);
}

TEST_F(WithControllers, is_refused_a_layout_that_needs_more_than_the_hardware) {
  pass(200);
  wire::Layout heavy = layout(kArm);
  heavy.f_limit_dn = 2000;
  heavy.peer_count = 0;
  client.send_layout(kArm, heavy);
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::ForceRefused) << client.outcome(kArm).sentence;
}

TEST_F(WithControllers, releases_by_hand_only_with_the_local_enable) {
  commission();
  load_pallet();
  hand_over(kPallet, kArm);
  client.release(kArm);
  EXPECT_EQ(settled(kArm).kind, OutcomeKind::Refused) << client.outcome(kArm).sentence;
  EXPECT_TRUE(client.node(kArm).in(State::Hold));
  ASSERT_TRUE(does(bench::Enable{.node = kArm, .on = true}));
  pass(50);
  client.release(kArm);
  EXPECT_TRUE(settled(kArm).done()) << client.outcome(kArm).sentence;
}

TEST_F(WithControllers, takes_over_from_a_host_that_fell_silent) {
  commission();
  load_pallet();
  Client next(*end, {.epoch = 0x4343});
  next.permit(kPallet, true);
  next.arm(kPallet, wire::layout_crc_of(layout(kPallet)));
  for (int i = 0; i < 3000 && next.outcome(kPallet).pending(); ++i) {
    cell.advance();
    next.step(std::int64_t{1000} * cell.now_ms());
  }
  EXPECT_TRUE(next.outcome(kPallet).done()) << next.outcome(kPallet).sentence;
}

}  // namespace
}  // namespace pinjaw::jaw_client

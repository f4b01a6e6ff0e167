// Promises: I3, I4, I5, R1, R6, T-GUARD, BUS-OFF, AUTH-FD.
#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "firmware_sim/core/transitions.hpp"
#include "protocol/wire/services.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// What one step does with frames, time, sensors, memory and the bus.
namespace pinjaw::core::test {
namespace {

using enum wire::State;
using wire::FaultCode;
using Frames = std::vector<wire::Frame>;

struct Node {
  State state;
  Outputs outputs{};
  Inputs inputs{};

  explicit Node(const State& made) : state(made) {
    inputs.sensors.close_mbar = {2500, 2500};  // 52.8 N at least
    inputs.sensors.supply_mbar = 6000;
    inputs.sensors.separation_10um = 3000;
  }
  void step(const Frames& frames = {}, std::uint32_t elapsed_ms = 1) {
    inputs.received = frames;
    inputs.elapsed_ms = elapsed_ms;
    core::step(state, inputs, outputs);
  }
  /// How many messages of that kind it said in its last step.
  [[nodiscard]] std::size_t said(wire::MessageType type) const {
    std::size_t count = 0;
    for (const wire::Frame& frame : outputs.send.view()) {
      const auto identifier = wire::identify(frame.id);
      count += identifier && identifier->type == type && identifier->node == kArm ? 1 : 0;
    }
    return count;
  }
};

template <class Message>
wire::Frame from(std::uint8_t node, const Message& message, std::uint8_t counter = 0) {
  return wire::pack(message, {.node = node, .counter = counter});
}

TEST(Listening, answers_commands_and_requests_to_this_node_alone) {
  const wire::Command hold = wire::hold_command();
  wire::Payload request{2, 0xEE, 9};
  for (const std::uint8_t node : {kArm, kPedestal}) {
    Node one(held(Hold));
    one.step({wire::pack(hold, {.node = node})});
    EXPECT_EQ(one.said(wire::MessageType::Acknowledge), node == kArm ? 1U : 0U);
    Node other(held(Hold));
    other.step({wire::pack_segment({{wire::MessageType::TransferRequest, node}, request})});
    EXPECT_EQ(other.said(wire::MessageType::TransferResponse), node == kArm ? 1U : 0U);
    Node third(held(Hold));
    third.step({wire::pack_segment({{wire::MessageType::TransferResponse, node}, request})});
    EXPECT_EQ(third.said(wire::MessageType::TransferResponse), 0U);
  }
}

TEST(Listening, hears_hosts_neighbours_and_everyones_hold) {
  Node node(held(Ready));
  node.state.host = {};
  for (std::uint8_t counter = 0; counter < 3; ++counter) {
    node.step({from(0, wire::HostHeartbeat{.permit = 1, .epoch = 9}, counter),
               from(kPedestal, wire::Custody{.fact = wire::Fact::Sole, .f_low_n = 4}, counter),
               from(kPedestal, wire::NodeState{.state = Hold}, counter)});
  }
  EXPECT_TRUE(node.state.host.permits());
  EXPECT_EQ(node.state.host.epoch(), 9);
  EXPECT_EQ(node.state.peers.find(kPedestal)->custody.fact, wire::Fact::Sole);
  EXPECT_EQ(node.state.peers.find(kPedestal)->state.state, Hold);
  EXPECT_FALSE(node.state.peers.find(kPedestal)->faulty.running());
  node.step(
      {from(kPedestal,
            wire::FaultReport{.code = FaultCode::Slip, .severity = wire::Severity::Hold, .active = true})});
  EXPECT_TRUE(node.state.peers.find(kPedestal)->faulty.running());
  EXPECT_FALSE(node.state.frozen);
  node.step({from(kPedestal, wire::GlobalHold{})});
  EXPECT_TRUE(node.state.frozen);
  EXPECT_FALSE(node.state.faults.active(FaultCode::OwnIdSeen));
  EXPECT_EQ(node.state.counters.bad_frames, 0U);
}

TEST(Listening, notices_another_node_with_its_own_id_whatever_that_says) {
  const auto frames_of = [](std::uint8_t node) {
    return Frames{from(node, wire::Custody{}),     from(node, wire::NodeState{}),
                  from(node, wire::FaultReport{}), from(node, wire::Force{}),
                  from(node, wire::Pneumatics{}),  from(node, wire::LayoutStatus{}),
                  from(node, wire::Acknowledge{}), from(node, wire::Identity{})};
  };
  for (const wire::Frame& frame : frames_of(kArm)) {
    Node node(held(Ready));
    node.step({frame});
    EXPECT_TRUE(node.state.faults.active(FaultCode::OwnIdSeen)) << frame.id;
  }
  Node node(held(Ready));
  node.step(frames_of(kPedestal));
  node.step({from(0, wire::HostTime{})});
  EXPECT_FALSE(node.state.faults.active(FaultCode::OwnIdSeen));
  EXPECT_EQ(node.state.counters.bad_frames, 0U);
  wire::Frame bad = from(kPedestal, wire::Force{});
  bad.data[0] ^= 1U;
  node.step({bad, bad});
  EXPECT_EQ(node.state.counters.bad_frames, 2U);
}

TEST(Time, passes_for_hosts_neighbours_timers_and_lock_outs) {
  Node node(held(Hold));
  hear_peer(node.state, kPedestal, {.fact = wire::Fact::Sole, .f_low_n = 4});
  node.state.timers.state.start(100);
  node.state.timers.challenge.start(100);
  for (int miss = 0; miss < 3; ++miss) node.state.lock_out.miss();
  node.step({}, 69);
  EXPECT_TRUE(node.state.peers.find(kPedestal)->fresh());
  EXPECT_EQ(node.state.timers.state.left_ms(), 31);
  EXPECT_EQ(node.state.timers.challenge.left_ms(), 31);
  node.step();
  EXPECT_FALSE(node.state.peers.find(kPedestal)->fresh());
  EXPECT_TRUE(node.state.host.alive());
  node.step({}, 129);
  EXPECT_TRUE(node.state.host.alive());
  node.step();
  EXPECT_FALSE(node.state.host.alive());
  EXPECT_EQ(node.state.counters.steps, 4U);
  node.state.frozen = true;
  node.state.timers.state.start(65'000);
  node.step({}, 59'799);
  EXPECT_TRUE(node.state.lock_out.locked());
  EXPECT_EQ(node.state.timers.state.left_ms(), 65'000) << "a frozen jaw is given its time back";
  node.step();
  EXPECT_FALSE(node.state.lock_out.locked());
  node.state.frozen = false;
  node.step({}, 70'000);
  EXPECT_EQ(node.state.timers.state.left_ms(), 5'000) << "a minute at most";
}

/// An approach has its time while it may move, and only then.
TEST(Time, of_an_approach_passes_while_it_is_permitted) {
  for (const auto& [armed, permit, passes] :
       {std::tuple{true, true, true}, {true, false, false}, {false, true, false}}) {
    Node node(made(Seating));
    node.state.host = {};
    hear_host(node.state, 77, permit);
    if (!armed) node.state.gate.close();
    node.state.timers.state.start(100);
    node.step({}, 60);
    EXPECT_EQ(node.state.timers.state.left_ms(), passes ? 40 : 100) << armed << permit;
  }
}

TEST(Reacting, does_four_things_in_a_step_and_the_fifth_in_the_next) {
  Node node(taken(wire::Fact::Offer));
  node.state.measurement.troubled_ms = 10;
  node.inputs.sensors.separation_10um = 9000;  // a position that cannot be
  node.inputs.nvm.failed = true;               // a memory that does not store
  node.state.store.requested = 1;
  node.state.peers.advance(70);    // a giver that is silent
  node.state.timers.state.stop();  // for 2 s
  node.state.bad_hold_ms = 100;    // and a hold that is lost
  node.inputs.sensors.close_mbar = {0, 0};
  node.step();
  const auto active = [&node](FaultCode code) { return node.state.faults.active(code); };
  EXPECT_TRUE(active(FaultCode::Position) && active(FaultCode::CustodyMemory) && active(FaultCode::PeerLost));
  EXPECT_TRUE(active(FaultCode::InDoubt));
  EXPECT_FALSE(active(FaultCode::HoldLost));
  node.step();
  EXPECT_TRUE(active(FaultCode::HoldLost));
}

TEST(Reacting, ends_with_an_event_that_the_table_ignores) {
  static const StateTable deaf = [] {
    StateTable table{};
    for (auto& row : table) row.fill(Cell::Ig);
    return table;
  }();
  Node node(held(Hold));
  node.state.config.table = &deaf;
  node.state.bad_hold_ms = 100;
  node.inputs.sensors.close_mbar = {0, 0};
  node.step();
  EXPECT_EQ(node.state.counters.events_ignored, 1U);
}

TEST(Bus, that_falls_silent_stops_the_jaws_and_makes_all_qualify_again_when_it_is_back) {
  for (const bool committed : {true, false}) {
    Node node(held(Ready));
    hear_peer(node.state, kPedestal, {.fact = wire::Fact::Sole, .f_low_n = 4});
    node.step();
    EXPECT_FALSE(node.state.frozen);
    EXPECT_FALSE(node.outputs.restart_bus);
    node.inputs.bus.off = true;
    node.step();
    EXPECT_TRUE(node.state.frozen);
    EXPECT_TRUE(node.outputs.restart_bus);
    EXPECT_TRUE(node.state.host.alive());
    node.state.layouts.committed = committed;
    node.state.release_guard.good_ms = 99;
    node.state.release_guard.peer_permits = true;
    node.state.release_guard.decided_before = true;
    node.inputs.bus.off = false;
    node.step();
    EXPECT_FALSE(node.state.release_guard.peer_permits);
    EXPECT_FALSE(node.state.host.alive());
    EXPECT_EQ(node.state.peers.find(kPedestal)->custody_fresh.running(), !committed);
    EXPECT_EQ(node.state.release_guard.good_ms, 0);
    EXPECT_FALSE(node.outputs.restart_bus);
  }
}

/// The pedestal says for 200 ms that it holds the arm's token 7 with `force_dn`.
void hear_hold(Node& node, std::uint16_t force_dn) {
  for (int ms = 0; ms < 264; ++ms) {
    Frames frames;
    const auto counter = static_cast<std::uint8_t>(ms / 20 % 15);
    if (ms % 20 == 0) {
      frames = {
          from(kPedestal,
               wire::Custody{.fact = wire::Fact::Take, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40},
               counter),
          from(kPedestal, wire::NodeState{.state = Taken, .hold_stable = true, .f_low_dn = force_dn},
               counter)};
    }
    node.step(frames);
  }
}

Node giver(Custody custody, bool committed = true) {
  Node node(held(Hold));  // where no event takes the record away
  node.state.store.record = {.custody = custody, .peer = kPedestal, .token = 7, .pair = 8};
  node.state.layouts.committed = committed;
  return node;
}

TEST(Release, is_watched_by_what_record_and_layout_say_of_the_peer) {
  for (const auto& [force_dn, committed, permits] :
       {std::tuple{400, true, true}, {399, true, false}, {399, false, true}, {0, false, true}}) {
    Node node = giver(Custody::Offered, committed);
    hear_hold(node, static_cast<std::uint16_t>(force_dn));
    EXPECT_EQ(node.state.release_guard.peer_permits, permits) << force_dn << ' ' << committed;
  }
  for (const Custody custody :
       {Custody::Empty, Custody::Sole, Custody::Latched, Custody::Released, Custody::Retained}) {
    Node node = giver(custody);
    hear_hold(node, 400);
    EXPECT_FALSE(node.state.release_guard.peer_permits) << "no handoff is under way";
    EXPECT_EQ(node.state.release_guard.peer, 0);
  }
}

TEST(Release, by_hand_is_watched_with_the_challenge_while_it_may_be_answered) {
  for (const bool running : {true, false}) {
    for (const std::uint16_t answer : {std::uint16_t{1}, std::uint16_t{1415}}) {
      Node node(held(Hold));
      node.inputs.sensors.local_enable = true;
      node.state.release_guard.asked.start(3000);
      node.state.challenge = 1415;
      if (running) node.state.timers.challenge.start(3000);
      node.step({wire::pack(wire::manual_release_answer(answer), {.node = kArm})});
      EXPECT_EQ(node.state.release_guard.hand_permits, running && answer == 1415) << running << answer;
    }
  }
}

TEST(Release, that_was_decided_before_a_restart_is_remembered_while_the_record_says_so) {
  for (const Custody custody : {Custody::Offered, Custody::Decided, Custody::Released}) {
    Node node = giver(custody);
    node.state.release_guard.decided_before = true;
    node.step();
    EXPECT_EQ(node.state.release_guard.decided_before, custody == Custody::Decided);
  }
}

TEST(Valves, open_where_both_channels_want_it_and_close_where_one_does) {
  Node node = giver(Custody::Decided);
  node.state.id = Opening;
  node.state.timers.state.start(1000);
  node.step();
  EXPECT_EQ(node.outputs.valves.spool, Spool::Hold);
  node.state.release_guard.decided_before = true;
  node.step();
  EXPECT_EQ(node.outputs.valves.spool, Spool::Open);
  Node holder = giver(Custody::Sole);
  holder.state.force_set_dn = 900;
  holder.step();
  EXPECT_EQ(holder.outputs.valves.spool, Spool::Close);
  Node pallet = giver(Custody::Decided);
  pallet.state.id = Opening;
  pallet.state.config.passive = true;
  pallet.state.release_guard.decided_before = true;
  pallet.step();
  EXPECT_EQ(pallet.outputs.valves, Valves{});
}

TEST(Memory, is_given_what_both_channels_want_stored) {
  Node node = giver(Custody::Decided);
  node.state.store.record_waits = true;
  node.outputs.nvm.emplace();  // of an earlier step
  node.step();
  EXPECT_FALSE(node.outputs.nvm.has_value());
  EXPECT_TRUE(node.state.faults.active(FaultCode::MemorySelfTest));
  node.state.release_guard.decided_before = true;
  node.step();
  ASSERT_TRUE(node.outputs.nvm && node.outputs.nvm->record);
  EXPECT_EQ(node.outputs.nvm->record->custody, Custody::Decided);
  EXPECT_EQ(node.outputs.nvm->sequence, 1);
  EXPECT_FALSE(node.state.store.durable());
  node.inputs.nvm.done = 1;
  node.step();
  EXPECT_FALSE(node.outputs.nvm.has_value());
  EXPECT_TRUE(node.state.store.durable());
}

TEST(Facts, are_said_in_the_step_that_knows_them_stored) {
  Node node = giver(Custody::Sole);
  node.step();
  EXPECT_EQ(node.state.announced.fact, wire::Fact::Sole);
  EXPECT_EQ(node.said(wire::MessageType::Custody), 1U);
  node.step();
  EXPECT_EQ(node.outputs.send.size, 0U) << "what was sent is not sent again";
}

TEST(Queue, holds_24_frames_and_counts_what_it_has_no_room_for) {
  const wire::Frame hold = wire::pack(wire::hold_command(), {.node = kArm});
  Node node(held(Hold));
  node.step();
  const std::size_t own = node.outputs.send.size;
  for (const std::size_t more : {std::size_t{0}, std::size_t{1}, own}) {
    Node full(held(Hold));
    full.step(Frames(24 - own + more, hold));
    EXPECT_EQ(full.outputs.send.size, 24U);
    EXPECT_EQ(full.state.counters.frames_not_sent, more);
  }
}

}  // namespace
}  // namespace pinjaw::core::test

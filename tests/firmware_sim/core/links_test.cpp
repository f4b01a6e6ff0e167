// Promises: I5, R7, R8, BUS-OFF.
#include <gtest/gtest.h>

#include "firmware_sim/core/bus_link.hpp"
#include "firmware_sim/core/custody.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// Which neighbours a controller hears, for how long it believes them, and what it says itself.
namespace pinjaw::core::test {
namespace {

struct Neighbours : testing::Test {
  Neighbours() { peers.follow(layout_for(kArm)); }
  void custody(std::uint8_t node, std::uint8_t counter, const wire::Custody& said) {
    peers.hear(wire::Received<wire::Custody>{{node, counter}, said});
  }
  void fault(std::uint8_t counter, wire::Severity severity, bool active) {
    peers.hear(wire::Received<wire::FaultReport>{
        {kPedestal, counter}, {.code = wire::FaultCode::Slip, .severity = severity, .active = active}});
  }
  Peers peers;
};

TEST_F(Neighbours, are_those_of_the_layout) {
  EXPECT_NE(peers.find(kPedestal), nullptr);
  EXPECT_NE(peers.find(kPallet), nullptr);
  EXPECT_EQ(peers.find(kArm), nullptr);
  EXPECT_EQ(peers.find(0), nullptr) << "an unused place is nobody's";
  EXPECT_EQ(peers.find(9), nullptr);
  wire::Layout full = layout_for(kArm);
  full.peer_count = 4;
  full.peers[2].node = 7;
  full.peers[3].node = 8;
  peers.follow(full);
  EXPECT_NE(peers.find(8), nullptr);
  custody(9, 0, {});
  custody(0, 0, {});
}

TEST_F(Neighbours, are_fresh_for_70_ms_after_a_third_frame_in_order) {
  const Peer& peer = *peers.find(kPedestal);
  for (std::uint8_t counter = 0; counter < 3; ++counter) {
    EXPECT_FALSE(peer.custody_fresh.running());
    custody(kPedestal, counter, {.fact = wire::Fact::Sole, .f_low_n = 4});
    EXPECT_FALSE(peer.fresh()) << "its state was not heard";
  }
  EXPECT_EQ(peer.custody.fact, wire::Fact::Sole);
  EXPECT_FALSE(peers.find(kPallet)->custody_fresh.running());
  for (std::uint8_t counter = 0; counter < 3; ++counter) {
    EXPECT_FALSE(peer.fresh());
    peers.hear(wire::Received<wire::NodeState>{{kPedestal, counter}, {.state = StateId::Hold}});
  }
  EXPECT_TRUE(peer.fresh());
  EXPECT_EQ(peer.state.state, StateId::Hold);
  peers.advance(69);
  EXPECT_TRUE(peer.fresh());
  custody(kPedestal, 3, {.fact = wire::Fact::Sole, .f_low_n = 4});
  peers.advance(1);
  EXPECT_FALSE(peer.fresh()) << "its state is old";
  EXPECT_TRUE(peer.custody_fresh.running());
  peers.advance(69);
  EXPECT_FALSE(peer.custody_fresh.running());
}

TEST_F(Neighbours, keep_the_outcome_of_a_past_handoff_beside_the_present_fact) {
  for (std::uint8_t counter = 0; counter < 3; ++counter) {
    custody(kPedestal, counter, {.fact = wire::Fact::Take, .token = 8, .f_low_n = 4});
  }
  custody(kPedestal, 3, {.fact = wire::Fact::Released, .token = 7});
  const Peer& peer = *peers.find(kPedestal);
  EXPECT_EQ(peer.custody.fact, wire::Fact::Take);
  EXPECT_EQ(peer.past.fact, wire::Fact::Released);
  EXPECT_EQ(peer.past.token, 7);
}

TEST_F(Neighbours, are_faulty_for_320_ms_after_a_report_for_which_they_must_hold) {
  const Peer& peer = *peers.find(kPedestal);
  EXPECT_FALSE(peer.faulty.running());
  fault(0, wire::Severity::Warning, true);
  EXPECT_FALSE(peer.faulty.running());
  fault(1, wire::Severity::Hold, false);
  EXPECT_FALSE(peer.faulty.running());
  fault(2, wire::Severity::Hold, true);
  peers.advance(319);
  EXPECT_TRUE(peer.faulty.running());
  peers.advance(1);
  EXPECT_FALSE(peer.faulty.running());
  fault(3, wire::Severity::Latched, true);
  EXPECT_TRUE(peer.faulty.running());
  fault(4, wire::Severity::Warning, false);
  EXPECT_TRUE(peer.faulty.running()) << "a warning that went";
  fault(5, wire::Severity::Hold, false);
  EXPECT_TRUE(peer.faulty.running()) << "one that went, where another may be there";
  peers.advance(320);
  fault(5, wire::Severity::Hold, true);
  EXPECT_FALSE(peer.faulty.running()) << "a repeated frame";
  fault(6, wire::Severity::Hold, true);
  EXPECT_TRUE(peer.faulty.running());
}

TEST(BusLink, recovers_three_times_in_ten_seconds_counted_from_each) {
  BusLink bus;
  EXPECT_FALSE(bus.off());
  EXPECT_FALSE(bus.restart());
  const auto fall_and_rise = [&bus] {
    bus.observe({.off = true}, 1);
    EXPECT_TRUE(bus.off());
    EXPECT_TRUE(bus.fell_off());
    EXPECT_FALSE(bus.recovered());
    const bool restarts = bus.restart();
    bus.observe({.off = true}, 1);
    EXPECT_FALSE(bus.fell_off());
    EXPECT_FALSE(bus.recovered());
    EXPECT_EQ(bus.restart(), restarts) << "asked for until it happens";
    bus.observe({}, 1);
    EXPECT_TRUE(bus.recovered());
    EXPECT_FALSE(bus.restart());
    bus.observe({}, 1);
    EXPECT_FALSE(bus.recovered());
    return restarts;
  };
  EXPECT_TRUE(fall_and_rise());
  EXPECT_TRUE(fall_and_rise());
  EXPECT_TRUE(fall_and_rise());
  bus.observe({}, 9988);  // 10 s but one millisecond after the first
  bus.observe({}, 0);
  EXPECT_TRUE(fall_and_rise()) << "the first one is 10 s ago with the step of the fall";
  BusLink hasty;
  for (int i = 0; i < 3; ++i) {
    hasty.observe({.off = true}, 0);
    hasty.observe({}, 0);
  }
  hasty.observe({.off = true}, 9999);
  EXPECT_FALSE(hasty.restart());
  hasty.observe({}, 60'000);
  hasty.observe({.off = true}, 60'000);
  EXPECT_FALSE(hasty.restart()) << "given up for good";
}

TEST(BusLink, tells_passive_and_overruns_as_they_come) {
  BusLink bus;
  bus.observe({.passive = true, .overruns = 2}, 1);
  EXPECT_TRUE(bus.passive());
  EXPECT_TRUE(bus.overran());
  bus.observe({.overruns = 2}, 1);
  EXPECT_FALSE(bus.passive());
  EXPECT_FALSE(bus.overran());
  bus.observe({.overruns = 3}, 1);
  EXPECT_TRUE(bus.overran());
}

TEST(Tokens, are_new_in_the_half_window_ahead_of_the_last_one_of_that_giver) {
  NvmRecord record;
  EXPECT_TRUE(token_is_new(record, 3, 0)) << "none was heard of before";
  remember_token(record, 3, 100);
  EXPECT_EQ(record.last_token[3], 100);
  EXPECT_EQ(record.seen_givers, 1U << 3);
  EXPECT_FALSE(token_is_new(record, 3, 100));
  EXPECT_FALSE(token_is_new(record, 3, 99));
  EXPECT_TRUE(token_is_new(record, 3, 101));
  EXPECT_TRUE(token_is_new(record, 3, 100 + 0x7FFF));
  EXPECT_FALSE(token_is_new(record, 3, 100 + 0x8000));
  EXPECT_TRUE(token_is_new(record, 2, 1)) << "another giver's";
  EXPECT_TRUE(token_is_new(record, 4, 1));
  remember_token(record, 0, 5);
  EXPECT_EQ(record.seen_givers, 1U << 3 | 1U);
  EXPECT_FALSE(token_is_new(record, 0, 5));
  remember_token(record, 15, 0xFFFF);
  EXPECT_TRUE(token_is_new(record, 15, 0)) << "over the wrap";
  EXPECT_FALSE(token_is_new(record, 16, 1)) << "there is no such node";
  const NvmRecord before = record;
  remember_token(record, 16, 9);
  EXPECT_EQ(record, before);
}

TEST(Store, is_durable_when_what_was_asked_for_last_is_done) {
  Store store;
  EXPECT_TRUE(store.durable());
  EXPECT_TRUE(store.readable);
  NvmRecord record;
  record.token = 9;
  to_store(store) = record;
  EXPECT_FALSE(store.durable());
  std::optional<NvmWrite> write;
  flush(store, wire::Layout{}, write);
  ASSERT_TRUE(write.has_value());
  EXPECT_EQ(write->sequence, 1);
  EXPECT_EQ(write->record, record);
  EXPECT_FALSE(write->layout.has_value());
  EXPECT_FALSE(store.durable());
  acknowledge(store, {.done = 1, .failed = true});
  EXPECT_TRUE(store.durable()) << "a failure of something older";
  flush(store, wire::Layout{}, write);
  EXPECT_FALSE(write.has_value()) << "nothing more to store";
  store.layout_waits = true;
  EXPECT_FALSE(store.durable());
  flush(store, layout_for(kArm), write);
  ASSERT_TRUE(write && write->layout);
  EXPECT_EQ(write->sequence, 2);
  EXPECT_FALSE(write->record.has_value());
  EXPECT_EQ(write->layout->size, wire::encode(layout_for(kArm)).size);
  acknowledge(store, {.done = 1, .failed = false});
  EXPECT_FALSE(store.failed) << "it takes its time";
  acknowledge(store, {.done = 1, .failed = true});
  EXPECT_TRUE(store.failed);
  EXPECT_FALSE(store.durable());
  acknowledge(store, {.done = 2, .failed = false});
  EXPECT_TRUE(store.durable());
}

TEST(Custodies, of_a_part_are_all_but_empty_and_released) {
  for (int custody = 0; custody <= 6; ++custody) {
    EXPECT_EQ(has_custody(static_cast<Custody>(custody)), custody != 0 && custody != 5) << custody;
  }
}

wire::Fact said_with(
    Custody custody, StateId id, void (*change)(State&) = [](State&) {}) {
  State state = made(id);
  state.store.record.custody = custody;
  state.store.record.peer = kPedestal;
  state.store.record.token = 3;
  state.store.record.pair = 4;
  change(state);
  announce(state);
  if (state.announced.fact != wire::Fact::Unknown && state.announced.fact != wire::Fact::Empty) {
    EXPECT_EQ(state.announced, (Announcement{state.announced.fact, kPedestal, 3, 4}));
  }
  return state.announced.fact;
}

TEST(Facts, are_said_as_the_record_stands) {
  using wire::Fact;
  EXPECT_EQ(said_with(Custody::Empty, StateId::Ready), Fact::Empty);
  EXPECT_EQ(said_with(Custody::Sole, StateId::Hold), Fact::Sole);
  EXPECT_EQ(said_with(Custody::Offered, StateId::Offered), Fact::Offer);
  EXPECT_EQ(said_with(Custody::Offered, StateId::Relax), Fact::Offer);
  EXPECT_EQ(said_with(Custody::Offered, StateId::Resqueeze), Fact::Unknown);
  EXPECT_EQ(said_with(Custody::Decided, StateId::Opening), Fact::Unknown);
  EXPECT_EQ(said_with(Custody::Released, StateId::Ready), Fact::Released);
}

TEST(Facts, wait_for_the_hold_that_they_stand_for) {
  using wire::Fact;
  EXPECT_EQ(said_with(Custody::Latched, StateId::Taken), Fact::Unknown);
  EXPECT_EQ(said_with(Custody::Latched, StateId::Taken, [](State& s) { s.hold_proven = true; }), Fact::Take);
  EXPECT_EQ(said_with(Custody::Retained, StateId::Hold, [](State& s) { squeeze_with(s, 519); }),
            Fact::Unknown);
  EXPECT_EQ(said_with(Custody::Retained, StateId::Hold, [](State& s) { squeeze_with(s, 520); }),
            Fact::Retain);
  EXPECT_EQ(said_with(Custody::Retained, StateId::Hold,
                      [](State& s) {
                        s.announced = {wire::Fact::Retain, kPedestal, 2, 2};
                        squeeze_with(s, 0);
                      }),
            Fact::Retain)
      << "said once, it stays true";
}

TEST(Facts, are_not_said_before_they_are_stored_or_of_a_memory_that_cannot_be_read) {
  using wire::Fact;
  EXPECT_EQ(said_with(Custody::Sole, StateId::Hold, [](State& s) { s.store.record_waits = true; }),
            Fact::Unknown);
  EXPECT_EQ(said_with(Custody::Sole, StateId::Hold, [](State& s) { s.store.layout_waits = true; }),
            Fact::Unknown);
  EXPECT_EQ(said_with(Custody::Latched, StateId::Taken,
                      [](State& s) {
                        s.hold_proven = true;
                        s.store.record_waits = true;
                      }),
            Fact::Unknown);
  EXPECT_EQ(said_with(Custody::Sole, StateId::Hold, [](State& s) { s.store.failed = true; }), Fact::Unknown);
  EXPECT_EQ(said_with(Custody::Sole, StateId::Hold, [](State& s) { s.store.requested = 1; }), Fact::Unknown);
  EXPECT_EQ(said_with(Custody::Sole, StateId::Hold, [](State& s) { s.store.readable = false; }),
            Fact::Unknown);
}

}  // namespace
}  // namespace pinjaw::core::test

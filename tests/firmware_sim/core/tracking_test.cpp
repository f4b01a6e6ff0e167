// Promises: I2, I3, I5, R2, R4.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "firmware_sim/core/events.hpp"
#include "protocol/wire/names.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// What ages with time and which faults are conditions, in each state and to the millisecond.
namespace pinjaw::core::test {
namespace {

using enum wire::State;
using wire::FaultCode;
using Change = void (*)(State&);

bool answers(StateId id) {
  return id == Taken || id == Hold || id == Offered;
}

TEST(Tracking, a_hold_counts_towards_stable_where_jaws_grip_and_only_while_it_is_good) {
  for (std::size_t s = 0; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    const bool gripping = holds(id) || id == Squeezing || id == Resqueeze;
    State state = held(id);
    state.timers.stable.start(100);
    track(state, 10);
    EXPECT_EQ(state.timers.stable.left_ms(), gripping ? 90 : 150) << s;
    EXPECT_FALSE(state.hold_proven);
    squeeze_with(state, 519);
    track(state, 10);
    EXPECT_EQ(state.timers.stable.left_ms(), 150) << s;
  }
}

TEST(Tracking, a_stable_hold_is_proven_and_no_longer_lost_where_a_node_answers_for_it) {
  for (std::size_t s = 0; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    State state = held(id);
    state.timers.stable.start(10);
    state.faults.raise(FaultCode::HoldLost);
    track(state, 9);
    EXPECT_FALSE(state.hold_proven);
    EXPECT_TRUE(state.faults.active(FaultCode::HoldLost));
    track(state, 1);
    EXPECT_EQ(state.hold_proven, answers(id)) << s;
    EXPECT_EQ(state.faults.active(FaultCode::HoldLost), !answers(id)) << s;
  }
}

TEST(Tracking, a_weak_hold_is_timed_up_to_100_ms_where_a_node_answers_for_it) {
  for (std::size_t s = 0; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    State state = held(id);
    squeeze_with(state, 519);
    state.bad_hold_ms = 5;
    track(state, 7);
    EXPECT_EQ(state.bad_hold_ms, answers(id) ? 12 : 0) << s;
    track(state, 88);
    EXPECT_EQ(state.bad_hold_ms, answers(id) ? 100 : 0) << s;
    track(state, 1);
    EXPECT_EQ(state.bad_hold_ms, answers(id) ? 100 : 0) << s;
    squeeze_with(state, 520);
    track(state, 1);
    EXPECT_EQ(state.bad_hold_ms, 0) << s;
  }
}

TEST(Tracking, whose_part_it_is_is_forgotten_only_with_the_jaws_fully_open) {
  for (std::size_t s = 0; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    State state = held(id);
    state.receiving = {.giver = kPedestal, .token = 7, .pair = 8, .retained = true};
    state.measurement.separation_10um = 4949;
    track(state, 1);
    EXPECT_EQ(state.receiving.giver, kPedestal) << s;
    state.measurement.separation_10um = 5000;
    State bare = state;
    bare.layouts.committed = false;
    track(bare, 1);
    EXPECT_EQ(bare.receiving.giver, kPedestal) << s;
    track(state, 1);
    const bool open = id == Loaded || id == Ready;
    EXPECT_EQ(state.receiving.giver, open ? 0 : kPedestal) << s;
    EXPECT_EQ(state.receiving.token, open ? 0 : 7) << s;
    EXPECT_EQ(state.receiving.retained, !open) << s;
  }
}

TEST(Tracking, a_giver_that_takes_back_is_remembered) {
  State state = taken(wire::Fact::Offer);
  track(state, 1);
  EXPECT_FALSE(state.receiving.retained);
  state = taken(wire::Fact::Retain);
  track(state, 1);
  EXPECT_TRUE(state.receiving.retained);
}

TEST(Tracking, air_that_a_stable_hold_asks_for_adds_up_to_a_leak) {
  for (std::size_t s = 0; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    State state = held(id);
    state.timers.stable.stop();
    state.control = {.flow = Flow::Filling, .asked_ms = 100};
    track(state, 7);
    EXPECT_EQ(state.control.asked_ms, answers(id) ? 107 : 93) << s;
    state.control.refilling = true;
    track(state, 7);
    EXPECT_EQ(state.control.asked_ms, answers(id) ? 10'114 : 86) << s;
  }
  State state = held(Hold);
  for (const auto& [change, asks] :
       std::vector<std::pair<Change, bool>>{{[](State&) {}, true},
                                            {[](State& s) { s.timers.stable.start(2); }, false},
                                            {[](State& s) { s.control.flow = Flow::Shut; }, false},
                                            {[](State& s) { s.control.flow = Flow::Relieving; }, false}}) {
    State changed = state;
    changed.control = {.flow = Flow::Filling, .asked_ms = 39'999};
    change(changed);
    track(changed, 1);
    EXPECT_EQ(changed.control.asked_ms, asks ? 40'000 : 39'998);
    EXPECT_EQ(changed.faults.active(FaultCode::Leak), asks);
  }
  state.timers.stable.stop();
  state.control = {.flow = Flow::Filling, .asked_ms = 39'998};
  track(state, 1);
  EXPECT_FALSE(state.faults.active(FaultCode::Leak)) << "39.999 s";
}

TEST(Tracking, a_leak_is_told_once_and_over_when_all_its_air_is_forgotten) {
  State state = held(Hold);
  state.control = {.flow = Flow::Filling, .refilling = true, .asked_ms = 39'000};
  track(state, 1);
  EXPECT_EQ(state.control.asked_ms, 49'001);
  EXPECT_TRUE(state.faults.active(FaultCode::Leak));
  track(state, 1);
  EXPECT_EQ(state.control.asked_ms, 50'000) << "it is over in as many milliseconds";
  state.control = {.flow = Flow::Shut, .asked_ms = 2};
  while (state.faults.take_report() != FaultCode::None) {
  }
  track(state, 1);
  EXPECT_TRUE(state.faults.active(FaultCode::Leak));
  EXPECT_EQ(state.faults.take_report(), FaultCode::None);
  track(state, 2);
  EXPECT_EQ(state.control.asked_ms, 0);
  EXPECT_FALSE(state.faults.active(FaultCode::Leak));
}

TEST(Tracking, air_that_does_not_come_is_a_valve_that_sticks_after_half_a_second) {
  for (std::size_t s = 0; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    State state = held(id);
    squeeze_with(state, 519);
    state.bad_hold_ms = 2;
    state.control = {.flow = Flow::Filling, .starved_ms = 0};
    track(state, 1);
    EXPECT_EQ(state.control.starved_ms, answers(id) ? 1 : 0) << s;
  }
  for (const auto& [change, starves] :
       std::vector<std::pair<Change, bool>>{{[](State&) {}, true},
                                            {[](State& s) { s.bad_hold_ms = 1; }, false},
                                            {[](State& s) { s.control.flow = Flow::Shut; }, false},
                                            {[](State& s) { s.measurement.supply_low = true; }, false}}) {
    State state = held(Hold);
    squeeze_with(state, 519);
    state.bad_hold_ms = 2;
    state.control = {.flow = Flow::Filling, .starved_ms = 498};
    change(state);
    track(state, 1);
    EXPECT_EQ(state.control.starved_ms, starves ? 499 : 0);
    EXPECT_FALSE(state.faults.active(FaultCode::ValveStuck));
    track(state, 1);
    EXPECT_EQ(state.faults.active(FaultCode::ValveStuck), starves);
    state.session_epoch = 77;
    state.gate.open(5);
    track(state, 1);
    EXPECT_TRUE(state.gate.armed()) << "what was told does not end a session that was opened since";
  }
}

TEST(Tracking, a_jaw_is_blocked_while_it_stands_still_though_air_comes) {
  for (std::size_t s = 0; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    State state = held(id);
    state.measurement.still_ms = 1;
    state.control = {.flow = Flow::Filling, .blocked_ms = 10};
    track(state, 3);
    EXPECT_EQ(state.control.blocked_ms, id == Seating ? 13 : 7) << s;
  }
  for (const Change change :
       {Change([](State& s) { s.frozen = true; }), Change([](State& s) { s.control.flow = Flow::Shut; }),
        Change([](State& s) { s.measurement.still_ms = 0; })}) {
    State state = held(Seating);
    state.measurement.still_ms = 1;
    state.control = {.flow = Flow::Filling, .blocked_ms = 10};
    change(state);
    track(state, 9);
    EXPECT_EQ(state.control.blocked_ms, 1);
    track(state, 2);
    EXPECT_EQ(state.control.blocked_ms, 0);
  }
}

TEST(Tracking, a_receivers_hold_is_timed_while_this_node_offers) {
  for (std::size_t s = 0; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    State state = offering(id);
    state.timers.peer_good.start(50);
    track(state, 10);
    EXPECT_EQ(state.timers.peer_good.left_ms(), id == Offered ? 40 : 50) << s;
    EXPECT_EQ(state.answer_seen, id == Offered) << s;
    state.peers.advance(70);
    track(state, 10);
    EXPECT_EQ(state.timers.peer_good.left_ms(), id == Offered ? 60 : 50) << s;
  }
  State state = offering(Offered);
  state.store.record.token = 6;
  track(state, 10);
  EXPECT_FALSE(state.answer_seen);
}

struct Condition {
  FaultCode code;
  Change comes;
  Change goes;
};

TEST(Tracking, faults_that_are_conditions_come_and_go_with_them) {
  const std::vector<Condition> conditions = {
      {FaultCode::HostLost, [](State& s) { s.host = {}; }, [](State& s) { hear_host(s); }},
      {FaultCode::SupplyAirLow, [](State& s) { s.measurement.supply_low = true; },
       [](State& s) { s.measurement.supply_low = false; }},
      {FaultCode::BusOff, [](State& s) { s.bus.observe({.off = true}, 1); },
       [](State& s) { s.bus.observe({}, 1); }},
      {FaultCode::BusPassive, [](State& s) { s.bus.observe({.passive = true}, 1); },
       [](State& s) { s.bus.observe({}, 1); }}};
  for (const Condition& condition : conditions) {
    State state = held(Hold);
    track(state, 1);
    EXPECT_FALSE(state.faults.active(condition.code)) << wire::to_string(condition.code);
    condition.comes(state);
    track(state, 1);
    EXPECT_TRUE(state.faults.active(condition.code)) << wire::to_string(condition.code);
    condition.goes(state);
    track(state, 1);
    EXPECT_FALSE(state.faults.active(condition.code)) << wire::to_string(condition.code);
  }
}

TEST(Tracking, what_happened_on_the_bus_is_told_once) {
  const auto told = [](State state, const BusHealth& before, const BusHealth& now) {
    state.bus.observe(before, 1);
    state.bus.observe(now, 1);
    track(state, 1);
    const FaultCode code = state.faults.take_report();
    EXPECT_EQ(state.faults.take_report(), FaultCode::None);
    return code;
  };
  EXPECT_EQ(told(held(Hold), {}, {}), FaultCode::None);
  EXPECT_EQ(told(held(Hold), {.off = true}, {}), FaultCode::BusOffRecovered);
  EXPECT_EQ(told(held(Hold), {.overruns = 1}, {.overruns = 2}), FaultCode::ReceiveOverrun);
}

TEST(Tracking, a_session_ends_without_its_host_or_with_another) {
  for (const auto& [change, open] : std::vector<std::pair<Change, bool>>{
           {[](State&) {}, true},
           {[](State& s) { s.host = {}; }, false},
           {[](State& s) { s.session_epoch = 76; }, false},
           {[](State& s) {  // its host is heard, but only to repeat itself
              s.host.advance(100);
              s.host.hear({.label = {.counter = 2}, .message = {.epoch = 77}}, s.config.node);
              s.host.advance(100);
            },
            false},
           {[](State& s) { s.bus.observe({.off = true}, 1); }, false},
           {[](State& s) { s.measurement.supply_low = true; }, true}}) {
    State state = held(Ready);
    state.gate.open(5);
    state.session_epoch = 77;
    change(state);
    track(state, 1);
    EXPECT_EQ(state.gate.armed(), open);
  }
}

}  // namespace
}  // namespace pinjaw::core::test

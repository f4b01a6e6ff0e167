// Promises: TELEMETRY.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "firmware_sim/core/guards.hpp"
#include "firmware_sim/core/telemetry.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// Each word of what a node says of itself.
namespace pinjaw::core::test {
namespace {

/// Everything that `state` says in the next second, by message.
template <class Message>
std::vector<Message> said(State& state, int ms = 1, const Valves& valves = {}) {
  std::vector<Message> messages;
  for (int i = 0; i < ms; ++i) {
    SendQueue queue;
    report(state, 1, valves, state.announced, queue);
    for (const wire::Frame& frame : queue.view()) {
      const auto message = wire::parse<Message>(frame);
      if (message) messages.push_back(message->message);
      if (message) {
        EXPECT_EQ(message->label.node, kArm);
      }
    }
  }
  return messages;
}

wire::NodeState status_of(State state) {
  const auto messages = said<wire::NodeState>(state);
  EXPECT_EQ(messages.size(), 1U);
  return messages.empty() ? wire::NodeState{} : messages[0];
}

TEST(Status, of_a_holder_says_each_thing_that_is_so) {
  State state = made(StateId::Hold);
  squeeze_with(state, 800);
  state.announced.fact = wire::Fact::Sole;
  const wire::NodeState wanted{.state = StateId::Hold,
                               .armed = true,
                               .layout_ok = true,
                               .host_alive = true,
                               .part = true,
                               .hold_stable = true,
                               .custody = wire::Fact::Sole,
                               .f_low_dn = 680,
                               .separation_50um = 600};
  EXPECT_EQ(status_of(state), wanted);
  const std::vector<std::pair<std::function<void(State&)>, std::function<void(wire::NodeState&)>>> changes = {
      {[](State& s) { s.gate.close(); }, [](wire::NodeState& w) { w.armed = false; }},
      {[](State& s) { s.host = {}; }, [](wire::NodeState& w) { w.host_alive = false; }},
      {[](State& s) { s.timers.stable.start(1); }, [](wire::NodeState& w) { w.hold_stable = false; }},
      {[](State& s) { s.guard.cut = true; }, [](wire::NodeState& w) { w.at_limit = true; }},
      {[](State& s) { s.permit_dn = 920; }, [](wire::NodeState&) {}},
      {[](State& s) { s.permit_dn = 919; },
       [](wire::NodeState& w) {
         w.at_limit = true;
         w.hold_stable = false;
       }},
      {[](State& s) { s.measurement.local_enable = true; },
       [](wire::NodeState& w) { w.manual_enable = true; }},
      {[](State& s) { s.measurement.supply_low = true; }, [](wire::NodeState& w) { w.degraded = true; }},
      {[](State& s) { s.faults.raise(wire::FaultCode::Slip); },
       [](wire::NodeState& w) { w.fault = wire::FaultCode::Slip; }},
      {[](State& s) { s.measurement.separation_10um = -7; },
       [](wire::NodeState& w) {
         w.separation_50um = 0;
         w.part = w.hold_stable = false;
       }},
      {[](State& s) { squeeze_with(s, 100); },
       [](wire::NodeState& w) {
         w.f_low_dn = 0;
         w.hold_stable = false;
       }}};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    State changed = state;
    wire::NodeState expected = wanted;
    changes[i].first(changed);
    changes[i].second(expected);
    EXPECT_EQ(status_of(changed), expected) << i;
  }
}

TEST(Status, feels_a_part_where_it_is_seated_or_gripped_at_contact) {
  for (std::size_t i = 0; i < kStates; ++i) {
    State state = made(static_cast<StateId>(i));
    const bool seated = state.id == StateId::Seated || state.id == StateId::Squeezing;
    EXPECT_EQ(status_of(state).part, seated || grips(state.id)) << i;
    EXPECT_EQ(status_of(state).state, state.id);
    state.measurement.separation_10um = 4000;
    EXPECT_EQ(status_of(state).part, seated) << i;
    state.measurement.separation_10um = 3000;
    state.layouts.committed = false;
    EXPECT_EQ(status_of(state).part, seated) << i;
    EXPECT_FALSE(status_of(state).layout_ok);
    state.config.passive = true;
    EXPECT_FALSE(status_of(state).part);
    state.measurement.seated = true;
    EXPECT_TRUE(status_of(state).part);
  }
}

TEST(Status, of_a_passive_station_knows_no_force_and_no_limit) {
  State state = made(StateId::Hold);
  state.config.passive = true;
  squeeze_with(state, 5000);
  state.guard.cut = true;
  EXPECT_EQ(status_of(state).f_low_dn, 0);
  EXPECT_FALSE(status_of(state).at_limit);
  State other = state;
  const auto forces = said<wire::Force>(other, 20);
  ASSERT_EQ(forces.size(), 1U);
  EXPECT_EQ(forces[0], (wire::Force{0, 0, 0, 0}));
  State again = state;
  const auto custody = said<wire::Custody>(again);
  ASSERT_EQ(custody.size(), 1U);
  EXPECT_EQ(custody[0].f_low_n, 0);
}

TEST(Forces, are_said_as_measured_set_and_limited) {
  State state = made(StateId::Hold);
  state.force_set_dn = 700;
  squeeze_with(state, 800);
  const auto forces = said<wire::Force>(state, 20);
  ASSERT_EQ(forces.size(), 1U);
  EXPECT_EQ(forces[0], (wire::Force{920, 700, 1400, 800}));
}

TEST(CustodySaid, with_its_force_in_newtons) {
  State state = made(StateId::Hold);
  state.announced = {wire::Fact::Sole, kPedestal, 7, 8};
  squeeze_with(state, 800);
  const auto custody = said<wire::Custody>(state);
  ASSERT_EQ(custody.size(), 1U);
  EXPECT_EQ(custody[0], (wire::Custody{wire::Fact::Sole, kPedestal, 7, 8, 68}));
  for (const auto& [measured_dn, said_n] : {std::pair{0, 0}, {129, 0}, {130, 1}, {2669, 254}, {9999, 254}}) {
    State other = made(StateId::Hold);
    squeeze_with(other, measured_dn);
    EXPECT_EQ(said<wire::Custody>(other)[0].f_low_n, said_n) << measured_dn;
  }
}

TEST(CustodySaid, every_20_ms_in_a_handoff_and_every_100_ms_outside) {
  for (std::size_t i = 0; i < kStates; ++i) {
    for (const wire::Fact fact :
         {wire::Fact::Empty, wire::Fact::Released, wire::Fact::Retain, wire::Fact::Sole}) {
      using enum wire::State;
      State state = made(static_cast<StateId>(i));
      state.announced.fact = fact;
      const StateId id = state.id;
      const bool handing = (id >= Seating && id <= Taken) || (id >= Offered && id <= Opening) ||
                           ((id == Loaded || id == Ready) && fact == wire::Fact::Released) ||
                           (id == Hold && fact == wire::Fact::Retain);
      EXPECT_EQ(said<wire::Custody>(state, 200).size(), handing ? 10U : 2U)
          << i << ' ' << static_cast<int>(fact);
    }
  }
}

TEST(CustodySaid, at_once_when_it_changes) {
  State state = made(StateId::Hold);
  said<wire::Custody>(state);
  SendQueue queue;
  report(state, 1, {}, {wire::Fact::Take, 1, 2, 3}, queue);
  EXPECT_EQ(queue.size, 1U);
}

TEST(PneumaticsSaid, in_2_5_mbar_and_a_bit_for_each_valve) {
  const std::vector<std::pair<Valves, int>> bits = {
      {{}, 0},
      {{.spool = Spool::Close}, 1},
      {{.spool = Spool::Open}, 2},
      {{.relax = true}, 4},
      {{.pre_vent = true}, 8},
      {{.supply_cut = true}, 16},
      {{.spool = Spool::Close, .relax = true, .supply_cut = true}, 21}};
  for (const auto& [valves, wanted] : bits) {
    State state = made(StateId::Hold);
    state.measurement.close_ubar = {4'000'000, 4'010'000};
    state.measurement.open_ubar = 252'500;
    state.measurement.supply_mbar = 6000;
    const auto said_now = said<wire::Pneumatics>(state, 1, valves);
    ASSERT_EQ(said_now.size(), 1U);
    EXPECT_EQ(said_now[0],
              (wire::Pneumatics{1602, 101, 2400, static_cast<std::uint8_t>(wanted), std::nullopt}));
  }
}

TEST(IdentitySaid, in_five_pages_20_ms_apart_and_then_one_a_second) {
  State state = made(StateId::Loaded);
  state.config.serial = 4711;
  state.store.record.boot_count = 12;
  std::vector<int> times;
  for (int ms = 0; ms < 4000; ++ms) {
    const auto pages = said<wire::Identity>(state);
    for (const wire::Identity& identity : pages) {
      EXPECT_EQ(static_cast<std::size_t>(identity.page), times.size() % 5);
      if (identity.page == wire::IdentityPage::Product) {
        EXPECT_EQ(identity.product, 0x504A);
        EXPECT_EQ(identity.hardware, 1);
      }
      if (identity.page == wire::IdentityPage::Firmware) {
        EXPECT_EQ(identity.major, 0);
        EXPECT_EQ(identity.minor, 1);
        EXPECT_EQ(identity.patch, 0);
      }
      if (identity.page == wire::IdentityPage::Serial) {
        EXPECT_EQ(identity.serial, 4711U);
      }
      if (identity.page == wire::IdentityPage::Boot) {
        EXPECT_EQ(identity.boots, 12);
        EXPECT_EQ(identity.memory, wire::MemoryStatus::Good);
      }
      times.push_back(ms);
    }
  }
  EXPECT_EQ(times, (std::vector<int>{0, 20, 40, 60, 80, 1080, 2080, 3080}));
  State failed = made(StateId::Loaded);
  failed.store.failed = true;
  failed.identity_page = 4;
  failed.reset = wire::ResetCause::Watchdog;
  const auto boot_page = said<wire::Identity>(failed);
  ASSERT_EQ(boot_page.size(), 1U);
  EXPECT_EQ(boot_page[0].reset, wire::ResetCause::Watchdog);
  EXPECT_EQ(boot_page[0].memory, wire::MemoryStatus::Lost);
}

TEST(LayoutSaid, by_its_checksum_every_half_second) {
  State state = made(StateId::Loaded);
  const auto layouts = said<wire::LayoutStatus>(state, 1001);
  ASSERT_EQ(layouts.size(), 3U);
  EXPECT_EQ(layouts[0], (wire::LayoutStatus{state.layouts.crc, 0x1234}));
}

TEST(FaultsSaid, with_severity_and_state_while_active_and_when_they_went) {
  State state = made(StateId::Hold);
  state.faults.raise(wire::FaultCode::Slip);
  auto faults = said<wire::FaultReport>(state, 201);
  ASSERT_EQ(faults.size(), 3U);
  for (const wire::FaultReport& fault : faults) {
    EXPECT_EQ(fault,
              (wire::FaultReport{wire::FaultCode::Slip, wire::Severity::Hold, true, StateId::Hold, 0}));
  }
  state.faults.clear(wire::FaultCode::Slip);
  faults = said<wire::FaultReport>(state, 200);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_FALSE(faults[0].active);
}

TEST(FaultsSaid, of_a_manual_release_carry_the_challenge_while_it_may_be_answered) {
  State state = made(StateId::Hold);
  state.challenge = 321;
  state.timers.challenge.start(150);
  auto faults = said<wire::FaultReport>(state);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0], (wire::FaultReport{wire::FaultCode::ManualRelease, wire::Severity::Info, false,
                                          StateId::Hold, 321}));
  state.timers.challenge.stop();
  EXPECT_EQ(said<wire::FaultReport>(state, 200).size(), 0U);
  state.faults.raise(wire::FaultCode::ManualRelease);
  faults = said<wire::FaultReport>(state);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].severity, wire::Severity::Warning);
  EXPECT_EQ(faults[0].argument, 0);
}

/// The milliseconds in which a message of that kind is said.
template <class Message>
std::vector<int> times_of(State& state, int ms) {
  std::vector<int> times;
  for (int at = 0; at < ms; ++at) {
    if (!said<Message>(state).empty()) times.push_back(at);
  }
  return times;
}

TEST(Periods, are_kept_to_the_millisecond) {
  const State state = made(StateId::Hold);
  State one = state;
  EXPECT_EQ(times_of<wire::NodeState>(one, 61), (std::vector{0, 20, 40, 60}));
  one = state;
  EXPECT_EQ(times_of<wire::Force>(one, 61), (std::vector{10, 30, 50}));
  one = state;
  EXPECT_EQ(times_of<wire::Pneumatics>(one, 201), (std::vector{0, 100, 200}));
  one = state;
  EXPECT_EQ(times_of<wire::LayoutStatus>(one, 1001), (std::vector{0, 500, 1000}));
  one = state;
  EXPECT_EQ(times_of<wire::Custody>(one, 201), (std::vector{0, 100, 200}));
  one.id = StateId::Offered;
  EXPECT_EQ(times_of<wire::Custody>(one, 42), (std::vector{0, 20, 40})) << "the long period is cut short";
  one = state;
  one.faults.raise(wire::FaultCode::Slip);
  EXPECT_EQ(times_of<wire::FaultReport>(one, 201), (std::vector{0, 100, 200}));
}

TEST(Status, is_of_a_stable_hold_only_where_a_node_answers_for_it) {
  for (std::size_t i = 0; i < kStates; ++i) {
    State state = made(static_cast<StateId>(i));
    squeeze_with(state, 800);
    state.permit_dn = 1000;
    const bool well = holds_well(state);
    EXPECT_EQ(status_of(state).hold_stable, holds(state.id) && well) << i;
  }
}

TEST(Quantities, past_what_a_field_can_say_are_said_as_its_most) {
  State state = made(StateId::Hold);
  squeeze_with(state, 65'736);
  state.measurement.separation_10um = 5 * 65'636;
  EXPECT_EQ(status_of(state).f_low_dn, 4094);
  EXPECT_EQ(status_of(state).separation_50um, 4094);
  state.measurement.close_ubar = {9'000'000, 9'000'000};
  state.measurement.open_ubar = 7'500'000;
  const auto pneumatics = said<wire::Pneumatics>(state);
  ASSERT_EQ(pneumatics.size(), 1U);
  EXPECT_EQ(pneumatics[0].close_2500ubar, 3600);
  EXPECT_EQ(pneumatics[0].open_2500ubar, 3000);
}

TEST(FaultsSaid, of_anything_else_carry_no_challenge) {
  State state = made(StateId::Hold);
  state.challenge = 321;
  state.timers.challenge.start(500);
  state.faults.raise(wire::FaultCode::Slip);
  const auto faults = said<wire::FaultReport>(state, 2);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0],
            (wire::FaultReport{wire::FaultCode::Slip, wire::Severity::Hold, true, StateId::Hold, 0}));
  EXPECT_EQ(faults[1].code, wire::FaultCode::ManualRelease);
}

/// The tokens of the outcomes that are repeated within `ms`.
std::vector<int> outcomes_of(State state, int ms) {
  std::vector<int> tokens;
  for (int at = 0; at < ms; ++at) {
    for (const wire::Custody& custody : said<wire::Custody>(state)) {
      if (!custody.past()) continue;
      EXPECT_EQ(at % 100, 0);
      EXPECT_EQ(custody.peer, custody.token - 40);
      EXPECT_EQ(custody.pair, custody.token + 10);
      EXPECT_EQ(custody.fact, custody.token == 43 ? wire::Fact::Retain : wire::Fact::Released);
      tokens.push_back(custody.token);
    }
  }
  return tokens;
}

TEST(OutcomesSaid, begin_with_the_newest_however_often_there_was_none) {
  State state = made(StateId::Hold);
  state.store.record.custody = Custody::Sole;
  for (const int idle_ms : {1, 101, 201}) {
    State one = state;
    for (const wire::Custody& custody : said<wire::Custody>(one, idle_ms)) EXPECT_FALSE(custody.past());
    one.store.record.outcomes.fill({.peer = 2, .token = 42, .pair = 52});
    one.store.record.outcomes[1] = {.retained = true, .peer = 3, .token = 43, .pair = 53};
    const auto custodies = said<wire::Custody>(one, 100);
    ASSERT_FALSE(custodies.empty());
    EXPECT_TRUE(custodies.back().past());
    EXPECT_EQ(custodies.back().token, 42) << idle_ms;
  }
}

TEST(OutcomesSaid, take_turns_every_100_ms_but_for_the_one_that_is_said_now) {
  State state = made(StateId::Hold);
  for (std::uint8_t i = 0; i < 4; ++i) {
    state.store.record.outcomes[i] = {.retained = i == 1,
                                      .peer = static_cast<std::uint8_t>(2 + i),
                                      .token = static_cast<std::uint16_t>(42 + i),
                                      .pair = static_cast<std::uint16_t>(52 + i)};
  }
  state.store.record.custody = Custody::Sole;
  EXPECT_EQ(outcomes_of(state, 501), (std::vector{42, 43, 44, 45, 42, 43}));
  state.store.record.peer = 2;
  state.store.record.token = 42;
  EXPECT_EQ(outcomes_of(state, 501), (std::vector{42, 43, 44, 45, 42, 43})) << "SOLE is no end of it";
  for (const Custody custody : {Custody::Released, Custody::Retained}) {
    state.store.record.custody = custody;
    for (const bool of_newest : {true, false}) {  // else it was given to the operator, which is no outcome
      state.store.record.peer = of_newest ? 2 : wire::kOperatorPeer;
      state.store.record.token = 42;
      const std::vector turns =
          of_newest ? std::vector{43, 44, 45, 43, 44, 45} : std::vector{42, 43, 44, 45, 42, 43};
      EXPECT_EQ(outcomes_of(state, 501), turns);
    }
    state.store.record.peer = 2;
    state.store.record.token = 41;
    EXPECT_EQ(outcomes_of(state, 301), (std::vector{42, 43, 44, 45}));
    state.store.record.token = 42;
  }
  state.store.record.outcomes[2].peer = 0;
  EXPECT_EQ(outcomes_of(state, 301), (std::vector{43, 45, 43, 45}));
  State alone = state;
  alone.store.record.outcomes = {};
  alone.store.record.outcomes[3] = {.peer = 5, .token = 45, .pair = 55};
  EXPECT_EQ(outcomes_of(alone, 201), (std::vector{45, 45, 45})) << "found wherever it lies";
  State unstored = state;
  unstored.store.requested = 1;
  EXPECT_TRUE(outcomes_of(unstored, 300).empty());
  State unread = state;
  unread.store.readable = false;
  EXPECT_TRUE(outcomes_of(unread, 300).empty());
}

}  // namespace
}  // namespace pinjaw::core::test

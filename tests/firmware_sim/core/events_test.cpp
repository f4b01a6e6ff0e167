// Promises: I2, I3, I5, I6, R2, R3, R4, R6.
#include "firmware_sim/core/events.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "firmware_sim/core/transitions.hpp"
#include "protocol/wire/names.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// What each state takes notice of, and the last millisecond or tenth of a newton before it does.
namespace pinjaw::core::test {
namespace {

using enum wire::State;
using wire::FaultCode;
using Change = void (*)(State&);
using Expected = std::optional<Event>;

struct Case {
  Expected event;
  Change change;
};

void expect_events(const State& base, const std::vector<Case>& cases) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    State state = base;
    cases[i].change(state);
    const Expected event = next_event(state);
    EXPECT_TRUE(event == cases[i].event) << wire::to_string(base.id) << ", case " << i << ": event "
                                         << (event ? static_cast<int>(*event) : -1);
  }
}

bool goes(StateId id, Event event) {
  return reaction(kStateTable, id, event).kind == ReactionKind::Go;
}

TEST(NextEvent, of_boot_is_what_memory_and_sensors_tell) {
  State state = made(Boot);
  state.measurement.separation_10um = 6000;
  expect_events(state, {{Event::BootLoaded, [](State&) {}},
                        {Event::BootBare, [](State& s) { s.layouts.committed = false; }},
                        {Event::BootBad, [](State& s) { s.store.failed = true; }},
                        {Event::BootBad, [](State& s) { s.store.readable = false; }},
                        {Event::BootHeld, [](State& s) { s.measurement.separation_10um = 3000; }},
                        {Event::BootHeld, [](State& s) { s.store.record.custody = Custody::Sole; }},
                        {Event::BootLoaded, [](State& s) { s.store.record.custody = Custody::Released; }},
                        {Event::BootLoaded, [](State& s) {
                           s.host = {};
                           s.measurement.trouble = SensorTrouble::Position;
                         }}});
}

TEST(NextEvent, of_recovery_is_what_the_record_says) {
  const State state = held(Recover);
  expect_events(state, {{Event::RecordNone, [](State& s) { s.store.record.custody = Custody::Empty; }},
                        {Event::RecordSole, [](State& s) { s.store.record.custody = Custody::Sole; }},
                        {Event::RecordOffered, [](State& s) { s.store.record.custody = Custody::Offered; }},
                        {Event::RecordLatched, [](State& s) { s.store.record.custody = Custody::Latched; }},
                        {Event::RecordDecided, [](State& s) { s.store.record.custody = Custody::Decided; }},
                        {Event::RecordNone, [](State& s) { s.store.record.custody = Custody::Released; }},
                        {Event::RecordSole, [](State& s) { s.store.record.custody = Custody::Retained; }},
                        {Event::RecordNone, [](State& s) {
                           s.store.record.custody = Custody::Sole;
                           s.layouts.committed = false;
                         }}});
}

TEST(NextEvent, in_every_state_is_trouble_where_it_changes_the_state_or_is_news) {
  for (std::size_t s = 1; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    const State good = held(id);
    const Expected without = next_event(good);
    State state = good;
    state.measurement.trouble = SensorTrouble::Position;
    EXPECT_TRUE(next_event(state) == Event::SensorFault) << s;
    state.faults.raise(FaultCode::Position);
    EXPECT_TRUE(next_event(state) == (goes(id, Event::SensorFault) ? Event::SensorFault : without)) << s;
    state.measurement.trouble = SensorTrouble::PressureRange;
    EXPECT_TRUE(next_event(state) == Event::SensorFault) << s;
    state = good;
    state.store.failed = true;
    EXPECT_TRUE(next_event(state) == Event::StoreFault) << s;
    state.faults.raise(FaultCode::CustodyMemory);
    EXPECT_TRUE(next_event(state) == (goes(id, Event::StoreFault) ? Event::StoreFault : without)) << s;
    state = good;
    state.host = {};
    const Expected alone = id == Offered ? Event::OfferUnanswered : without;
    EXPECT_TRUE(next_event(state) == (goes(id, Event::HostLost) ? Event::HostLost : alone)) << s;
    state.store.failed = true;
    EXPECT_TRUE(next_event(state) == Event::StoreFault) << s;
    state.measurement.trouble = SensorTrouble::Position;
    EXPECT_TRUE(next_event(state) == Event::SensorFault) << s;
  }
}

TEST(NextEvent, of_a_receiver_is_the_silence_of_its_giver_once) {
  for (std::size_t s = 1; s < kStates; ++s) {
    const auto id = static_cast<StateId>(s);
    State state = held(id);
    state.receiving.giver = kPedestal;
    const bool receives = id == Seating || id == Seated || id == Squeezing || id == Taken;
    EXPECT_EQ(next_event(state) == Event::PeerLost, receives) << s;
    track(state, 0);
    EXPECT_FALSE(state.faults.active(FaultCode::PeerLost)) << s;
    state.faults.raise(FaultCode::PeerLost);
    EXPECT_FALSE(next_event(state) == Event::PeerLost) << s;
    track(state, 0);
    EXPECT_EQ(state.faults.active(FaultCode::PeerLost), receives) << s;
    hear_peer(state, kPedestal, {.fact = wire::Fact::Offer, .peer = kArm, .f_low_n = 1});
    track(state, 0);
    EXPECT_FALSE(state.faults.active(FaultCode::PeerLost)) << s;
    EXPECT_FALSE(next_event(state) == Event::PeerLost) << s;
  }
}

TEST(NextEvent, while_seating_is_contact_or_why_there_is_none) {
  State state = held(Seating);
  state.measurement.still_ms = 80;
  squeeze_with(state, 90);
  expect_events(state, {{Event::Contact, [](State&) {}},
                        {std::nullopt, [](State& s) { s.measurement.still_ms = 79; }},
                        {std::nullopt, [](State& s) { squeeze_with(s, 89); }},
                        {std::nullopt, [](State& s) { s.frozen = true; }},
                        {Event::NoPart, [](State& s) { s.measurement.separation_10um = 2949; }},
                        {Event::Contact, [](State& s) { s.measurement.separation_10um = 2950; }},
                        {Event::Contact, [](State& s) { s.measurement.separation_10um = 3050; }},
                        {std::nullopt, [](State& s) { s.measurement.separation_10um = 3051; }},
                        {Event::Misseated,
                         [](State& s) {
                           s.measurement.still_ms = 79;
                           s.timers.state.stop();
                         }},
                        {std::nullopt,
                         [](State& s) {
                           s.measurement.still_ms = 79;
                           s.control.blocked_ms = 500;
                         }},
                        {std::nullopt, [](State& s) {
                           s.frozen = true;
                           s.timers.state.stop();
                         }}});
  state.measurement.separation_10um = 3051;
  state.control.blocked_ms = 500;
  expect_events(state, {{Event::Misseated, [](State&) {}},
                        {std::nullopt, [](State& s) { s.control.blocked_ms = 499; }},
                        {std::nullopt, [](State& s) { squeeze_with(s, 89); }}});
  state.config.passive = true;
  expect_events(state, {{std::nullopt, [](State& s) { s.timers.state.stop(); }},
                        {Event::Contact, [](State& s) { s.measurement.seated = true; }}});
}

TEST(NextEvent, while_squeezing_is_a_stable_hold_or_why_there_is_none) {
  State state = held(Squeezing);
  state.permit_dn = 640;
  expect_events(state, {{Event::HoldStableForOperator, [](State&) {}},
                        {Event::OverForce, [](State& s) { squeeze_with(s, 521); }},
                        {Event::OverForce,
                         [](State& s) {
                           squeeze_with(s, 521);
                           s.measurement.separation_10um = 3021;
                         }},
                        {Event::Slip, [](State& s) { s.measurement.separation_10um = 3021; }},
                        {Event::HostLost, [](State& s) { s.gate.close(); }},
                        {Event::HostLost,
                         [](State& s) {
                           s.host = {};
                           hear_host(s, 77, false);
                         }},
                        {std::nullopt, [](State& s) { s.timers.stable.start(1); }},
                        {std::nullopt, [](State& s) { squeeze_with(s, 519); }},
                        {Event::SqueezeTimeout,
                         [](State& s) {
                           s.timers.stable.start(1);
                           s.timers.state.stop();
                         }},
                        {Event::HoldStableForPeer,
                         [](State& s) {
                           s.receiving.giver = kPedestal;
                           hear_peer(s, kPedestal, {.fact = wire::Fact::Offer, .peer = kArm, .f_low_n = 1});
                         }},
                        {Event::HoldStableForOperator, [](State& s) {
                           s.config.passive = s.measurement.seated = true;
                           squeeze_with(s, 5000);
                         }}});
}

/// What a part that is held shows, once each; `later`: what follows from it.
void expect_troubles_of_a_hold(const State& state, Expected later = std::nullopt) {
  expect_events(state, {{std::nullopt, [](State& s) { s.bad_hold_ms = 2; }},
                        {Event::Slip, [](State& s) { s.measurement.separation_10um = 3021; }},
                        {later,
                         [](State& s) {
                           s.measurement.separation_10um = 3021;
                           s.faults.raise(FaultCode::Slip);
                         }},
                        {std::nullopt, [](State& s) { squeeze_with(s, 1280); }},
                        {Event::OverForce, [](State& s) { squeeze_with(s, 1281); }},
                        {later,
                         [](State& s) {
                           squeeze_with(s, 1281);
                           s.faults.raise(FaultCode::OverForce);
                         }},
                        {std::nullopt,
                         [](State& s) {
                           squeeze_with(s, 1281);
                           s.config.passive = true;
                         }},
                        {Event::Slip,
                         [](State& s) {
                           s.measurement.separation_10um = 3021;
                           squeeze_with(s, 1281);
                         }},
                        {Event::HoldLost, [](State& s) {
                           s.bad_hold_ms = 3;
                           s.measurement.separation_10um = 3021;
                         }}});
}

TEST(NextEvent, while_sole_is_a_hold_that_is_lost_slips_or_presses_too_hard) {
  const State state = held(Hold);
  expect_troubles_of_a_hold(state);
  expect_events(state, {{std::nullopt, [](State& s) {
                           s.bad_hold_ms = 100;
                           s.faults.raise(FaultCode::HoldLost);
                         }}});
}

TEST(NextEvent, while_latched_is_the_givers_word_or_its_silence_once) {
  expect_events(taken(wire::Fact::Released), {{Event::PeerReleased, [](State&) {}}});
  expect_events(taken(wire::Fact::Retain), {{Event::PeerRetained, [](State&) {}}});
  const State state = taken(wire::Fact::Offer);
  expect_troubles_of_a_hold(state);
  expect_events(state, {{std::nullopt, [](State&) {}},
                        {Event::PeerSilent, [](State& s) { s.timers.state.stop(); }},
                        {std::nullopt,
                         [](State& s) {
                           s.timers.state.stop();
                           s.faults.raise(FaultCode::InDoubt);
                         }},
                        {Event::HoldLost, [](State& s) {
                           s.timers.state.stop();
                           s.faults.raise(FaultCode::InDoubt);
                           s.bad_hold_ms = 3;
                         }}});
}

TEST(NextEvent, while_offered_is_the_receivers_hold_or_that_nobody_answers) {
  const State state = offering(Offered);
  expect_troubles_of_a_hold(state, Event::OfferUnanswered);
  expect_events(state, {{std::nullopt, [](State&) {}},
                        {Event::OfferUnanswered, [](State& s) { s.timers.state.stop(); }},
                        {Event::OfferUnanswered, [](State& s) { s.host = {}; }},
                        {std::nullopt,
                         [](State& s) {
                           s.host = {};
                           s.answer_seen = true;
                         }},
                        {Event::OfferUnanswered, [](State& s) { s.session_epoch = 78; }},
                        {Event::OfferUnanswered,
                         [](State& s) {
                           s.host = {};
                           s.session_epoch = 0;  // as nobody's is
                         }},
                        {std::nullopt,
                         [](State& s) {
                           s.session_epoch = 78;
                           s.answer_seen = true;
                         }},
                        {Event::OfferUnanswered, [](State& s) { s.faults.raise(FaultCode::ValveStuck); }},
                        {std::nullopt, [](State& s) { s.faults.raise(FaultCode::Leak); }},
                        {std::nullopt, [](State& s) { s.timers.peer_good.stop(); }},
                        {Event::PeerHolds,
                         [](State& s) {
                           s.timers.peer_good.stop();
                           s.config.release_guard_enabled = false;
                         }},
                        {std::nullopt, [](State& s) { s.release_guard.good_ms = 1; }}});
  State seen = state;
  seen.timers.peer_good.stop();
  seen.release_guard.good_ms = 1;
  expect_events(seen, {{Event::PeerHolds, [](State&) {}},
                       {Event::Slip, [](State& s) { s.measurement.separation_10um = 3021; }},
                       {Event::OfferUnanswered, [](State& s) { s.faults.raise(FaultCode::OverForce); }},
                       {std::nullopt, [](State& s) { s.announced.fact = wire::Fact::Sole; }}});
}

TEST(NextEvent, while_relaxing_is_the_end_of_the_watch_that_both_channels_saw_or_a_doubt) {
  State state = offering(Relax);
  state.timers.state.stop();
  state.release_guard.peer = kPedestal;
  state.release_guard.token = 7;
  state.release_guard.peer_permits = true;
  expect_events(state, {{Event::PeerWatched, [](State&) {}},
                        {std::nullopt, [](State& s) { s.timers.state.start(1); }},
                        {std::nullopt, [](State& s) { s.release_guard.peer_permits = false; }},
                        {Event::PeerDoubted, [](State& s) { s.peers.advance(70); }},
                        {Event::PeerDoubted, [](State& s) { s.faults.raise(FaultCode::OverForce); }},
                        {Event::PeerWatched, [](State& s) { s.faults.raise(FaultCode::Leak); }},
                        {Event::Slip, [](State& s) { s.measurement.separation_10um = 3021; }}});
}

TEST(NextEvent, while_squeezing_again_is_a_stable_hold) {
  expect_events(held(Resqueeze), {{Event::HoldRestored, [](State&) {}},
                                  {std::nullopt, [](State& s) { s.timers.stable.start(1); }},
                                  {std::nullopt, [](State& s) { squeeze_with(s, 519); }}});
}

TEST(NextEvent, of_an_opening_is_its_end_once_it_was_decided_and_stored) {
  for (const StateId id : {Opening, FaultEmpty}) {
    State state = held(id);
    state.store.record.custody = Custody::Decided;
    state.measurement.separation_10um = 3251;
    expect_events(state, {{Event::Opened, [](State&) {}},
                          {Event::Opened, [](State& s) { s.timers.state.stop(); }},
                          {std::nullopt, [](State& s) { s.measurement.separation_10um = 3250; }},
                          {std::nullopt, [](State& s) { s.store.record_waits = true; }},
                          {std::nullopt, [](State& s) { s.store.record.custody = Custody::Sole; }}});
    state.measurement.separation_10um = 3250;
    state.timers.state.stop();
    EXPECT_TRUE(next_event(state) == (id == Opening ? Expected(Event::OpenTimeout) : std::nullopt));
  }
}

TEST(NextEvent, of_states_that_wait_for_a_command_is_none) {
  for (const StateId id : {Unconfigured, Loaded, Ready, Seated, FaultHold}) {
    State state = held(id);
    state.timers = {};
    state.bad_hold_ms = 100;
    EXPECT_FALSE(next_event(state).has_value()) << wire::to_string(id);
  }
}

}  // namespace
}  // namespace pinjaw::core::test

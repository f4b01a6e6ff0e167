// Promises: I2, I3, R2, R4.
#include <gtest/gtest.h>

#include <functional>

#include "firmware_sim/core/guards.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// The questions on which dangerous transitions hang: each term alone turns the answer.
namespace pinjaw::core::test {
namespace {

using Change = std::function<void(State&)>;

/// `question` is true of `good`, and false of it after each of the changes.
void expect_each_term_to_count(const State& good, bool (*question)(const State&),
                               const std::vector<Change>& changes) {
  ASSERT_TRUE(question(good));
  for (std::size_t i = 0; i < changes.size(); ++i) {
    State changed = good;
    changes[i](changed);
    EXPECT_FALSE(question(changed)) << "change " << i;
  }
}

TEST(HoldsEnough, from_the_required_force_on) {
  State state = made(StateId::Hold);
  squeeze_with(state, 520);
  expect_each_term_to_count(
      state, holds_enough,
      {[](State& s) { squeeze_with(s, 519); }, [](State& s) { s.layouts.committed = false; }});
  state.config.passive = true;
  EXPECT_FALSE(holds_enough(state));
  state.measurement.seated = true;
  EXPECT_TRUE(holds_enough(state));
  EXPECT_EQ(force_required_dn(state), 400);
  state.layouts.committed = false;
  EXPECT_EQ(force_required_dn(state), 0);
}

TEST(HoldsWell, with_force_window_grip_and_sensors_good) {
  State state = made(StateId::Hold);
  squeeze_with(state, 1280);
  expect_each_term_to_count(state, holds_well,
                            {[](State& s) { squeeze_with(s, 519); }, [](State& s) { squeeze_with(s, 1281); },
                             [](State& s) { s.measurement.separation_10um = s.reference_10um = 3051; },
                             [](State& s) { s.measurement.separation_10um = 3021; },
                             [](State& s) { s.measurement.suspected = SensorTrouble::Position; }});
  State pallet = made(StateId::Hold);
  pallet.config.passive = true;
  pallet.measurement.seated = true;
  pallet.measurement.separation_10um = 9999;
  EXPECT_TRUE(holds_well(pallet));
  EXPECT_TRUE(hold_is_stable(state));
  state.timers.stable.start(1);
  EXPECT_FALSE(hold_is_stable(state));
}

TEST(Window, is_half_a_millimetre_each_way) {
  State state = made(StateId::Seating);
  for (const auto& [separation_10um, within] :
       {std::pair{2949, false}, {2950, true}, {3000, true}, {3050, true}, {3051, false}}) {
    state.measurement.separation_10um = separation_10um;
    EXPECT_EQ(separation_in_window(state), within) << separation_10um;
  }
}

TEST(Slip, is_more_than_the_tolerance_either_way) {
  State state = made(StateId::Hold);
  for (const auto& [separation_10um, slips] :
       {std::pair{2979, true}, {2980, false}, {3000, false}, {3020, false}, {3021, true}}) {
    state.measurement.separation_10um = separation_10um;
    EXPECT_EQ(slipped(state), slips) << separation_10um;
  }
  state.config.passive = true;
  EXPECT_FALSE(slipped(state));
  state.config.passive = false;
  state.layouts.committed = false;
  EXPECT_FALSE(slipped(state));
}

/// The arm has offered token 7 to the pedestal, which says that it took it.
State offered() {
  State state = made(StateId::Relax);
  state.store.record.custody = Custody::Offered;
  state.store.record.peer = kPedestal;
  state.store.record.token = 7;
  state.store.record.pair = 8;
  hear_peer(state, kPedestal, {.fact = wire::Fact::Take, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40},
            {.state = StateId::Taken, .hold_stable = true, .f_low_dn = 400});
  return state;
}

Change hears(wire::Custody custody) {
  return [custody](State& state) {
    for (std::uint8_t counter = 3; counter < 6; ++counter) {
      state.peers.hear(wire::Received<wire::Custody>{{kPedestal, counter}, custody});
    }
  };
}

Change hears(wire::NodeState status) {
  return [status](State& state) {
    for (std::uint8_t counter = 3; counter < 6; ++counter) {
      state.peers.hear(wire::Received<wire::NodeState>{{kPedestal, counter}, status});
    }
  };
}

TEST(PeerHolds, only_where_every_word_of_it_is_so) {
  expect_each_term_to_count(
      offered(), peer_holds,
      {hears({.fact = wire::Fact::Offer, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40}),
       hears({.fact = wire::Fact::Take, .peer = kPallet, .token = 7, .pair = 8, .f_low_n = 40}),
       hears({.fact = wire::Fact::Take, .peer = kArm, .token = 6, .pair = 8, .f_low_n = 40}),
       hears({.fact = wire::Fact::Take, .peer = kArm, .token = 7, .pair = 9, .f_low_n = 40}),
       hears({.state = StateId::Hold, .hold_stable = true, .f_low_dn = 400}),
       hears({.state = StateId::Taken, .hold_stable = false, .f_low_dn = 400}),
       hears({.state = StateId::Taken, .hold_stable = true, .f_low_dn = 399}),
       hears({.state = StateId::Taken, .hold_stable = true, .f_low_dn = std::nullopt}),
       [](State& s) { s.peers.advance(70); }, [](State& s) { s.layouts.committed = false; },
       [](State& s) {  // its state alone is fresh
         s.peers.advance(69);
         s.peers.hear(wire::Received<wire::NodeState>{
             {kPedestal, 3}, {.state = StateId::Taken, .hold_stable = true, .f_low_dn = 400}});
         s.peers.advance(1);
       },
       [](State& s) { s.peers = {}; },
       [](State& s) {  // any force is enough, but it says none
         s.layouts.layout.peers[0].f_required_dn = 1;
         s.layouts.layout.peers[1].f_required_dn = 1;
         hears({.state = StateId::Taken, .hold_stable = true, .f_low_dn = std::nullopt})(s);
       },
       [](State& s) { s.layouts.layout.peer_count = 0; }, [](State& s) { s.store.record.peer = 9; },
       [](State& s) {
         s.peers.hear(wire::Received<wire::FaultReport>{
             {kPedestal, 1},
             {.code = wire::FaultCode::Slip, .severity = wire::Severity::Hold, .active = true}});
       }});
}

TEST(PeerSays, a_fact_that_does_not_age) {
  State state = offered();
  state.peers.advance(60'000);
  EXPECT_TRUE(peer_says(state, wire::Fact::Take));
  EXPECT_FALSE(peer_says(state, wire::Fact::Retain));
  state.store.record.peer = 9;
  EXPECT_FALSE(peer_says(state, wire::Fact::Take));
}

TEST(PeerConcludes, now_or_as_an_outcome_of_the_past) {
  State state = offered();
  EXPECT_FALSE(peer_concludes(state, wire::Fact::Released));
  EXPECT_TRUE(peer_concludes(state, wire::Fact::Take));
  hears(wire::Custody{.fact = wire::Fact::Released, .peer = kArm, .token = 7, .pair = 8})(state);
  EXPECT_TRUE(peer_concludes(state, wire::Fact::Released));
  EXPECT_TRUE(peer_says(state, wire::Fact::Take)) << "the present fact stays";
  State other = offered();
  hears(wire::Custody{.fact = wire::Fact::Released, .peer = kArm, .token = 6, .pair = 8})(other);
  EXPECT_FALSE(peer_concludes(other, wire::Fact::Released));
  other.store.record.peer = 9;
  EXPECT_FALSE(peer_concludes(other, wire::Fact::Take));
}

State receiving(wire::Fact fact) {
  State state = made(StateId::Seated);
  state.receiving = {.giver = kPedestal, .token = 7, .pair = 8};
  hear_peer(state, kPedestal, {.fact = fact, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40});
  return state;
}

TEST(GiverOffers, this_token_to_this_node_and_just_now) {
  expect_each_term_to_count(
      receiving(wire::Fact::Offer), giver_offers,
      {hears({.fact = wire::Fact::Retain, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40}),
       hears({.fact = wire::Fact::Offer, .peer = kPallet, .token = 7, .pair = 8, .f_low_n = 40}),
       hears({.fact = wire::Fact::Offer, .peer = kArm, .token = 6, .pair = 8, .f_low_n = 40}),
       hears({.fact = wire::Fact::Offer, .peer = kArm, .token = 7, .pair = 9, .f_low_n = 40}),
       [](State& s) { s.peers.advance(70); }, [](State& s) { s.receiving.giver = 9; }});
}

TEST(GiverRetains, now_or_as_an_outcome_of_the_past_and_for_ever) {
  State state = receiving(wire::Fact::Retain);
  state.peers.advance(60'000);
  EXPECT_TRUE(giver_retains(state));
  State past = receiving(wire::Fact::Offer);
  EXPECT_FALSE(giver_retains(past));
  hears(wire::Custody{.fact = wire::Fact::Retain, .peer = kArm, .token = 7, .pair = 8})(past);
  EXPECT_TRUE(giver_retains(past));
  past.receiving.giver = 9;
  EXPECT_FALSE(giver_retains(past));
}

TEST(NoPart, is_proven_at_either_end_stop_past_the_part_or_fully_open_and_without_force) {
  State state = made(StateId::Ready);
  const auto proven = [&state](std::int32_t separation_10um) {
    state.measurement.separation_10um = separation_10um;
    return no_part_proven(state);
  };
  EXPECT_TRUE(proven(0));
  EXPECT_TRUE(proven(2949)) << "closed past the part";
  EXPECT_FALSE(proven(2950));
  EXPECT_FALSE(proven(4949));
  EXPECT_TRUE(proven(4950)) << "where the layout wants the jaws before a part comes";
  state.layouts.committed = false;
  EXPECT_TRUE(proven(50));
  EXPECT_FALSE(proven(51));
  EXPECT_FALSE(proven(2949));
  EXPECT_FALSE(proven(5949));
  EXPECT_TRUE(proven(5950));
  squeeze_with(state, 169);
  EXPECT_TRUE(proven(6000)) << "4.9 N at least";
  squeeze_with(state, 170);
  EXPECT_FALSE(proven(6000));
  squeeze_with(state, 0);
  state.measurement.suspected = SensorTrouble::Disagreement;
  EXPECT_FALSE(proven(6000));
  state.config.passive = true;
  EXPECT_FALSE(proven(6000));
  state.measurement.seats_clear = true;
  EXPECT_TRUE(proven(3000));
}

TEST(NoPart, is_proven_at_the_end_stops_with_a_layout_too) {
  State state = made(StateId::Ready);
  state.layouts.layout.separation_contact_10um = 40;
  state.layouts.layout.separation_tolerance_10um = 5;
  state.layouts.layout.separation_open_10um = 7000;
  const auto proven = [&state](std::int32_t separation_10um) {
    state.measurement.separation_10um = separation_10um;
    return no_part_proven(state);
  };
  EXPECT_TRUE(proven(50)) << "closed";
  EXPECT_FALSE(proven(51));
  EXPECT_FALSE(proven(5949));
  EXPECT_TRUE(proven(5950)) << "the jaws go no further";
}

TEST(NoPart, is_not_proven_at_an_end_stop_where_a_part_may_be) {
  State state = made(StateId::Ready);
  const auto proven_of = [&state](std::uint16_t contact_10um, std::int32_t separation_10um) {
    state.layouts.layout.separation_contact_10um = contact_10um;
    state.layouts.layout.separation_open_10um = 7000;
    state.measurement.separation_10um = separation_10um;
    return no_part_proven(state);
  };
  EXPECT_FALSE(proven_of(60, 40)) << "the window is 0.1 mm to 1.1 mm";
  EXPECT_FALSE(proven_of(60, 10));
  EXPECT_TRUE(proven_of(60, 9));
  EXPECT_FALSE(proven_of(5960, 5950)) << "the window is 59.1 mm to 60.1 mm";
  EXPECT_FALSE(proven_of(5960, 6000));
  EXPECT_FALSE(proven_of(5960, 5910));
  EXPECT_TRUE(proven_of(5960, 5909));
  EXPECT_TRUE(proven_of(5960, 6011));
}

TEST(ClearOfPart, two_millimetres_past_the_window_or_fully_open) {
  State state = made(StateId::Opening);
  const auto clear = [&state](std::int32_t separation_10um) {
    state.measurement.separation_10um = separation_10um;
    return clear_of_part(state);
  };
  EXPECT_FALSE(clear(3250));
  EXPECT_TRUE(clear(3251));
  state.layouts.layout.separation_open_10um = 3100;
  EXPECT_FALSE(clear(3050));
  EXPECT_TRUE(clear(3051)) << "fully open is clear";
  state.config.passive = true;
  EXPECT_TRUE(clear(3000));
}

TEST(FullyOpen, where_the_layout_or_the_end_stop_says_but_past_the_part) {
  State state = made(StateId::Ready);
  const auto open = [&state](std::int32_t separation_10um) {
    state.measurement.separation_10um = separation_10um;
    return fully_open(state);
  };
  EXPECT_FALSE(open(4949));
  EXPECT_TRUE(open(4950));
  state.layouts.layout.separation_open_10um = 9000;
  EXPECT_FALSE(open(5949));
  EXPECT_TRUE(open(5950));
  state.layouts.layout.separation_open_10um = 3060;
  EXPECT_FALSE(open(3050));
  EXPECT_TRUE(open(3051));
  state.config.passive = true;
  EXPECT_TRUE(open(0));
}

TEST(Trouble, of_sensors_is_a_fault_and_a_reason_to_neither_give_nor_take) {
  State state = made(StateId::Hold);
  EXPECT_FALSE(degraded(state));
  state.measurement.trouble = SensorTrouble::PressureRange;
  EXPECT_EQ(sensor_fault(state.measurement), wire::FaultCode::PressureRange);
  EXPECT_TRUE(degraded(state));
  state.measurement.trouble = SensorTrouble::Position;
  EXPECT_EQ(sensor_fault(state.measurement), wire::FaultCode::Position);
  state.measurement.trouble = SensorTrouble::Disagreement;
  EXPECT_EQ(sensor_fault(state.measurement), wire::FaultCode::SensorsDisagree);
  state.measurement.trouble = SensorTrouble::None;
  state.measurement.supply_low = true;
  EXPECT_TRUE(degraded(state));
}

TEST(StateKinds, are_those_of_the_specification) {
  using enum wire::State;
  for (std::size_t i = 0; i < kStates; ++i) {
    const auto id = static_cast<StateId>(i);
    const bool h = id == Recover || id == Taken || id == Hold || id == Offered || id == FaultHold;
    EXPECT_EQ(holds(id), h) << i;
    EXPECT_EQ(grips(id), h || id == Relax || id == Resqueeze) << i;
  }
  EXPECT_TRUE(is_command(Event::CmdHold));
  EXPECT_TRUE(is_command(Event::CmdManualRelease));
  EXPECT_FALSE(is_command(Event::BootBare));
}

}  // namespace
}  // namespace pinjaw::core::test

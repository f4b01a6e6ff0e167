// Promises: I1, I3.
#include <gtest/gtest.h>

#include <set>

#include "firmware_sim/core/force_control.hpp"
#include "firmware_sim/core/force_guard.hpp"
#include "firmware_sim/core/guards.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// The pressure loop and the guard behind it, one decision at a time.
namespace pinjaw::core::test {
namespace {

/// Holds with F_set 52 N; the loop has arrived at the top of its band, 53 N.
State holding(std::int32_t measured_dn, Flow flow = Flow::Shut) {
  State state = made(StateId::Hold);
  state.force_set_dn = 520;
  state.control = {.flow = flow, .reference_dn = 530};
  squeeze_with(state, measured_dn);
  return state;
}

Valves wanted(State state, std::uint32_t elapsed_ms = 1) {
  return wanted_valves(state, elapsed_ms);
}

TEST(ForceLoop, leaves_the_valve_shut_from_refill_to_relief) {
  EXPECT_EQ(wanted(holding(524)).spool, Spool::Close);
  EXPECT_EQ(wanted(holding(525)).spool, Spool::Hold);
  EXPECT_EQ(wanted(holding(550)).spool, Spool::Hold);
  const Valves relief = wanted(holding(551));
  EXPECT_EQ(relief.spool, Spool::Close);
  EXPECT_TRUE(relief.relax);
  EXPECT_FALSE(wanted(holding(524)).relax);
}

TEST(ForceLoop, fills_and_relieves_to_the_top_of_its_band) {
  EXPECT_EQ(wanted(holding(529, Flow::Filling)).spool, Spool::Close);
  EXPECT_EQ(wanted(holding(530, Flow::Filling)).spool, Spool::Hold);
  EXPECT_TRUE(wanted(holding(531, Flow::Relieving)).relax);
  EXPECT_FALSE(wanted(holding(530, Flow::Relieving)).relax);
  EXPECT_EQ(wanted(holding(530, Flow::Relieving)).spool, Spool::Hold);
}

TEST(ForceLoop, narrows_its_band_where_the_limit_is_near) {
  State state = holding(522);
  state.control.reference_dn = 525;
  state.permit_dn = 645;  // F_set + u <= 64.5 N: 52.5 N at most
  EXPECT_EQ(wanted(state).spool, Spool::Hold);
  squeeze_with(state, 526);
  EXPECT_TRUE(wanted(state).relax);
  squeeze_with(state, 525);
  EXPECT_EQ(wanted(state).spool, Spool::Hold);
  state.permit_dn = 640;
  state.control.reference_dn = 520;
  squeeze_with(state, 519);
  EXPECT_EQ(wanted(state).spool, Spool::Close);
  squeeze_with(state, 520);
  EXPECT_EQ(wanted(state).spool, Spool::Hold);
  squeeze_with(state, 521);
  EXPECT_TRUE(wanted(state).relax);
}

TEST(ForceLoop, sets_the_pressure_of_its_reference_and_what_the_check_valve_takes) {
  State state = holding(500, Flow::Filling);
  EXPECT_EQ(wanted(state).close_set_mbar, pressure_mbar(state.config, 530, 0) + 200 + 1) << "30 / 100 of 3 N";
  state.measurement.open_ubar = 1'000'999;
  EXPECT_EQ(wanted(state).close_set_mbar, pressure_mbar(state.config, 530, 1000) + 200 + 1);
  state = holding(551);
  state.control.integral_ubar = 5000;
  EXPECT_EQ(wanted(state).close_set_mbar, pressure_mbar(state.config, 530, 0))
      << "the open check valve takes nothing";
  state = holding(526);
  state.control.integral_ubar = 5000;
  EXPECT_EQ(wanted(state).close_set_mbar, pressure_mbar(state.config, 530, 0) + 205);
  state.config.pressure_max_mbar = 2000;
  EXPECT_EQ(wanted(state).close_set_mbar, 2000);
  state.control.integral_ubar = -9'000'000;
  EXPECT_EQ(wanted(state).close_set_mbar, 0);
}

std::int32_t integral_after(std::int32_t measured_dn, std::int32_t before_ubar = 0,
                            std::uint32_t elapsed_ms = 1, Flow flow = Flow::Filling) {
  State state = holding(measured_dn, flow);
  state.control.integral_ubar = before_ubar;
  wanted_valves(state, elapsed_ms);
  return state.control.integral_ubar;
}

TEST(ForceLoop, integrates_a_small_error_while_it_fills_and_arrived) {
  EXPECT_EQ(integral_after(470), 2314) << "6 N are 231428 ubar, of which a hundredth a millisecond";
  EXPECT_EQ(integral_after(469), 0) << "too far: the feed-forward is on its way";
  EXPECT_EQ(integral_after(590), -2314);
  EXPECT_EQ(integral_after(591), 0);
  EXPECT_EQ(integral_after(470, 1000), 3314);
  EXPECT_EQ(integral_after(470, 0, 10), 23142);
  EXPECT_EQ(integral_after(470, 299'000, 100), 300'000);
  EXPECT_EQ(integral_after(590, -299'000, 100), -300'000);
  EXPECT_EQ(integral_after(470, 0, 1, Flow::Shut), 0);
  State ramping = holding(470, Flow::Filling);
  ramping.control.reference_dn = 500;
  wanted_valves(ramping, 1);
  EXPECT_EQ(ramping.control.integral_ubar, 0);
  State odd = holding(470, Flow::Filling);
  odd.config.area_udn_per_mbar = 0;
  wanted_valves(odd, 1);
  EXPECT_EQ(odd.control.integral_ubar, 300'000) << "no division by a config that is none";
  odd.control = {.flow = Flow::Filling, .reference_dn = 530, .integral_ubar = -9'900'000};
  squeeze_with(odd, 529);
  wanted_valves(odd, 1);
  EXPECT_EQ(odd.control.integral_ubar, 100'000) << "no area is the least: 1 dn is 1000 bar";
}

std::int32_t reference_after(std::int32_t before_dn, std::uint32_t elapsed_ms) {
  State state = holding(520);
  state.control.reference_dn = before_dn;
  wanted_valves(state, elapsed_ms);
  return state.control.reference_dn;
}

TEST(ForceLoop, ramps_its_reference_by_half_a_newton_a_millisecond) {
  EXPECT_EQ(reference_after(400, 1), 405);
  EXPECT_EQ(reference_after(400, 10), 450);
  EXPECT_EQ(reference_after(527, 1), 530);
  EXPECT_EQ(reference_after(600, 1), 595);
  EXPECT_EQ(reference_after(532, 1), 530);
  EXPECT_EQ(reference_after(-100'000, 5000), -100'000 + 5000) << "a step counts as a second at most";
}

TEST(ForceLoop, fills_while_it_ramps_up_whatever_is_measured_but_not_while_it_ramps_down) {
  State state = holding(540);
  state.control.reference_dn = 400;
  EXPECT_EQ(wanted(state).spool, Spool::Close);
  EXPECT_FALSE(wanted(state).relax);
  state.control.flow = Flow::Filling;
  EXPECT_EQ(wanted(state).spool, Spool::Close);
  state.control = {.flow = Flow::Shut, .reference_dn = 600};
  EXPECT_EQ(wanted(state).spool, Spool::Hold);
}

State approaching() {
  State state = made(StateId::Seating);
  state.measurement.separation_10um = 4000;
  return state;
}

TEST(Approach, vents_the_open_side_first) {
  State state = approaching();
  state.measurement.open_ubar = 501'000;
  EXPECT_EQ(wanted(state), (Valves{.pre_vent = true}));
  state.measurement.open_ubar = 500'999;
  const Valves valves = wanted(state);
  EXPECT_EQ(valves.spool, Spool::Close);
  EXPECT_FALSE(valves.pre_vent);
  EXPECT_EQ(valves.close_set_mbar, pressure_mbar(state.config, 120, 0) + 200);
  EXPECT_FALSE(valves.relax);
}

TEST(Approach, pushes_harder_while_the_jaws_are_slow_up_to_the_uncertainty) {
  State state = approaching();
  const auto set_dn_after = [&](int ms, std::int32_t closing_mm_s) {
    state.control.push_mdn = 0;
    state.measurement.closing_mm_s = closing_mm_s;
    Valves valves;
    for (int i = 0; i < ms; ++i) valves = wanted_valves(state, 1);
    for (std::int32_t dn = 0; dn < 1000; ++dn) {
      if (valves.close_set_mbar == pressure_mbar(state.config, dn, 0) + 200) return dn;
    }
    return -1;
  };
  EXPECT_EQ(set_dn_after(100, 0), 120 + 70) << "0.7 dn a millisecond of standing still";
  EXPECT_EQ(set_dn_after(171, 0), 120 + 119);
  EXPECT_EQ(set_dn_after(172, 0), 120 + 120);
  EXPECT_EQ(set_dn_after(1000, 0), 120 + 120);
  EXPECT_EQ(set_dn_after(100, 60), 120 + 10);
  EXPECT_EQ(set_dn_after(500, 70), 120) << "as fast as it should be";
  EXPECT_EQ(set_dn_after(100, 90), 120 - 20);
  EXPECT_EQ(set_dn_after(1000, 200), 60) << "no less than half the light squeeze";
  state.config.pressure_max_mbar = 600;
  EXPECT_EQ(wanted(state).close_set_mbar, 431);
  state.control.push_mdn = 120'000;
  EXPECT_EQ(wanted(state).close_set_mbar, 600);
}

TEST(Approach, regulates_once_the_jaws_stand_still_at_the_part) {
  State state = approaching();
  state.measurement.separation_10um = 3050;
  state.control.reference_dn = 0;
  wanted_valves(state, 1);
  EXPECT_EQ(state.control.reference_dn, 120) << "still moving: the light squeeze at once";
  EXPECT_EQ(state.control.flow, Flow::Filling);
  state.control = {};
  state.measurement.still_ms = 1;
  wanted_valves(state, 1);
  EXPECT_EQ(state.control.reference_dn, 5) << "from here by the ramp";
}

TEST(Approach, waits_for_its_record_and_for_a_hold_to_be_lifted) {
  State state = approaching();
  state.frozen = true;
  EXPECT_EQ(wanted(state), Valves{});
  state.frozen = false;
  state.store.record_waits = true;
  EXPECT_EQ(wanted(state), Valves{});
  state = made(StateId::Seated);
  EXPECT_EQ(wanted(state).spool, Spool::Close);
  state.frozen = true;
  EXPECT_EQ(wanted(state), Valves{});
}

TEST(Opening, while_empty_needs_a_wish_a_session_and_a_permit_and_ends_fully_open) {
  for (const StateId id : {StateId::Ready, StateId::FaultEmpty}) {
    State state = made(id);
    state.opening_wanted = true;
    state.gate.open(5);
    EXPECT_EQ(wanted(state), (Valves{.spool = Spool::Open}));
    State asked = state;
    asked.opening_wanted = false;
    EXPECT_EQ(wanted(asked), Valves{});
    State armed = state;
    armed.gate.close();
    EXPECT_EQ(wanted(armed), Valves{});
    State permitted = state;
    hear_host(permitted, 77, false);
    permitted.host.hear({{0, 3}, {.permit = 0, .epoch = 77}}, kArm);
    EXPECT_EQ(wanted(permitted), Valves{});
    State open = state;
    open.measurement.separation_10um = 4950;
    EXPECT_EQ(wanted_valves(open, 1), Valves{});
    EXPECT_FALSE(open.opening_wanted);
  }
}

TEST(Opening, that_was_decided_needs_nothing_more) {
  EXPECT_EQ(wanted(made(StateId::Opening)), (Valves{.spool = Spool::Open}));
  State late = made(StateId::FaultEmpty);
  late.store.record.custody = Custody::Decided;
  EXPECT_EQ(wanted(late), (Valves{.spool = Spool::Open}));
}

TEST(Valves, of_states_that_only_wait_and_of_passive_stations_are_at_rest) {
  for (const StateId id :
       {StateId::Boot, StateId::Recover, StateId::Unconfigured, StateId::Loaded, StateId::FaultHold}) {
    State state = made(id);
    state.opening_wanted = true;
    state.gate.open(5);
    EXPECT_EQ(wanted(state), Valves{}) << static_cast<int>(id);
    EXPECT_EQ(force_set_dn(state), 0);
  }
  for (std::size_t id = 0; id < kStates; ++id) {
    State pallet = made(static_cast<StateId>(id));
    pallet.config.passive = true;
    pallet.force_set_dn = 520;
    EXPECT_EQ(wanted(pallet), Valves{});
    EXPECT_EQ(force_set_dn(pallet), 0);
  }
}

TEST(SetPoint, is_light_while_seating_full_while_holding_and_a_third_while_relaxing) {
  const std::set<StateId> full = {StateId::Squeezing, StateId::Taken, StateId::Hold, StateId::Offered,
                                  StateId::Resqueeze};
  for (std::size_t i = 0; i < kStates; ++i) {
    const auto id = static_cast<StateId>(i);
    State state = made(id);
    state.force_set_dn = 1000;
    const bool light = id == StateId::Seating || id == StateId::Seated;
    EXPECT_EQ(force_set_dn(state), full.contains(id)      ? 1000
                                   : light                ? 120
                                   : id == StateId::Relax ? 300
                                                          : 0)
        << i;
    state.layouts.committed = false;
    EXPECT_EQ(force_set_dn(state), 0);
  }
  State relaxing = made(StateId::Relax);
  relaxing.force_set_dn = 399;
  EXPECT_EQ(force_set_dn(relaxing), 120) << "never under the light squeeze";
}

TEST(SetPoint, leaves_room_for_the_uncertainty_under_the_limit) {
  State state = made(StateId::Hold);
  state.force_set_dn = 1400;
  EXPECT_EQ(force_set_dn(state), 1280);
  state.permit_dn = 100;
  EXPECT_EQ(force_set_dn(state), 0) << "a limit under the uncertainty allows nothing";
}

TEST(Limit, is_the_least_of_hardware_layout_and_permit) {
  State state = made(StateId::Hold);
  EXPECT_EQ(force_limit_dn(state), 1400);
  state.permit_dn = 800;
  EXPECT_EQ(force_limit_dn(state), 800);
  state.layouts.layout.f_limit_dn = 700;
  EXPECT_EQ(force_limit_dn(state), 700);
  state.config.hardware_limit_dn = 600;
  EXPECT_EQ(force_limit_dn(state), 600);
  state.layouts.committed = false;
  state.permit_dn = 1;
  EXPECT_EQ(force_limit_dn(state), 600);
}

TEST(Limit, of_states_that_hold_nothing_is_the_light_squeeze_and_its_uncertainty) {
  for (std::size_t i = 0; i < kStates; ++i) {
    State state = made(static_cast<StateId>(i));
    const bool squeezing = grips(state.id) || state.id == StateId::Squeezing;
    EXPECT_EQ(force_limit_dn(state), squeezing ? 1400 : 360) << i;
    state.layouts.layout.f_limit_dn = 300;
    EXPECT_EQ(force_limit_dn(state), 300);
  }
}

struct Guard : testing::Test {
  Sensors sensors(std::int32_t close_mbar, std::int32_t open_mbar = 0) {
    return {.close_mbar = {0, close_mbar}, .open_mbar = {open_mbar, open_mbar}};
  }
  Valves through(const Valves& wanted, const Sensors& read, std::int32_t limit_dn = 1000,
                 std::uint32_t ms = 1) {
    return guarded(config, limit_dn, read, ms, wanted, guard);
  }
  Config config;
  ForceGuard guard;
};

constexpr Valves kFill{.spool = Spool::Close, .close_set_mbar = 20000};
constexpr Valves kRelief{.spool = Spool::Close, .close_set_mbar = 20000, .relax = true};

TEST_F(Guard, clamps_the_set_point_to_what_the_limit_allows) {
  EXPECT_EQ(through(kFill, sensors(0)).close_set_mbar, 3394 + 200) << "88 N and the check valve";
  EXPECT_EQ(through(kRelief, sensors(0)).close_set_mbar, 3394);
  EXPECT_EQ(through({.spool = Spool::Close, .close_set_mbar = -5}, sensors(0)).close_set_mbar, 0);
  EXPECT_EQ(through({.spool = Spool::Close, .close_set_mbar = 3000}, sensors(0)).close_set_mbar, 3000);
  EXPECT_EQ(through(kFill, sensors(0, 1000)).close_set_mbar, 3394 + 850 + 200);
  EXPECT_EQ(through(kFill, sensors(0, -1000)).close_set_mbar, 3394 + 200);
  Sensors uneven = sensors(0, 1000);
  uneven.open_mbar[0] = 400;
  EXPECT_EQ(through(kFill, uneven).close_set_mbar, 3394 + 340 + 200) << "the lower of both";
  config.uncertainty_dn = 20;
  EXPECT_EQ(through(kFill, sensors(0)).close_set_mbar, 3857) << "the check valve may stick open";
}

TEST_F(Guard, cuts_after_3_ms_over_the_limit_and_not_at_it) {
  for (int ms = 0; ms < 10; ++ms)
    EXPECT_FALSE(through(kFill, sensors(3398)).supply_cut) << "F_high is the limit";
  EXPECT_FALSE(through(kFill, sensors(3399)).supply_cut);
  EXPECT_FALSE(through(kFill, sensors(3399)).supply_cut);
  const Valves cut = through(kFill, sensors(3399));
  EXPECT_TRUE(cut.supply_cut);
  EXPECT_EQ(cut.spool, Spool::Hold);
  EXPECT_FALSE(cut.relax);
  for (int ms = 0; ms < 19; ++ms) EXPECT_TRUE(through(kFill, sensors(3398)).supply_cut) << ms;
  EXPECT_FALSE(through(kFill, sensors(3398)).supply_cut) << "20 ms under it";
  EXPECT_EQ(through(kFill, sensors(3398)).spool, Spool::Close);
}

TEST_F(Guard, counts_each_time_over_the_limit_anew) {
  for (int i = 0; i < 5; ++i) {
    through(kFill, sensors(5000), 1000, 2);
    EXPECT_FALSE(guard.cut);
    through(kFill, sensors(0));
  }
  through(kFill, sensors(5000), 1000, 3);
  EXPECT_TRUE(guard.cut);
  through(kFill, sensors(0), 1000, 19);
  through(kFill, sensors(5000));
  through(kFill, sensors(0), 1000, 19);
  EXPECT_TRUE(guard.cut);
}

TEST_F(Guard, is_never_in_the_way_of_air_that_goes_out) {
  through(kFill, sensors(5000), 1000, 3);
  ASSERT_TRUE(guard.cut);
  const Valves open{.spool = Spool::Open, .close_set_mbar = 0};
  EXPECT_EQ(through(open, sensors(5000)), open);
  const Valves relief =
      through({.spool = Spool::Close, .close_set_mbar = 3000, .relax = true}, sensors(5000));
  EXPECT_EQ(relief,
            (Valves{.spool = Spool::Close, .close_set_mbar = 3000, .relax = true, .supply_cut = true}));
  const Valves no_relief =
      through({.spool = Spool::Close, .close_set_mbar = 3000, .relax = true}, sensors(3000));
  EXPECT_EQ(no_relief.spool, Spool::Hold) << "the set point is no lower than what is there";
  EXPECT_FALSE(no_relief.relax);
  const Valves fill = through({.spool = Spool::Close, .close_set_mbar = 3000}, sensors(5000));
  EXPECT_EQ(fill.spool, Spool::Hold);
}

TEST_F(Guard, of_a_passive_station_lets_nothing_through_and_turned_off_everything) {
  config.force_guard_enabled = false;
  EXPECT_EQ(through(kFill, sensors(9000), 0, 100), kFill);
  config.passive = true;
  EXPECT_EQ(through(kFill, sensors(0)), Valves{});
}

}  // namespace
}  // namespace pinjaw::core::test

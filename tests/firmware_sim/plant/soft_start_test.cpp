// Promises: PLANT.
// The close line's soft start, and what sizes a gripper's lines.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware_sim/plant/stand.hpp"

namespace pinjaw::plant {
namespace {

/// Jaws of a gripper of `squeeze_n` at their open stop, fully vented, a part `gap_m` from each.
Stand at_stop(double squeeze_n, double gap_m) {
  Stand stand;
  stand.parameters = parameters_for({.max_squeeze_n = squeeze_n});
  stand.inputs.contact = {.present = true, .separation_m = 0.060 - 2 * gap_m};
  stand.start(0.060);
  return stand;
}

/// Jaws that friction of `blocking_n` keeps from moving, the close chamber told to fill to 5 bar.
Stand filled_against(double blocking_n, Stick soft_start) {
  Stand stand = at_stop(140, 0.010);
  stand.parameters.friction.coulomb_n = blocking_n;
  stand.parameters.friction.breakaway_n = blocking_n;
  stand.inputs.faults.soft_start = soft_start;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 5e5};
  stand.run(2.0);
  return stand;
}

double close_gauge_pa(const Stand& stand) {
  return stand.state.close_pa - kAtmosphere_Pa;
}

TEST(SoftStart, passes_its_pressure_and_no_more_until_the_jaws_press) {
  Stand stand = at_stop(140, 0.010);
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 5e5};
  double most_pa = 0;
  stand.run(2.0, [&](Stand& s) {
    if (s.first_touch_s < 0) most_pa = std::max(most_pa, close_gauge_pa(s));
  });
  EXPECT_LT(most_pa, stand.parameters.air.soft_start_pa - stand.parameters.air.check_cracking_pa);
  EXPECT_GT(squeeze_n(stand.state), 100) << "the way around it is open once the jaws stand at the part";
}

TEST(SoftStart, opens_for_jaws_that_press_on_what_does_not_give) {
  EXPECT_GT(close_gauge_pa(filled_against(400, Stick::Free)), 4.5e5);
}

TEST(SoftStart, that_sticks_shut_never_passes_more_and_one_that_sticks_open_always_does) {
  const AirParameters air = parameters_for({}).air;
  const Stand shut = filled_against(400, Stick::Off);
  EXPECT_NEAR(close_gauge_pa(shut), air.soft_start_pa - air.check_cracking_pa, 0.02e5);
  EXPECT_GT(close_gauge_pa(filled_against(400, Stick::On)), 4.5e5);
}

TEST(SoftStart, shuts_again_where_only_a_light_squeeze_is_left) {
  Stand stand = filled_against(400, Stick::Free);
  EXPECT_TRUE(stand.state.soft_start_open);
  const AirParameters& air = stand.parameters.air;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 10 / air.close_area_m2, .relax = true};
  stand.run(2.0);
  EXPECT_FALSE(stand.state.soft_start_open);
}

TEST(SoftStart, weighs_the_close_side_against_the_open_side) {
  Stand stand = at_stop(140, 0.010);
  stand.state.open_pa = kAtmosphere_Pa + 4e5;
  stand.state.close_pa = kAtmosphere_Pa + 3e5;  // more than opens it, were the open side vented
  stand.run(0.001);
  EXPECT_FALSE(stand.state.soft_start_open);
  stand.state.open_pa = kAtmosphere_Pa;
  stand.run(0.001);
  EXPECT_TRUE(stand.state.soft_start_open);
}

/// Speed at the touch of jaws that a regulator stuck open drives from rest.
double thrown_m_s(double squeeze_n, double gap_m, Stick soft_start) {
  Stand stand = at_stop(squeeze_n, gap_m);
  stand.inputs.faults.regulator = RegulatorFault::Open;
  stand.inputs.faults.soft_start = soft_start;
  stand.inputs.actuation = {.spool = Spool::Close};
  stand.run(2.0, [](Stand& s) {
    if (s.first_touch_s >= 0) s.inputs.actuation.supply_cut = true;
  });
  EXPECT_GT(stand.first_touch_s, 0) << squeeze_n << ' ' << gap_m;
  return stand.speed_at_touch_m_s;
}

// 154 N of a single fault are 0.130 m/s of 0.35 kg on 4e6 N/m (study: 1183 N per m/s).
constexpr double kFastest_m_s = 0.130;

TEST(SoftStart, keeps_the_touch_of_a_regulator_stuck_open_under_1_1_of_the_limit_wherever_the_part_is) {
  for (const double gap_m :
       {0.0005, 0.001, 0.0015, 0.002, 0.0025, 0.003, 0.004, 0.006, 0.010, 0.020, 0.028}) {
    EXPECT_LT(thrown_m_s(140, gap_m, Stick::Free), kFastest_m_s) << gap_m;
  }
  EXPECT_GT(thrown_m_s(140, 0.003, Stick::On), 1.5 * kFastest_m_s);
}

/// Mean speed of a jaw that closes under 18 N, with a share of the open side's way out.
double closing_m_s(double squeeze_n, double way_out_share = 1) {
  constexpr double kWay_m = 0.015;
  Stand stand = at_stop(squeeze_n, kWay_m);
  AirParameters& air = stand.parameters.air;
  air.meter_out.conductance_m3_s_pa *= way_out_share;
  stand.inputs.actuation = {.spool = Spool::Close,
                            .close_set_pa = 18 / air.close_area_m2 + air.check_cracking_pa};
  stand.run(4.0);
  EXPECT_GT(stand.first_touch_s, 0);
  return kWay_m / stand.first_touch_s;
}

double opening_s(double squeeze_n) {
  Stand stand = at_stop(squeeze_n, 0.015);
  stand.start(0.030);
  stand.state.close_pa = kAtmosphere_Pa + 2e5;
  stand.inputs.actuation.spool = Spool::Open;
  double opened_s = 0;
  stand.run(1.0, [&](Stand& s) {
    if (opened_s == 0 && separation_m(s.parameters, s.state) > 0.058) opened_s = s.time_s;
  });
  return opened_s;
}

TEST(Sizing, a_gripper_of_250_N_closes_nearly_and_opens_as_fast_as_one_of_140) {
  const double usual_m_s = closing_m_s(140);
  EXPECT_GT(closing_m_s(250), 0.6 * usual_m_s);
  EXPECT_LT(closing_m_s(250, 140.0 / 250), 0.5 * usual_m_s) << "were its ways out the smaller one's";
  EXPECT_NEAR(opening_s(250) / opening_s(140), 1, 0.2);
}

TEST(Sizing, seals_of_a_smaller_gripper_let_go_at_the_same_pressure_and_those_of_a_bigger_one_rub_no_more) {
  const Parameters usual = parameters_for({});
  const Parameters small = parameters_for({.max_squeeze_n = 70, .uncertainty_n = 6});
  const Parameters big = parameters_for({.max_squeeze_n = 280, .uncertainty_n = 24});
  EXPECT_NEAR(small.friction.breakaway_n / small.air.close_area_m2,
              usual.friction.breakaway_n / usual.air.close_area_m2, 50);
  EXPECT_NEAR(small.jaw.moving_mass_kg, usual.jaw.moving_mass_kg / 2, 0.001);
  EXPECT_EQ(big.friction.breakaway_n, usual.friction.breakaway_n);
}

TEST(Sizing, the_soft_start_passes_what_an_approach_pushes_with_and_opens_under_it) {
  for (const Sizing& sizing :
       {Sizing{.max_squeeze_n = 70, .uncertainty_n = 6}, Sizing{}, Sizing{.max_squeeze_n = 280}}) {
    const AirParameters air = parameters_for(sizing).air;
    EXPECT_GT((air.soft_start_pa - air.check_cracking_pa) * air.close_area_m2, 12 + sizing.uncertainty_n);
    EXPECT_GT((air.soft_start_pa - air.check_cracking_pa) * air.close_area_m2,
              air.soft_start_opens_pa * air.close_area_m2);
  }
}

}  // namespace
}  // namespace pinjaw::plant

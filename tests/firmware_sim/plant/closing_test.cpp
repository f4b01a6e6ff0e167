// Promises: PLANT.
#include <gtest/gtest.h>

#include "tests/firmware_sim/plant/stand.hpp"

// The rows of the table of docs/reliability.md, 4 mm gap a jaw, k = 4e6 N/m: a model check within a factor.
namespace pinjaw::plant {
namespace {

/// A plain 5/2 valve of conductance `dm3_s_bar` at 6 bar, which held the jaws open before: no regulator, no
/// check valve, no soft start, no orifices.
Stand plain_valve(double dm3_s_bar) {
  Stand stand = study_stand();
  AirParameters& air = stand.parameters.air;
  air.fill.conductance_m3_s_pa = dm3_s_bar * kDm3PerSecondBar;
  air.meter_out = air.fill;
  air.check_cracking_pa = 0;
  stand.inputs.faults.soft_start = Stick::On;
  air.relief_pa = 20e5;
  stand.state.open_pa = kAtmosphere_Pa + 6e5;
  stand.parameters.spool = {.on_delay_s = 0, .off_delay_s = 0};
  stand.inputs.faults.regulator = RegulatorFault::Open;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 6e5};
  return stand;
}

TEST(Closing, an_uncontrolled_valve_hits_a_stiff_part_with_about_1_kN) {
  Stand stand = plain_valve(0.3);
  stand.run(0.2);
  EXPECT_NEAR(stand.first_touch_s, 0.016, 0.008);
  EXPECT_GT(stand.peak_n, 1057 / 1.5);
  EXPECT_LT(stand.peak_n, 1057 * 1.5);
}

TEST(Closing, a_small_valve_still_hits_far_above_the_limit) {
  Stand stand = plain_valve(0.05);
  stand.run(0.4);
  EXPECT_NEAR(stand.first_touch_s, 0.060, 0.030);
  EXPECT_GT(stand.peak_n, 336 / 1.6);
  EXPECT_LT(stand.peak_n, 336 * 1.6);
}

TEST(Closing, the_peak_follows_speed_times_root_of_stiffness_and_mass) {
  Stand stand = plain_valve(0.3);
  stand.run(0.05);
  EXPECT_NEAR(stand.peak_n / (stand.speed_at_touch_m_s * 1183.0), 1.0, 0.5);
}

TEST(Closing, free_run_takes_about_as_long_as_real_units_take) {
  Stand stand = plain_valve(0.1);
  stand.parameters.spool = SpoolParameters{};
  stand.inputs.contact.present = false;
  double closed_s = 0;
  stand.run(1.0, [&](Stand& s) {
    if (closed_s == 0 && separation_m(s.parameters, s.state) < 1e-4) closed_s = s.time_s;
  });
  EXPECT_GT(closed_s, 0.03);
  EXPECT_LT(closed_s, 0.2);
}

/// A light set point with the open side vented, as the study's rules ask.
Stand soft_approach(double light_n) {
  Stand stand = study_stand();
  const double crack_pa = stand.parameters.air.check_cracking_pa;
  const double friction_n = 9;
  stand.inputs.actuation = {
      .spool = Spool::Close,
      .close_set_pa = (light_n + friction_n) / stand.parameters.air.close_area_m2 + crack_pa};
  return stand;
}

TEST(Closing, a_soft_approach_touches_after_0_2_to_0_4_s_below_the_hold_force) {
  Stand stand = soft_approach(12);
  stand.run(1.0);
  EXPECT_GT(stand.first_touch_s, 0.1);
  EXPECT_LT(stand.first_touch_s, 0.45);
  EXPECT_LT(stand.peak_n, 77.0);
  EXPECT_GT(squeeze_n(stand.state), 3.0);
  EXPECT_LT(squeeze_n(stand.state), 30.0);
}

TEST(Closing, a_ramp_to_77_N_after_it_does_not_overshoot) {
  Stand stand = soft_approach(12);
  stand.run(0.6);
  stand.peak_n = 0;
  const double area_m2 = stand.parameters.air.close_area_m2;
  stand.run(0.6, [&](Stand& s) {
    const double goal_pa = 77 / area_m2 + s.parameters.air.check_cracking_pa;
    s.inputs.actuation.close_set_pa = std::min(goal_pa, s.inputs.actuation.close_set_pa + 0.5 / area_m2);
  });
  EXPECT_GT(squeeze_n(stand.state), 77 - 15);
  EXPECT_LT(stand.peak_n, 77 + 10);
  EXPECT_LT(stand.peak_n, squeeze_n(stand.state) + 3);
}

TEST(Closing, opening_ends_at_the_stop_within_its_time) {
  Stand stand;
  stand.start(0.030);
  stand.inputs.contact = {.present = true, .separation_m = 0.030};
  stand.state.close_pa = kAtmosphere_Pa + 3e5;
  stand.run(0.1);
  ASSERT_GT(squeeze_n(stand.state), 60);
  stand.inputs.actuation.spool = Spool::Open;
  stand.run(0.8);
  EXPECT_NEAR(separation_m(stand.parameters, stand.state), 0.060, 1e-3);
}

}  // namespace
}  // namespace pinjaw::plant

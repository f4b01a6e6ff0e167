// Promises: PLANT.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware_sim/plant/stand.hpp"

namespace pinjaw::plant {
namespace {

/// A part held with about `squeeze` newtons, everything de-energised.
Stand holding(double squeeze) {
  Stand stand;
  stand.start(0.030);
  stand.inputs.contact = {.present = true, .separation_m = 0.030};
  stand.state.close_pa = kAtmosphere_Pa + squeeze / stand.parameters.air.close_area_m2;
  stand.run(0.05);
  return stand;
}

TEST(PlantFaults, without_current_and_supply_the_check_valve_keeps_the_squeeze) {
  Stand stand = holding(77);
  const double before_n = squeeze_n(stand.state);
  stand.inputs.faults.supply_lost = true;
  stand.run(5.0);
  EXPECT_NEAR(squeeze_n(stand.state), before_n, 0.5);
}

TEST(PlantFaults, supply_loss_while_energised_is_kept_by_the_check_valve_too) {
  Stand stand = holding(77);
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 3e5};
  stand.inputs.faults.supply_lost = true;
  stand.run(3.0);
  EXPECT_GT(squeeze_n(stand.state), 60);
}

TEST(PlantFaults, a_leak_of_0_05_cm3_per_s_costs_a_quarter_newton_per_s_at_5_bar) {
  Stand stand = holding(130);
  stand.inputs.contact.separation_m = 0.060;  // no swept volume: 4 cm3 of air, the study's 5
  stand.start(0.060);
  stand.state.close_pa = kAtmosphere_Pa + 5e5;
  stand.run(0.5);
  const double before_pa = stand.state.close_pa;
  // C such that C p1 = 0.05 cm3/s (ANR)
  stand.inputs.faults.close_leak.conductance_m3_s_pa = 0.05e-6 / 6e5;
  stand.run(1.0);
  const double lost_n = (before_pa - stand.state.close_pa) * stand.parameters.air.close_area_m2;
  EXPECT_GT(lost_n, 0.15);
  EXPECT_LT(lost_n, 0.55);
}

TEST(PlantFaults, a_regulator_stuck_open_is_stopped_by_the_relief) {
  Stand stand = holding(77);
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 3e5};
  stand.inputs.faults.regulator = RegulatorFault::Open;
  stand.run(3.0);
  EXPECT_GT(squeeze_n(stand.state), 120);
  EXPECT_LT(squeeze_n(stand.state), 1.10 * 140);
}

TEST(PlantFaults, a_regulator_stuck_open_raises_the_squeeze_by_at_most_half_a_newton_per_ms) {
  Stand stand = holding(40);
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 1.5e5};
  stand.run(0.1);
  stand.inputs.faults.regulator = RegulatorFault::Open;
  stand.run(0.05);
  double steepest_n = 0;
  double before_n = squeeze_n(stand.state);
  stand.run(0.2, [&](Stand& s) {
    steepest_n = std::max(steepest_n, squeeze_n(s.state) - before_n);
    before_n = squeeze_n(s.state);
  });
  EXPECT_LT(steepest_n, 0.6);
}

TEST(PlantFaults, the_supply_cut_off_stops_it) {
  Stand stand = holding(77);
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 3e5, .supply_cut = true};
  stand.inputs.faults.regulator = RegulatorFault::Open;
  stand.run(1.0);
  EXPECT_LT(squeeze_n(stand.state), 85);
}

TEST(PlantFaults, a_stuck_spool_does_not_follow) {
  Stand stand = holding(77);
  stand.inputs.faults.spool_stuck = true;
  stand.inputs.actuation.spool = Spool::Open;
  stand.run(1.0);
  EXPECT_GT(squeeze_n(stand.state), 60);
  EXPECT_EQ(stand.state.spool, Spool::Hold);
}

TEST(PlantFaults, a_sensor_s_offset_shows_on_it_alone) {
  Stand stand = holding(77);
  const Readings sound = read(stand.parameters, {}, stand.state);
  Faults faults;
  faults.pressure[1].offset = 1e5;
  const Readings broken = read(stand.parameters, faults, stand.state);
  EXPECT_NEAR(broken.close_pa[0], sound.close_pa[0], 6000);
  EXPECT_NEAR(broken.close_pa[1] - sound.close_pa[1], 1e5, 6000);
}

TEST(PlantFaults, a_neighbour_that_moves_draws_the_supply_down) {
  Stand stand;
  stand.start(0.060);
  stand.inputs.neighbour_moves = true;
  stand.run(0.5);
  EXPECT_NEAR(read(stand.parameters, {}, stand.state).supply_pa, 5.2e5, 0.1e5);
}

TEST(PlantFaults, a_stuck_position_sensor_repeats_itself) {
  Stand stand;
  stand.start(0.060);
  stand.inputs.faults.position.stuck = true;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 2e5};
  stand.run(0.5);
  EXPECT_DOUBLE_EQ(read(stand.parameters, {}, stand.state).separation_m, 0.060);
  EXPECT_LT(separation_m(stand.parameters, stand.state), 0.055);
}

TEST(PlantFaults, a_spool_that_sticks_open_stays_there_once_it_has_come_there) {
  Stand stand = holding(77);
  stand.inputs.faults.spool_sticks_at = Spool::Open;
  stand.run(1.0);
  EXPECT_GT(squeeze_n(stand.state), 60);
  stand.inputs.actuation.spool = Spool::Open;
  stand.run(0.5);
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 3e5};
  stand.run(1.0);
  EXPECT_EQ(stand.state.spool, Spool::Open);
  EXPECT_EQ(squeeze_n(stand.state), 0);
}

TEST(PlantFaults, a_check_valve_that_does_not_seat_leaves_the_chamber_to_the_regulator) {
  Stand stand = holding(77);
  stand.inputs.faults.relax = Stick::On;
  stand.run(1.0);
  EXPECT_GT(squeeze_n(stand.state), 60) << "the spool shuts it in as well";
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 1e5};
  stand.run(1.0);
  EXPECT_LT(squeeze_n(stand.state), 40);
}

TEST(PlantFaults, a_check_valve_that_does_not_lift_keeps_the_squeeze) {
  Stand stand = holding(77);
  stand.inputs.faults.relax = Stick::Off;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 1e5, .relax = true};
  stand.run(1.0);
  EXPECT_GT(squeeze_n(stand.state), 60);
}

TEST(PlantFaults, a_vent_that_sticks_shut_leaves_the_meter_out) {
  Stand free;
  free.start(0.060);
  free.state.open_pa = kAtmosphere_Pa + 5e5;
  free.inputs.actuation.vent_open = true;
  Stand stuck = free;
  stuck.inputs.faults.vent = Stick::Off;
  free.run(0.1);
  stuck.run(0.1);
  EXPECT_GT(stuck.state.open_pa, free.state.open_pa + 0.5e5);
  stuck.run(4.0);
  EXPECT_LT(stuck.state.open_pa, kAtmosphere_Pa + 0.1e5);
}

TEST(PlantFaults, a_cut_off_that_sticks_lets_all_or_nothing_through) {
  for (const bool shut : {true, false}) {
    Stand stand = holding(40);
    stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 5e5, .supply_cut = !shut};
    stand.inputs.faults.cut = shut ? Stick::On : Stick::Off;
    stand.run(1.0);
    EXPECT_EQ(squeeze_n(stand.state) < 45, shut);
  }
}

TEST(PlantFaults, a_regulator_gives_nothing_or_what_it_gave_last) {
  for (const RegulatorFault fault : {RegulatorFault::Closed, RegulatorFault::Stuck}) {
    Stand stand = holding(40);
    stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 3e5};
    stand.run(1.0);
    const double before_n = squeeze_n(stand.state);
    stand.inputs.faults.regulator = fault;
    stand.inputs.actuation.close_set_pa = 5e5;
    stand.run(1.0);
    EXPECT_NEAR(squeeze_n(stand.state), before_n, 2.0);
    stand.inputs.actuation.relax = true;
    stand.run(1.0);
    EXPECT_EQ(squeeze_n(stand.state) < 15, fault == RegulatorFault::Closed);  // what friction holds
  }
}

TEST(PlantFaults, every_sensor_may_stick_drift_stand_off_or_be_lost_alone) {
  const auto pressure = [](const Readings& readings, std::size_t i) {
    return i < 2 ? readings.close_pa.at(i) : readings.open_pa.at(i - 2);
  };
  for (std::size_t broken = 0; broken < 4; ++broken) {
    Stand stand = holding(77);
    stand.state.open_pa = kAtmosphere_Pa + 1e5;
    stand.run(0.02);
    Readings before = read(stand.parameters, {}, stand.state);
    SensorFault& fault = stand.inputs.faults.pressure.at(broken);
    fault.drift_per_s = 1e5;
    stand.run(0.5);
    Readings sound = read(stand.parameters, {}, stand.state);
    EXPECT_NEAR(pressure(sound, broken) - stand.state.sensed_pa.at(broken), 0.5e5, 0.15e5);
    fault = {.stuck = true};
    stand.state.sensor_drift_pa = {};
    stand.state.close_pa += 1e5;
    stand.state.open_pa += 1e5;
    before = read(stand.parameters, {}, stand.state);
    stand.run(0.02);
    for (std::size_t i = 0; i < 4; ++i) {
      const double moved_pa = pressure(read(stand.parameters, {}, stand.state), i) - pressure(before, i);
      EXPECT_EQ(std::abs(moved_pa) < 0.06e5, i == broken) << i << ' ' << broken << ' ' << moved_pa;
    }
    fault = {.lost = true};
    const Readings lost = read(stand.parameters, stand.inputs.faults, stand.state);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(pressure(lost, i) == 10e5, i == broken);
  }
}

TEST(PlantFaults, the_position_sensor_may_drift_stand_off_or_be_lost) {
  Stand stand = holding(77);
  const auto reads_m = [&] { return read(stand.parameters, stand.inputs.faults, stand.state).separation_m; };
  const double before_m = reads_m();
  stand.inputs.faults.position.offset = 1e-3;
  EXPECT_NEAR(reads_m() - before_m, 1e-3, 1e-5);
  stand.inputs.faults.position = {.drift_per_s = 1e-3};
  stand.run(0.5);
  EXPECT_NEAR(reads_m() - before_m, 0.5e-3, 1e-5);
  stand.inputs.faults.position = {.lost = true};
  EXPECT_GT(reads_m(), 0.060 + 0.005);
}

/// A part held by a gripper with a keeper of `keeper_n` or none, whose close chamber then loses all its air.
Stand without_air(double keeper_n) {
  Stand stand = holding(77);
  stand.parameters.air.keeper_n = keeper_n;
  stand.run(0.05);
  stand.inputs.faults.close_leak.conductance_m3_s_pa = 1e-9;
  stand.run(5.0);
  return stand;
}

TEST(PlantFaults, a_keeper_holds_without_air_and_nothing_does_without_it) {
  EXPECT_NEAR(squeeze_n(without_air(40).state), 40, 14);  // 9 N of breakaway, 30 % more at rest
  EXPECT_LT(squeeze_n(without_air(0).state), 14);         // what friction holds
}

TEST(PlantFaults, a_keeper_leaves_a_light_squeeze_light_and_adds_nothing_to_a_full_one) {
  for (const double light_n : {12.0, 77.0}) {
    Stand stand = study_stand();
    stand.inputs.actuation = {.spool = Spool::Close,
                              .close_set_pa = light_n / stand.parameters.air.close_area_m2 + 0.2e5};
    Stand kept = stand;
    kept.parameters.air.keeper_n = 40;
    stand.run(1.5);
    kept.run(1.5);
    EXPECT_DOUBLE_EQ(squeeze_n(kept.state), squeeze_n(stand.state));
    EXPECT_EQ(kept.state.keeper_engaged, light_n > 50);
  }
}

TEST(PlantFaults, air_on_the_open_side_draws_a_keeper_back) {
  Stand stand = holding(77);
  stand.parameters.air.keeper_n = 40;
  stand.run(0.05);
  EXPECT_TRUE(stand.state.keeper_engaged);
  stand.inputs.actuation.spool = Spool::Open;
  stand.run(0.8);
  EXPECT_FALSE(stand.state.keeper_engaged);
  EXPECT_NEAR(separation_m(stand.parameters, stand.state), 0.060, 1e-3);
}

}  // namespace
}  // namespace pinjaw::plant

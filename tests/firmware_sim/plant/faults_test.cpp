// Promises: PLANT.
#include <gtest/gtest.h>

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
  stand.inputs.faults.regulator_open = true;
  stand.run(3.0);
  EXPECT_GT(squeeze_n(stand.state), 120);
  EXPECT_LT(squeeze_n(stand.state), 1.10 * 140);
}

TEST(PlantFaults, a_regulator_stuck_open_raises_the_squeeze_by_at_most_half_a_newton_per_ms) {
  Stand stand = holding(40);
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 1.5e5};
  stand.run(0.1);
  stand.inputs.faults.regulator_open = true;
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
  stand.inputs.faults.regulator_open = true;
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
  faults.close_sensor_offset_pa[1] = 1e5;
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
  stand.inputs.faults.position_stuck = true;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 2e5};
  stand.run(0.5);
  EXPECT_DOUBLE_EQ(read(stand.parameters, {}, stand.state).separation_m, 0.060);
  EXPECT_LT(separation_m(stand.parameters, stand.state), 0.055);
}

}  // namespace
}  // namespace pinjaw::plant

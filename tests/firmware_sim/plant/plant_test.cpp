// Promises: PLANT.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware_sim/plant/stand.hpp"

namespace pinjaw::plant {
namespace {

double air_mass_kg(const Stand& stand) {
  const AirParameters& air = stand.parameters.air;
  const double close_m3 = air.dead_volume_m3 + air.close_area_m2 * stand.state.displacement_m;
  const double open_m3 =
      air.dead_volume_m3 + air.open_area_m2 * (stand.parameters.jaw.stroke_m - stand.state.displacement_m);
  return (stand.state.close_pa * close_m3 + stand.state.open_pa * open_m3) / (kAirConstant * kTemperature_K);
}

TEST(Plant, without_air_it_stays_where_it_is) {
  Stand stand;
  stand.start(0.040);
  stand.run(0.5);
  EXPECT_NEAR(separation_m(stand.parameters, stand.state), 0.040, 1e-6);
  EXPECT_EQ(squeeze_n(stand.state), 0.0);
}

TEST(Plant, an_isothermal_stroke_conserves_the_mass_of_air) {
  Stand stand = study_stand();
  stand.parameters.air.polytropic = 1.0;
  const double before_kg = air_mass_kg(stand);
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 2e5};
  stand.run(1.0);
  EXPECT_GT(stand.peak_n, 10.0);
  EXPECT_NEAR(
      (air_mass_kg(stand) - before_kg) / (stand.state.ledger.mass_in_kg - stand.state.ledger.mass_out_kg),
      1.0, 2e-3);
}

TEST(Plant, a_shut_chamber_follows_its_polytrope) {
  Stand stand = study_stand();
  stand.inputs.contact.present = false;
  stand.state.close_pa = 3e5;
  const double area_m2 = stand.parameters.air.close_area_m2;
  const double dead_m3 = stand.parameters.air.dead_volume_m3;
  stand.run(0.5);
  ASSERT_GT(stand.state.displacement_m, 0.001);
  const double volume_m3 = dead_m3 + area_m2 * stand.state.displacement_m;
  EXPECT_NEAR(stand.state.close_pa * std::pow(volume_m3, 1.2) / (3e5 * std::pow(dead_m3, 1.2)), 1.0, 1e-3);
}

TEST(Plant, the_air_s_work_is_never_less_than_the_energy_in_motion_and_contact) {
  Stand stand = study_stand();
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 3e5};
  double work_j = 0;
  for (int i = 0; i < 50000; ++i) {
    const double before_m = stand.state.displacement_m;
    const double force_n = stand.parameters.air.close_area_m2 * (stand.state.close_pa - kAtmosphere_Pa) -
                           stand.parameters.air.open_area_m2 * (stand.state.open_pa - kAtmosphere_Pa);
    step(stand.parameters, stand.inputs, stand.dt_s, stand.state);
    work_j += force_n * (stand.state.displacement_m - before_m);
    const double kinetic_j = 0.5 * 0.35 * stand.state.speed_m_s * stand.state.speed_m_s;
    const double depth_m = std::max(0.0, stand.state.displacement_m - 0.004);
    const double stored_j = 0.5 * 4e6 * depth_m * depth_m;
    ASSERT_LE(kinetic_j + stored_j, work_j + 1e-4) << i;
  }
  EXPECT_GT(work_j, 0.01);
}

TEST(Plant, a_quarter_of_the_step_gives_the_same_closing) {
  Stand coarse = study_stand();
  Stand fine = study_stand();
  fine.dt_s = kStep_s / 4;
  for (Stand* stand : {&coarse, &fine}) {
    stand->inputs.actuation = {.spool = Spool::Close, .close_set_pa = 2e5};
    stand->run(1.0);
  }
  EXPECT_NEAR(coarse.first_touch_s, fine.first_touch_s, 0.001);
  EXPECT_NEAR(coarse.peak_n, fine.peak_n, 0.02 * fine.peak_n);
  EXPECT_NEAR(squeeze_n(coarse.state), squeeze_n(fine.state), 0.5);
  EXPECT_NEAR(coarse.state.close_pa, fine.state.close_pa, 100.0);
}

TEST(Plant, a_free_part_is_pressed_alike_by_both_jaws) {
  Stand stand = study_stand();
  stand.inputs.contact.offset_m = 20e-6;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 2e5};
  stand.run(1.0);
  EXPECT_GT(stand.state.left_n, 5.0);
  EXPECT_DOUBLE_EQ(stand.state.left_n, stand.state.right_n);
}

TEST(Plant, a_part_fixed_off_centre_is_touched_by_one_jaw_first) {
  Stand stand = study_stand();
  stand.inputs.contact.fixed = true;
  stand.inputs.contact.offset_m = 50e-6;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 2e5};
  stand.run(1.0);
  EXPECT_GT(stand.state.right_n, 5.0);
  EXPECT_EQ(stand.state.left_n, 0.0);
}

TEST(Plant, no_part_lets_the_jaws_close_to_their_end_stop) {
  Stand stand = study_stand();
  stand.inputs.contact.present = false;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 1e5};
  stand.run(1.0);
  EXPECT_NEAR(separation_m(stand.parameters, stand.state), 0.0, 1e-4);
}

TEST(Plant, one_seed_gives_one_specimen_and_one_row_of_readings) {
  const Parameters parameters = parameters_for({});
  State a = initial_state(parameters, 5, 0.06);
  State b = initial_state(parameters, 5, 0.06);
  State c = initial_state(parameters, 6, 0.06);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(read(parameters, {}, a).close_pa, read(parameters, {}, b).close_pa);
  }
  EXPECT_NE(a.sensor_offset_pa, c.sensor_offset_pa);
}

TEST(Plant, sensors_read_in_their_steps_and_within_their_offset) {
  const Parameters parameters = parameters_for({});
  for (std::uint64_t seed = 1; seed < 50; ++seed) {
    State state = initial_state(parameters, seed, 0.031237);
    const Readings readings = read(parameters, {}, state);
    EXPECT_DOUBLE_EQ(readings.separation_m, 0.03124);
    const double steps = readings.close_pa[0] / parameters.sensors.pressure_step_pa;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LT(std::abs(readings.close_pa[0]), 0.1e5 + 6 * 500 + 250);
  }
}

}  // namespace
}  // namespace pinjaw::plant

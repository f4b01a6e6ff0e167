// Promises: SIM.
#include "firmware_sim/node/figures.hpp"

#include <gtest/gtest.h>

namespace pinjaw::node {
namespace {

TEST(Figures, the_140_N_class_gives_the_firmware_its_default_figures) {
  const core::Config config = core_config({});
  const core::Config usual;
  EXPECT_EQ(config.hardware_limit_dn, usual.hardware_limit_dn);
  EXPECT_EQ(config.uncertainty_dn, usual.uncertainty_dn);
  EXPECT_EQ(config.area_udn_per_mbar, usual.area_udn_per_mbar);
  EXPECT_EQ(config.open_ratio_permille, usual.open_ratio_permille);
  EXPECT_EQ(config.separation_max_10um, usual.separation_max_10um);
  EXPECT_TRUE(config.force_guard_enabled);
}

TEST(Figures, limits_round_to_the_safe_side) {
  const core::Config config = core_config({.max_squeeze_n = 99.99, .force_uncertainty_n = 11.91});
  EXPECT_EQ(config.hardware_limit_dn, 999);
  EXPECT_EQ(config.uncertainty_dn, 120);
}

TEST(Figures, stroke_and_volume_follow_from_the_kit) {
  const plant::Parameters parameters =
      plant_parameters({.max_squeeze_n = 54, .separation_min_mm = 10, .separation_max_mm = 60});
  EXPECT_DOUBLE_EQ(parameters.jaw.stroke_m, 0.025);
  EXPECT_DOUBLE_EQ(parameters.jaw.max_separation_m, 0.060);
  EXPECT_DOUBLE_EQ(parameters.air.close_area_m2, 1e-4);
}

TEST(Figures, a_passive_station_has_three_seats_and_no_force) {
  const core::Config config = core_config({.node = 3, .passive = true, .max_squeeze_n = 0});
  EXPECT_TRUE(config.passive);
  EXPECT_EQ(config.seat_switches, 0b111);
}

TEST(Figures, what_a_file_says_of_the_plant_replaces_the_plant_s_own) {
  const plant::Parameters parameters = plant_parameters({.plant = {.supply_bar = 5.5,
                                                                   .spring_n = 3,
                                                                   .keeper_n = 40,
                                                                   .contact_n_mm = 1000,
                                                                   .close_conductance_dm3_s_bar = 0.02}});
  EXPECT_DOUBLE_EQ(parameters.supply.nominal_pa, 5.5e5);
  EXPECT_DOUBLE_EQ(parameters.air.spring_n, 3);
  EXPECT_DOUBLE_EQ(parameters.air.keeper_n, 40);
  EXPECT_DOUBLE_EQ(parameters.jaw.contact_n_m, 1e6);
  EXPECT_DOUBLE_EQ(parameters.air.fill.conductance_m3_s_pa, 0.02e-8);
  EXPECT_EQ(core_config({.plant = {.spring_n = 3}}).spring_dn, 30);
}

}  // namespace
}  // namespace pinjaw::node

#include "firmware_sim/node/figures.hpp"

#include <cmath>

#include "firmware_sim/node/units.hpp"

namespace pinjaw::node {
namespace {

constexpr double kUdnPerMbarPerM2 = 1e9;       // 1 mbar on 1 m2 is 100 N, in units of 1e-7 N
constexpr std::uint8_t kSeatSwitches = 0b111;  // three pins locate on a passive station (BB 3.6)

constexpr double kPa_per_bar = 1e5;

void set(double& value, const std::optional<double>& figure, double unit) {
  if (figure) value = *figure * unit;
}

void apply(const PlantFigures& figures, plant::Parameters& parameters) {
  set(parameters.supply.nominal_pa, figures.supply_bar, kPa_per_bar);
  set(parameters.supply.droop_pa, figures.supply_droop_bar, kPa_per_bar);
  set(parameters.jaw.moving_mass_kg, figures.moving_mass_kg, 1);
  set(parameters.air.dead_volume_m3, figures.dead_volume_cm3, 1e-6);
  set(parameters.air.spring_n, figures.spring_n, 1);
  set(parameters.air.keeper_n, figures.keeper_n, 1);
  set(parameters.friction.coulomb_n, figures.coulomb_friction_n, 1);
  set(parameters.friction.breakaway_n, figures.breakaway_friction_n, 1);
  set(parameters.jaw.contact_n_m, figures.contact_n_mm, 1e3);
  set(parameters.air.fill.conductance_m3_s_pa, figures.close_conductance_dm3_s_bar, plant::kDm3PerSecondBar);
  set(parameters.air.close_leak.conductance_m3_s_pa, figures.leak_dm3_s_bar, plant::kDm3PerSecondBar);
  set(parameters.sensors.pressure_noise_pa, figures.pressure_noise_mbar, kPa_per_mbar);
  set(parameters.sensors.pressure_offset_pa, figures.pressure_offset_mbar, kPa_per_mbar);
}

}  // namespace

plant::Parameters plant_parameters(const Figures& figures) {
  plant::Parameters parameters =
      plant::parameters_for({.max_squeeze_n = figures.max_squeeze_n,
                             .uncertainty_n = figures.force_uncertainty_n,
                             .max_separation_m = figures.separation_max_mm * 1e-3,
                             .min_separation_m = figures.separation_min_mm * 1e-3});
  apply(figures.plant, parameters);
  return parameters;
}

core::Config core_config(const Figures& figures) {
  core::Config config;
  config.node = static_cast<std::uint8_t>(figures.node);
  config.passive = figures.passive;
  config.kit_id = figures.kit_id;
  config.key = figures.key;
  config.can_fd = figures.can_fd;
  config.seat_switches = figures.passive ? kSeatSwitches : std::uint8_t{0};
  config.separation_min_10um = whole(figures.separation_min_mm * 100);
  config.separation_max_10um = whole(figures.separation_max_mm * 100);
  if (figures.passive) return config;
  const plant::Parameters parameters = plant_parameters(figures);
  config.hardware_limit_dn = whole(std::floor(figures.max_squeeze_n * 10));
  config.uncertainty_dn = whole(std::ceil(figures.force_uncertainty_n * 10));
  config.area_udn_per_mbar = whole(parameters.air.close_area_m2 * kUdnPerMbarPerM2);
  config.open_ratio_permille = whole(1000 * parameters.air.open_area_m2 / parameters.air.close_area_m2);
  config.spring_dn = whole(parameters.air.spring_n * 10);
  config.pressure_max_mbar = whole(parameters.regulator.full_scale_pa / kPa_per_mbar);
  return config;
}

}  // namespace pinjaw::node

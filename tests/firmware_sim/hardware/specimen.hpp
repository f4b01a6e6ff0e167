#pragma once

#include <cmath>

#include "firmware_sim/plant/noise.hpp"
#include "firmware_sim/plant/parameters.hpp"

/// Grippers as they may come from the shop: every figure of the plant drawn.
namespace pinjaw::test {

/// Draws of one specimen, all from its seed.
struct Draws {
  plant::Noise noise;
  double between(double low, double high) { return low + (high - low) * (noise.symmetric() + 1) / 2; }
  double about(double value, double share) { return value * between(1 - share, 1 + share); }
  bool half() { return noise.symmetric() < 0; }
};

constexpr double kTolerance = 0.3;  // of friction, stiffness, mass, leak: the specification
constexpr double kMade = 0.2;       // chosen: of orifices, volumes, lags, noise, as catalogues state them

inline void draw_plant(Draws& draws, plant::Parameters& p) {
  const auto vary = [&](double& value) { value = draws.about(value, kMade); };
  const double friction = draws.about(1, kTolerance);
  p.friction.coulomb_n *= friction;
  p.friction.breakaway_n *= friction;
  vary(p.friction.viscous_n_s_m);
  vary(p.friction.stribeck_m_s);
  p.jaw.contact_n_m = std::exp(draws.between(std::log(1.4e6), std::log(5.2e6)));  // 2e6 to 4e6, +-30 %
  vary(p.jaw.contact_damping_n_s_m);
  p.jaw.moving_mass_kg = draws.about(p.jaw.moving_mass_kg, kTolerance);
  vary(p.air.dead_volume_m3);
  for (plant::Restriction* line : {&p.air.fill, &p.air.relax, &p.air.meter_out, &p.air.open_fill}) {
    vary(line->conductance_m3_s_pa);
  }
  vary(p.air.check_cracking_pa);
  if (draws.half()) p.air.law = plant::AirLaw::EnergyBalance;
  p.air.wall_w_K *= std::exp2(draws.between(-1, 1));
  p.air.close_leak.conductance_m3_s_pa = draws.half() ? 0 : draws.between(0, 1.3 * 0.0024e-6 / 6e5);
  p.supply.nominal_pa =
      draws.between(5.5e5, 6.5e5);  // 6 +- 0.5 bar; with 30 % less no gripper reaches its limit
  vary(p.supply.droop_pa);
  vary(p.regulator.delay_s);
  vary(p.regulator.first_lag_s);
  vary(p.regulator.second_lag_s);
  vary(p.regulator.hysteresis_pa);
  vary(p.spool.on_delay_s);
  vary(p.spool.off_delay_s);
  vary(p.sensors.pressure_noise_pa);
  vary(p.sensors.pressure_lag_s);
  vary(p.air.soft_start_pa);
  vary(p.air.soft_start_opens_pa);
}

}  // namespace pinjaw::test

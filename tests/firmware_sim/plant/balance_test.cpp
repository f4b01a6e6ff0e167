// Promises: PLANT, PLANT-BALANCE.
// What comes in is there or went out: mass, energy, and the error of the step.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/firmware_sim/plant/stand.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::plant {
namespace {

// Recomputed here from pressures, temperatures and the drawing, not with the plant's own functions.
constexpr double kHeatVolume = 717.625;  // J/(kg K): 287.05 / 0.4

struct Air {
  double mass_kg = 0;
  double energy_j = 0;
};

Air air_in(const Stand& stand) {
  const AirParameters& air = stand.parameters.air;
  const State& s = stand.state;
  const double close_m3 = air.dead_volume_m3 + air.close_area_m2 * s.displacement_m;
  const double open_m3 =
      air.dead_volume_m3 + air.open_area_m2 * (stand.parameters.jaw.stroke_m - s.displacement_m);
  const double close_kg = s.close_pa * close_m3 / (287.05 * s.close_K);
  const double open_kg = s.open_pa * open_m3 / (287.05 * s.open_K);
  return {close_kg + open_kg, kHeatVolume * (close_kg * s.close_K + open_kg * s.open_K)};
}

struct Motion {
  double kinetic_j = 0;
  double contact_j = 0;  ///< stored in the part's and the stops' springs
  double bristle_j = 0;
};

Motion motion_of(const Stand& stand) {
  const JawParameters& jaw = stand.parameters.jaw;
  const State& s = stand.state;
  const double depth_m =
      std::max(0.0, s.displacement_m - (jaw.max_separation_m - stand.inputs.contact.separation_m) / 2);
  const double opened_m = std::max(0.0, -s.displacement_m);
  return {
      .kinetic_j = 0.5 * jaw.moving_mass_kg * s.speed_m_s * s.speed_m_s,
      .contact_j = 0.5 * jaw.contact_n_m * depth_m * depth_m + 0.5 * jaw.end_stop_n_m * opened_m * opened_m,
      .bristle_j = 0.5 * stand.parameters.friction.bristle_n_m * s.friction.bristle_m * s.friction.bristle_m};
}

/// Closes on the part, squeezes, relaxes, opens to the stop: every port of both chambers in use.
Stand cycled(AirLaw law, double dt_s, const std::function<void(Stand&)>& each = nullptr) {
  Stand stand = study_stand();
  stand.parameters.air.law = law;
  stand.inputs.faults.close_leak.conductance_m3_s_pa = 1e-11;
  stand.dt_s = dt_s;
  const auto phase = [&](const Actuation& actuation, double duration_s) {
    stand.inputs.actuation = actuation;
    stand.run(duration_s, each);
  };
  phase({.spool = Spool::Close, .close_set_pa = 1e5}, 0.6);
  phase({.spool = Spool::Close, .close_set_pa = 4e5}, 0.3);
  phase({.spool = Spool::Close, .close_set_pa = 1e5, .relax = true}, 0.2);
  phase({.spool = Spool::Open}, 0.4);
  phase({.spool = Spool::Hold, .vent_open = true}, 0.2);
  return stand;
}

double air_out_of_balance(const Stand& stand, double before_kg) {
  const Ledger& ledger = stand.state.ledger;
  return std::abs(air_in(stand).mass_kg - before_kg - (ledger.mass_in_kg - ledger.mass_out_kg)) /
         ledger.mass_in_kg;
}

TEST(Balance, every_gram_that_came_in_is_in_the_chambers_or_went_out) {
  const double before_kg = air_in(study_stand()).mass_kg;
  double worst = 0;
  cycled(AirLaw::EnergyBalance, kStep_s, [&](Stand& stand) {
    if (stand.state.ledger.mass_in_kg > 0) worst = std::max(worst, air_out_of_balance(stand, before_kg));
  });
  test::figure("PLANT-BALANCE", "air in less air out less air in the chambers, worst of air in", worst,
               "share");
  EXPECT_LT(worst, 1e-10);
}

TEST(Balance, the_polytropic_law_alone_loses_air) {
  const double before_kg = air_in(study_stand()).mass_kg;
  const Stand stand = cycled(AirLaw::Polytropic, kStep_s);
  EXPECT_GT(air_out_of_balance(stand, before_kg), 1e-3);
}

TEST(Balance, enthalpy_in_is_enthalpy_out_and_heat_and_work_and_what_the_air_keeps) {
  const double before_j = air_in(study_stand()).energy_j;
  double worst = 0;
  cycled(AirLaw::EnergyBalance, kStep_s, [&](Stand& stand) {
    const Ledger& l = stand.state.ledger;
    if (l.enthalpy_in_j <= 0) return;
    const double kept_j = air_in(stand).energy_j - before_j;
    const double booked_j = l.enthalpy_in_j - l.enthalpy_out_j + l.wall_heat_j - l.piston_work_j;
    worst = std::max(worst, std::abs(kept_j - booked_j) / l.enthalpy_in_j);
  });
  test::figure("PLANT-BALANCE", "energy of the air out of balance, worst of enthalpy in", worst, "share");
  EXPECT_LT(worst, 1e-9);
}

/// Work of the air on the jaws, less that on the room, that came to be neither motion nor friction nor
/// contact.
double work_out_of_balance(double dt_s) {
  const Stand stand = cycled(AirLaw::EnergyBalance, dt_s);
  const AirParameters& air = stand.parameters.air;
  const Ledger& l = stand.state.ledger;
  const double room_j = kAtmosphere_Pa * (air.close_area_m2 - air.open_area_m2) * stand.state.displacement_m;
  const double jaws_j = motion_of(stand).kinetic_j + l.friction_j + l.stops_j;
  return std::abs(l.piston_work_j - room_j - jaws_j) / (l.friction_j + l.stops_j);
}

TEST(Balance, the_air_s_work_is_motion_and_friction_and_contact_but_for_an_error_of_the_step_s_order) {
  const double at_20_us = work_out_of_balance(kStep_s);
  const double at_10_us = work_out_of_balance(kStep_s / 2);
  const double at_5_us = work_out_of_balance(kStep_s / 4);
  test::figure("PLANT-BALANCE", "work of the air out of balance at 20 us, of what friction and contact took",
               at_20_us, "share");
  EXPECT_LT(at_20_us, 0.05);  // nearly all of it where the jaws hit their stop
  EXPECT_NEAR(at_20_us / at_10_us, 2.0, 0.5);
  EXPECT_NEAR(at_10_us / at_5_us, 2.0, 0.5);
}

TEST(Balance, friction_and_contact_only_take) {
  double friction_least_j = 0;
  double stops_least_j = 0;
  cycled(AirLaw::EnergyBalance, kStep_s, [&](Stand& stand) {
    const Motion motion = motion_of(stand);
    friction_least_j = std::min(friction_least_j, stand.state.ledger.friction_j - motion.bristle_j);
    stops_least_j = std::min(stops_least_j, stand.state.ledger.stops_j - motion.contact_j);
  });
  EXPECT_GT(friction_least_j, -1e-5);  // 9 N of bristles at 9 um are 4e-5 J
  EXPECT_GT(stops_least_j, -1e-4);     // 10 mJ of contact
}

/// Pressure of a chamber that is filled from 1 bar with the jaws at their stop.
double filled_pa(double wall_w_K, AirLaw law, double exponent) {
  Stand stand = study_stand();
  stand.parameters.air.law = law;
  stand.parameters.air.wall_w_K = wall_w_K;
  stand.parameters.air.polytropic = exponent;
  stand.parameters.air.close_area_m2 = 1e-9;  // pushes nothing
  stand.inputs.faults.soft_start = Stick::On;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 6e5};
  stand.run(0.15);
  return stand.state.close_pa;
}

TEST(Balance, walls_without_heat_are_adiabatic_and_walls_of_endless_heat_isothermal) {
  EXPECT_NEAR(filled_pa(0, AirLaw::EnergyBalance, 0) / filled_pa(0, AirLaw::Polytropic, 1.4), 1.0, 1e-3);
  EXPECT_NEAR(filled_pa(1e2, AirLaw::EnergyBalance, 0) / filled_pa(0, AirLaw::Polytropic, 1.0), 1.0, 2e-3);
}

TEST(Balance,
     an_exponent_of_1_2_lies_between_the_two_and_no_further_than_a_tenth_from_the_walls_of_the_hose) {
  const double usual_pa = filled_pa(AirParameters{}.wall_w_K, AirLaw::EnergyBalance, 0);
  EXPECT_LT(usual_pa, filled_pa(0, AirLaw::Polytropic, 1.4));
  EXPECT_GT(usual_pa, filled_pa(0, AirLaw::Polytropic, 1.0));
  EXPECT_NEAR(usual_pa / filled_pa(0, AirLaw::Polytropic, 1.2), 1.0, 0.1);
}

/// A free closing in full swing: past the soft start at once, or through it.
struct Swing {
  const char* name = "";
  AirLaw law = AirLaw::Polytropic;
  Stick soft_start = Stick::On;
  double time_s = 0.05;
};

/// Where the jaws are at its time.
double closing_m(const Swing& swing, double dt_s) {
  Stand stand = study_stand();
  stand.parameters.air.law = swing.law;
  stand.parameters.spool = {.on_delay_s = 0, .off_delay_s = 0};
  stand.inputs.faults.soft_start = swing.soft_start;
  stand.inputs.contact.present = false;
  stand.inputs.faults.regulator = RegulatorFault::Open;
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 6e5};
  const auto steps = static_cast<int>(std::lround(swing.time_s / dt_s));
  for (int i = 0; i < steps; ++i) step(stand.parameters, stand.inputs, dt_s, stand.state);
  return stand.state.displacement_m;
}

TEST(Balance, the_error_of_a_step_is_of_first_order) {
  for (const Swing& swing :
       {Swing{.name = "polytropic"}, Swing{.name = "energy balance", .law = AirLaw::EnergyBalance},
        Swing{.name = "soft start", .soft_start = Stick::Free, .time_s = 0.12}}) {
    const double best_m = closing_m(swing, 0.625e-6);
    std::vector<double> errors_m;
    for (const double dt_s : {80e-6, 40e-6, 20e-6, 10e-6}) {
      errors_m.push_back(std::abs(closing_m(swing, dt_s) - best_m));
    }
    ASSERT_GT(best_m, 1e-3);
    const double order = std::log2(errors_m.front() / errors_m.back()) / 3;
    test::figure("PLANT-BALANCE", std::string("order of the step's error, ") + swing.name, order, "1");
    EXPECT_GT(order, 0.9);
    EXPECT_LT(order, 1.2);
    EXPECT_LT(errors_m[2], 1e-4 * 7) << "at 20 us, of 7 mm";
  }
}

}  // namespace
}  // namespace pinjaw::plant

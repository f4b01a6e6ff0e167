#include "firmware_sim/plant/parameters.hpp"

#include <algorithm>

namespace pinjaw::plant {
namespace {
constexpr double kOpenAreaShare = 0.85;    // study: the rod takes the rest
constexpr double kStudyArea_m2 = 2.59e-4;  // the same
constexpr double kStudyStroke_m = 0.007;   // the same
constexpr double kReliefShare = 1.07;      // the same: 150 N for 140 N
constexpr double kPreVent_pa = 0.5e5;      // the same: gauge, left on the open side when the jaws start
constexpr double kPressed_n = 17;          // chosen: rested seals let go at 12 N (9 N and 30 %)
constexpr double kLight_n = 13;            // chosen: the usual light squeeze of 12 N and a little
constexpr double kApproach_n = 25;  // chosen: what an approach pushes with, 12 N of doubt beside, is enough

/// Volume of the close chamber at mid-stroke.
double mid_volume_m3(const AirParameters& air, double stroke_m) {
  return air.dead_volume_m3 + air.close_area_m2 * stroke_m / 2;
}

/// Jaws and seals of a gripper of `share` of the study's force: the pressure that just moves a cylinder
/// hardly depends on its bore.
void shrink(Parameters& parameters, double share) {
  FrictionParameters& friction = parameters.friction;
  JawParameters& jaw = parameters.jaw;
  for (double* figure :
       {&friction.coulomb_n, &friction.breakaway_n, &friction.viscous_n_s_m, &friction.bristle_n_m,
        &friction.bristle_damping_n_s_m, &jaw.moving_mass_kg, &jaw.contact_n_m, &jaw.contact_damping_n_s_m,
        &jaw.end_stop_n_m, &jaw.end_stop_damping_n_s_m}) {
    *figure *= share;
  }
}

}  // namespace

Parameters parameters_for(const Sizing& sizing) {
  Parameters parameters;
  parameters.air.close_area_m2 = sizing.max_squeeze_n / kSizingPressure_Pa;
  parameters.air.open_area_m2 = kOpenAreaShare * parameters.air.close_area_m2;
  parameters.air.relief_pa = kReliefShare * kSizingPressure_Pa;
  const double share = std::min(1.0, parameters.air.close_area_m2 / kStudyArea_m2);
  shrink(parameters, share);
  const double approach_n = std::min(kApproach_n, kLight_n + sizing.uncertainty_n);
  parameters.air.soft_start_opens_pa = share * kPressed_n / parameters.air.close_area_m2;
  parameters.air.soft_start_pa = approach_n / parameters.air.close_area_m2 + kOpenAreaShare * kPreVent_pa +
                                 parameters.air.check_cracking_pa;
  for (Restriction* line : {&parameters.air.relax, &parameters.air.meter_out, &parameters.air.open_fill}) {
    line->conductance_m3_s_pa *= parameters.air.close_area_m2 / kStudyArea_m2;
  }
  parameters.jaw.max_separation_m = sizing.max_separation_m;
  parameters.jaw.stroke_m = (sizing.max_separation_m - sizing.min_separation_m) / 2;
  // The orifice is sized with the volume behind it, so that a regulator stuck open adds 0.45 N/ms at most.
  AirParameters study = parameters.air;
  study.close_area_m2 = kStudyArea_m2;
  parameters.air.fill.conductance_m3_s_pa *=
      mid_volume_m3(parameters.air, parameters.jaw.stroke_m) / mid_volume_m3(study, kStudyStroke_m);
  return parameters;
}

}  // namespace pinjaw::plant

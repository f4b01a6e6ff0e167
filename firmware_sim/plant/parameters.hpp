#pragma once

#include <cstdint>

#include "firmware_sim/plant/flow.hpp"
#include "firmware_sim/plant/friction.hpp"

namespace pinjaw::plant {

/// What sizes one gripper's pneumatics.
struct Sizing {
  double max_squeeze_n = 140;  ///< sum of both jaws, at kSizingPressure_Pa
  double uncertainty_n = 12;   ///< of the force inferred from pressure: what an approach pushes with beside
  double max_separation_m = 0.060;  ///< jaws fully open
  double min_separation_m = 0.0;    ///< jaws fully closed
};

/// How the air in a chamber answers to flow and stroke.
enum class AirLaw : std::uint8_t {
  /// One exponent between slow and fast, no temperature. It keeps neither mass nor energy: a chamber that was
  /// filled and vented has no more of a memory than its pressure.
  Polytropic,
  /// Mass and inner energy of the air, enthalpy at the ports, heat from the walls: both balances close.
  EnergyBalance,
};

/// The two cylinder chambers' and the spool's air.
///
/// A keeper of 35 to 45 N (study) that always presses would exclude a light squeeze of 12 N, and would close
/// the open jaws whenever their air is gone. So the keeper's spring stands behind a floating piston with a
/// catch: a squeeze of `keeper_engage_share` times its force lets it go, air on the open side draws it back.
/// Let go, it gives what the air lacks of `keeper_n` and nothing more, so that the controller need not know
/// of it: what it infers from pressure is then low, never high. Its price: after RETAIN the receiver's light
/// squeeze is the keeper's until it opens.
///
/// A regulator that sticks open behind resting seals would throw the jaws at the part, faster than any valve
/// shuts: once the seals let go, 0.1 mm of travel under 20 N too much is the speed that a touch may have. So
/// the close line has a soft start of two standard valves. A fixed reducing valve passes `soft_start_pa`,
/// more than any approach needs; a sequence valve, piloted by both chambers against each other, opens a way
/// around it once they press with more than driving the jaws takes, that is when the jaws stand at the part.
struct AirParameters {
  double close_area_m2 = 0;  ///< effective: sum of both jaws' force per Pa, lever losses included
  double open_area_m2 = 0;
  double dead_volume_m3 = 4e-6;  // study: 1.5 cm3 dead and 2.5 cm3 hose
  AirLaw law = AirLaw::Polytropic;
  double polytropic = 1.2;                          // the same: between 1.0 (slow) and 1.4 (fast)
  Restriction fill{0.01 * kDm3PerSecondBar, 0.3};   // the same: orifice in the close line, 0.45 N/ms at most
  double soft_start_pa = 0;                         ///< gauge, let into the close line before the jaws press
  double soft_start_opens_pa = 0;                   ///< of the close side over the open, by their areas
  double soft_start_shuts_share = 0.7;              // chosen: of that; no chatter at a light squeeze
  Restriction relax{0.05 * kDm3PerSecondBar, 0.3};  // study, throttled 5/2: the close chamber's way out
  // chosen: the open chamber's way out while closing; some 20 mm/s a jaw at 12 N
  Restriction meter_out{0.0065 * kDm3PerSecondBar, 0.3};
  Restriction open_fill{0.05 * kDm3PerSecondBar, 0.3};  // as relax
  double check_cracking_pa = 0.2e5;                     // the same: pilot-operated check valve
  Restriction close_leak{0, 0.3};                       ///< this specimen's, close chamber to the room
  double relief_pa = 0;                                 ///< gauge, of the close chamber
  Restriction relief{0.3 * kDm3PerSecondBar, 0.3};      // SY3000-class seat, wide open
  double relief_span = 0.03;                            // chosen: wide open 3 % above where it starts
  double wall_w_K = 0.4;              // chosen: 60 cm2 of hose and cylinder at 60 W/(m2 K); 60 ms at 6 bar
  double spring_n = 0;                ///< closing and always there; the lightest squeeze is not under it
  double keeper_n = 0;                ///< the spring behind a catch; 0: none
  double keeper_engage_share = 1.25;  // chosen: no jump of force where the catch lets go
  double keeper_release_pa = 1e5;     // chosen: gauge, on the open side
};

struct RegulatorParameters {
  double delay_s = 0.005;      // chosen: within the 50 to 100 ms of the class (VPPE, study)
  double first_lag_s = 0.015;  // chosen: with the next, 63 % in 40 ms and 90 % in 75 ms
  double second_lag_s = 0.015;
  double linearity = 0.01;  // study: 1 % of full scale
  double full_scale_pa = 6e5;
  double hysteresis_pa = 0.03e5;  // study: 0.5 % of full scale
  double resolution_pa = 1e3;     // study: 10 mbar (MPA-S)
};

struct SpoolParameters {
  double on_delay_s = 0.012;   // study: 5/2 solenoid
  double off_delay_s = 0.020;  // study
};

struct SupplyParameters {
  double nominal_pa = 6e5;     // gauge; study: 6 +/- 0.5 bar
  double droop_pa = 0.8e5;     // study: when a neighbour moves
  double droop_lag_s = 0.080;  // study
  double loss_lag_s = 0.300;   // study
};

struct JawParameters {
  double moving_mass_kg = 0.35;        // study: jaws, grid plates, pins
  double stroke_m = 0.030;             ///< of each jaw
  double max_separation_m = 0.060;     ///< at displacement 0
  double contact_n_m = 4e6;            // study: two 6.35 mm steel pins a jaw and the jaw guide, sum over jaws
  double contact_damping_n_s_m = 450;  // study: 300 to 600
  double end_stop_n_m = 1e7;           // chosen: stiffer than the contact
  double end_stop_damping_n_s_m = 1500;  // chosen: little rebound
};

struct SensorParameters {
  double pressure_step_pa = 10e5 / 4096;  // study: 12 bit over 10 bar
  double pressure_noise_pa = 500;         // study: 5 mbar rms
  double pressure_offset_pa = 0.1e5;      // study: +/- 1 % of full scale, drawn per sensor
  double pressure_lag_s = 0.002;          // study: filter
  double pressure_range_pa = 10e5;
  double position_step_m = 1e-5;  // study: 10 um
};

/// One gripper's pneumatics, mechanics and sensors, in SI. 'Study' is docs/reliability.md, section 3 (Nov
/// 2026: catalogue figures of SMC SY3000, PHD GRS, Festo VPPE and MPA-S, and own lumped simulations).
struct Parameters {
  AirParameters air;
  RegulatorParameters regulator;
  SpoolParameters spool;
  SupplyParameters supply;
  JawParameters jaw;
  FrictionParameters friction;
  SensorParameters sensors;
};

constexpr double kSizingPressure_Pa = 5.4e5;  // gauge; study: 140 N from 2.59e-4 m2

/// The figures above with the area, stroke, relief, soft start and orifices that follow from `sizing`: a
/// bigger gripper moves as fast under the same force. A smaller one than the study's has smaller seals and
/// jaws, so that friction, moving mass and stiffness shrink with its force; a bigger one keeps the study's.
Parameters parameters_for(const Sizing& sizing);

}  // namespace pinjaw::plant

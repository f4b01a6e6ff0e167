#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware_sim/plant/faults.hpp"
#include "firmware_sim/plant/noise.hpp"
#include "firmware_sim/plant/parameters.hpp"

/// One gripper's coupled jaw pair: valves, air, friction, contact, sensors. It knows nothing of controllers.
///
/// The coordinate is the displacement x of each jaw from fully open, so the separation is s_max - 2x, and
/// every force is the sum of both jaws. Pressures are absolute inside, gauge where a name says so.
namespace pinjaw::plant {

/// What the controller's outputs do.
struct Actuation {
  Spool spool = Spool::Hold;
  double close_set_pa = 0;  ///< gauge: the regulator's set point
  bool relax = false;       ///< lifts the check valve: the close chamber may blow back to the regulator
  bool vent_open = false;   ///< the open chamber's pre-vent past the meter-out
  bool supply_cut = false;  ///< the cut-off before the regulator
};

/// The part between the jaws, as the pins see it.
struct Contact {
  bool present = false;
  double separation_m = 0;  ///< where both jaws touch it
  bool fixed = false;       ///< another holder keeps it from centring itself
  double offset_m = 0;      ///< of a fixed part from the jaws' centre, towards the right jaw
};

struct Inputs {
  Actuation actuation;
  Contact contact;
  bool neighbour_moves = false;  ///< the supply droops
  Faults faults;
};

/// What the sensors say. Pressures are gauge.
struct Readings {
  std::array<double, 2> close_pa{};  ///< two independent sensors
  std::array<double, 2> open_pa{};
  double supply_pa = 0;
  double separation_m = 0;
};

/// What crossed the two chambers' ports and walls so far, for balances; nothing in the plant reads it.
struct Ledger {
  double mass_in_kg = 0;
  double mass_out_kg = 0;
  double enthalpy_in_j = 0;  ///< this and the next two with AirLaw::EnergyBalance only
  double enthalpy_out_j = 0;
  double wall_heat_j = 0;    ///< from the walls into the air
  double piston_work_j = 0;  ///< of the air in both chambers on the piston
  double friction_j = 0;     ///< from the jaws into friction, what its bristles store included
  double stops_j = 0;        ///< the same into part and end stops
};

/// Everything that changes. A plain value: a copy is a snapshot.
struct State {
  double displacement_m = 0;
  double speed_m_s = 0;
  double close_pa = kAtmosphere_Pa;
  double open_pa = kAtmosphere_Pa;
  double close_K = kTemperature_K;  ///< stays with AirLaw::Polytropic, which has no temperature
  double open_K = kTemperature_K;
  bool keeper_engaged = false;
  bool soft_start_open = false;  ///< the way around the reducing valve
  FrictionState friction;

  double supply_pa = 0;  ///< absolute
  double droop_pa = 0;
  std::array<double, 16> set_history_pa{};  ///< set points of the last ms, the newest at `set_newest`
  std::size_t set_newest = 0;
  double set_age_s = 0;
  double followed_set_pa = 0;     ///< after hysteresis
  double regulator_inner_pa = 0;  ///< gauge
  double regulator_pa = 0;        ///< gauge
  Spool spool = Spool::Hold;
  Spool spool_goal = Spool::Hold;
  double spool_wait_s = 0;

  double left_n = 0;  ///< true contact force on each jaw
  double right_n = 0;
  Ledger ledger;

  std::array<double, 4> sensed_pa{};  ///< after the filters: close A, B, open A, B; gauge
  double sensed_position_m = 0;
  std::array<double, 4> sensor_drift_pa{};  ///< that a fault has built up
  double position_drift_m = 0;

  double regulator_gain_error = 0;
  std::array<double, 4> sensor_offset_pa{};
  Noise noise;
};

/// At rest at `separation_m`, without air in the chambers but with supply; draws the errors of this specimen.
State initial_state(const Parameters& parameters, std::uint64_t seed, double separation_m);

/// One semi-implicit Euler step; `dt_s` is 20 us in every use but tests of convergence.
void step(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state);

/// One reading of the sensors, with fresh noise.
Readings read(const Parameters& parameters, const Faults& faults, State& state);

/// Nothing in the plant acts on the jaws or will by itself: both chambers are shut in or vented, the valve is
/// at rest, and the jaws stand in balance.
bool at_rest(const Parameters& parameters, const Inputs& inputs, const State& state);

/// As `step`, of a plant at rest: what acts on the jaws stays, and a millisecond is one step of what is left
/// (supply, regulator, sensors, the seals' age).
void coast(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state);

constexpr double kStep_s = 20e-6;  // study: stable with the stiffest contact

double separation_m(const Parameters& parameters, const State& state);

/// True contact force, sum of both jaws.
inline double squeeze_n(const State& state) {
  return state.left_n + state.right_n;
}

}  // namespace pinjaw::plant

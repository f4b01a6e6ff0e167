#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware_sim/plant/noise.hpp"
#include "firmware_sim/plant/parameters.hpp"

/// One gripper's coupled jaw pair: valves, air, friction, contact, sensors. It knows nothing of controllers.
///
/// The coordinate is the displacement x of each jaw from fully open, so the separation is s_max - 2x, and
/// every force is the sum of both jaws. Pressures are absolute inside, gauge where a name says so.
namespace pinjaw::plant {

/// Positions of the main spool. Hold is where the spring puts it without current: the close chamber is shut
/// in by its check valve, the open chamber is vented, so that nothing opens.
enum class Spool : std::uint8_t { Hold, Close, Open };

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

/// Faults of the hardware; all of them default to none.
struct Faults {
  Restriction close_leak{0, 0.3};  ///< close chamber to the room
  bool spool_stuck = false;        ///< stays where it is
  bool regulator_open = false;     ///< stuck open: full supply
  bool supply_lost = false;
  std::array<double, 2> close_sensor_offset_pa{};  ///< beside the drawn one; sensors A and B
  bool position_stuck = false;
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

/// Everything that changes. A plain value: a copy is a snapshot.
struct State {
  double displacement_m = 0;
  double speed_m_s = 0;
  double close_pa = kAtmosphere_Pa;
  double open_pa = kAtmosphere_Pa;
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
  double mass_in_kg = 0;  ///< air let into the two chambers, less what left

  std::array<double, 4> sensed_pa{};  ///< after the filters: close A, B, open A, B; gauge
  double sensed_position_m = 0;

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

constexpr double kStep_s = 20e-6;  // study: stable with the stiffest contact

double separation_m(const Parameters& parameters, const State& state);

/// True contact force, sum of both jaws.
inline double squeeze_n(const State& state) {
  return state.left_n + state.right_n;
}

}  // namespace pinjaw::plant

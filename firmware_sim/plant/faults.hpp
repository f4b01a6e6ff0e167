#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "firmware_sim/plant/flow.hpp"

namespace pinjaw::plant {

/// Positions of the main spool. Hold is where the spring puts it without current: the close chamber is shut
/// in by its check valve, the open chamber is vented, so that nothing opens.
enum class Spool : std::uint8_t { Hold, Close, Open };

/// A valve of two positions that no longer follows its coil.
enum class Stick : std::uint8_t {
  Free,
  Off,  ///< as without current
  On,
};

enum class RegulatorFault : std::uint8_t {
  None,
  Open,    ///< full supply
  Closed,  ///< nothing
  Stuck,   ///< what it gave last
};

/// What is wrong with one sensor; offset and drift in its own unit, Pa or m of separation.
struct SensorFault {
  double offset = 0;
  double drift_per_s = 0;
  bool stuck = false;  ///< repeats itself
  bool lost = false;   ///< reads the end of its range, as with a broken wire
};

/// Faults of the hardware; all of them default to none.
struct Faults {
  Restriction close_leak{0, 0.3};        ///< close chamber to the room
  bool spool_stuck = false;              ///< stays where it is
  std::optional<Spool> spool_sticks_at;  ///< stays there once it has come there
  Stick relax = Stick::Free;             ///< the check valve's lift; On: it does not seat
  Stick vent = Stick::Free;              ///< the open chamber's pre-vent
  Stick cut = Stick::Free;               ///< the supply's cut-off; On: it cuts
  Stick soft_start = Stick::Free;        ///< its way around the reducing valve; On: open
  RegulatorFault regulator = RegulatorFault::None;
  bool supply_lost = false;
  std::array<SensorFault, 4> pressure{};  ///< close A, close B, open A, open B
  SensorFault position;
};

}  // namespace pinjaw::plant

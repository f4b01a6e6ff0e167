#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "firmware_sim/plant/plant.hpp"

namespace pinjaw::node {

/// One fault of a node's hardware.
struct Fault {
  enum class Kind {
    Leak,  ///< close chamber, cm3/s of free air at 5 bar
    SpoolStuck,
    RegulatorOpen,
    SupplyLost,
    SensorA,  ///< close pressure sensor's offset, mbar
    SensorB,
    PositionStuck,
    NvmFailed,
  };
  Kind kind = Kind::Leak;
  double value = 0;  ///< of Leak, SensorA, SensorB
};

/// Reads `leak=0.05`, `spool_stuck`, `regulator_open`, `supply_lost`, `sensor_a=300`, `sensor_b=-300`,
/// `position_stuck` or `nvm_failed`; else a sentence that says what is wrong.
tl::expected<Fault, std::string> parse_fault(std::string_view text);

/// The known faults, for help texts: `leak=CM3_S, spool_stuck, ...`.
std::string known_faults();

/// Adds a fault to those a plant has; NvmFailed is none of the plant's and changes nothing.
void add_fault(const Fault& fault, plant::Faults& faults);

}  // namespace pinjaw::node

#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "firmware_sim/plant/plant.hpp"

namespace pinjaw::node {

/// One fault of a node's hardware.
struct Fault {
  using Add = void (*)(double value, plant::Faults& faults);
  Add add = nullptr;  ///< to those a plant has; nothing: it is the permanent memory that fails
  double value = 0;   ///< where the fault's name takes one, in the unit that `known_faults` tells
};

/// Reads a fault as `known_faults` lists it: `leak=0.05`, `spool_stuck`, `sensor_a=300`; else a sentence that
/// says what is wrong.
tl::expected<Fault, std::string> parse_fault(std::string_view text);

/// The known faults, for help texts: `leak=CM3_S, spool_stuck, ...`.
std::string known_faults();

}  // namespace pinjaw::node

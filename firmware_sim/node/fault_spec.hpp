#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "firmware_sim/plant/plant.hpp"

namespace pinjaw::node {

/// One fault of a node.
struct Fault {
  enum class Of : std::uint8_t {
    Plant,
    Memory,     ///< the permanent one: from now on nothing is stored
    Processor,  ///< it hangs, once, until the watchdog resets it
  };
  using Add = void (*)(double value, plant::Faults& faults);
  Of of = Of::Plant;
  Add add = nullptr;  ///< to those a plant has
  double value = 0;   ///< where the fault's name takes one, in the unit that `known_faults` tells
};

/// Reads a fault as `known_faults` lists it: `leak=0.05`, `spool_stuck`, `sensor_a=300`; else a sentence that
/// says what is wrong.
tl::expected<Fault, std::string> parse_fault(std::string_view text);

/// The known faults, for help texts: `leak=CM3_S, spool_stuck, ...`.
std::string known_faults();

}  // namespace pinjaw::node

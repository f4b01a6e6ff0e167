#pragma once

#include <array>

#include "firmware_sim/core/core.hpp"

namespace pinjaw::firmware {

/// All memory that a controller needs besides its stack and its port. An image has one, with static lifetime.
struct Firmware {
  core::State state;
  core::Outputs outputs;
  core::NvmImage memory;                   ///< read once; the core keeps what it needs of it
  std::array<wire::Frame, 16> received{};  ///< of one step: four times what 1 ms of 500 kbit/s brings
};

/// Starts the board and the core. `fresh` is one as its default makes it.
void boot(Firmware& fresh);

/// One turn of the main loop: waits for the tick, steps the core, carries out what it says.
void turn(Firmware& firmware);

}  // namespace pinjaw::firmware

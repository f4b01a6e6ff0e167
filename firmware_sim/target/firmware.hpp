#pragma once

#include <array>
#include <cstddef>

#include "firmware_sim/core/core.hpp"

namespace pinjaw::firmware {

inline constexpr std::size_t kReceivedPerStep = 16;  ///< four times what 1 ms of 500 kbit/s brings

/// What a controller works with besides its state.
struct Work {
  core::Inputs inputs;
  core::Outputs outputs;
  std::array<wire::Frame, kReceivedPerStep> received{};  ///< in one step
};

/// Room for what memory held at power on, of which the core keeps what it needs, and from then on for Work.
/// It starts as zeros and not as their defaults, which would lie in flash as well: all of either is written
/// before it is read.
union Room {
  constexpr Room() : nothing(0) {}
  char nothing;
  core::NvmImage memory;
  Work work;
};

/// Starts the board and the core. `fresh` is one as its default makes it.
void boot(core::State& fresh, core::NvmImage& memory);

/// One turn of the main loop: waits for the tick, steps the core, carries out what it says.
void turn(core::State& state, Work& work);

}  // namespace pinjaw::firmware

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
  core::NvmImage memory;                                 ///< read once; the core keeps what it needs of it
  std::array<wire::Frame, kReceivedPerStep> received{};  ///< in one step
};

/// Room for Work that starts as zeros and not as its defaults, which would lie in flash a second time: all of
/// it is written before it is read.
union Room {
  constexpr Room() : nothing(0) {}
  char nothing;
  Work work;
};

/// Starts the board and the core. `fresh` is one as its default makes it.
void boot(core::State& fresh, Work& work);

/// One turn of the main loop: waits for the tick, steps the core, carries out what it says.
void turn(core::State& state, Work& work);

}  // namespace pinjaw::firmware

// The firmware's only static objects and its only endless loop.
#include <optional>

#include "firmware_sim/target/firmware.hpp"

namespace {
// Made when power comes: its defaults would lie in flash as well as in memory.
constinit std::optional<pinjaw::core::State> state;
constinit pinjaw::firmware::Room room;
}  // namespace

/// Where start-up code goes when memory is ready.
extern "C" [[noreturn]] void firmware_main();

void firmware_main() {
  pinjaw::firmware::boot(state.emplace(), room.memory);
  for (;;) pinjaw::firmware::turn(*state, room.work);
}

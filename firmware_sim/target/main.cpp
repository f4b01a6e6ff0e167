// The firmware's only static objects and its only endless loop.
#include "firmware_sim/target/firmware.hpp"

namespace {
constinit pinjaw::core::State state;
constinit pinjaw::firmware::Room room;
}  // namespace

/// Where start-up code goes when memory is ready.
extern "C" [[noreturn]] void firmware_main();

void firmware_main() {
  pinjaw::firmware::boot(state, room.work);
  for (;;) pinjaw::firmware::turn(state, room.work);
}

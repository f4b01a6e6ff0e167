// The firmware's only static object and its only endless loop.
#include "firmware_sim/target/firmware.hpp"

namespace pinjaw::firmware {
namespace {
constinit Firmware the_firmware;
}  // namespace
}  // namespace pinjaw::firmware

/// Where start-up code goes when memory is ready.
extern "C" [[noreturn]] void firmware_main();

void firmware_main() {
  pinjaw::firmware::boot(pinjaw::firmware::the_firmware);
  for (;;) pinjaw::firmware::turn(pinjaw::firmware::the_firmware);
}

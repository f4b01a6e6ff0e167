#pragma once

#include "protocol/wire/frame.hpp"

namespace pinjaw::bus {

/// Bits of a classic frame on the bus, stuff bits and the three bits of pause after it included (ISO
/// 11898-1). 0 for an error frame.
int bits_on_bus(const wire::Frame& frame);

}  // namespace pinjaw::bus

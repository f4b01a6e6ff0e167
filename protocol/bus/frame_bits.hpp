#pragma once

#include "protocol/wire/frame.hpp"

namespace pinjaw::bus {

/// Bits of a classic frame on the bus, stuff bits and the three bits of pause after it included (ISO
/// 11898-1). 0 for an error frame. A CAN FD frame's data phase counts at a quarter, as at 2 Mbit/s beside 500
/// kbit/s.
int bits_on_bus(const wire::Frame& frame);

}  // namespace pinjaw::bus

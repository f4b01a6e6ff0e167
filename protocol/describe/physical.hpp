#pragma once

#include <cstdint>
#include <string>

#include "protocol/wire/spec.hpp"

namespace pinjaw::describe {

/// `raw` times `factor` as the shortest exact decimal number.
std::string physical(std::uint64_t raw, wire::Ratio factor);

/// What a person calls the sender of a message of this direction.
const char* direction_text(wire::Direction direction);

}  // namespace pinjaw::describe

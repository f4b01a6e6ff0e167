#pragma once

#include <cstdint>
#include <string>

#include "firmware_sim/core/io.hpp"
#include "protocol/wire/codes.hpp"
#include "tests/firmware_sim/model_check/jaw.hpp"

/// What traces call things.
namespace pinjaw::core::model {

std::string station(std::uint8_t node);
std::string fact_name(wire::Fact fact);
std::string state_name(wire::State state);
std::string op_name(wire::Op op);
std::string custody_name(Custody custody);
std::string grip_name(Grip grip);

}  // namespace pinjaw::core::model

#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "protocol/bus/bus.hpp"

namespace pinjaw::bus {

/// One thing that goes wrong on a bus and is counted.
struct Trouble {
  const char* key;   ///< in JSON
  const char* text;  ///< for a person
  std::uint64_t Statistics::*count;
};

/// Every count of Statistics that should be 0.
inline constexpr std::array<Trouble, 10> kTroubles{{
    {"lost_receiving", "lost receiving", &Statistics::lost_receiving},
    {"lost_sending", "lost sending", &Statistics::lost_sending},
    {"error_frames", "error frames", &Statistics::error_frames},
    {"stalls", "full send queue", &Statistics::stalls},
    {"overruns", "overruns in the controller", &Statistics::overruns},
    {"unacknowledged", "unacknowledged", &Statistics::unacknowledged},
    {"passive", "error-passive", &Statistics::passive},
    {"bus_off", "bus-off", &Statistics::bus_off},
    {"restarts", "restarts", &Statistics::restarts},
    {"outages", "interface gone", &Statistics::outages},
}};

/// What went wrong, as "error frames 3, bus-off 1"; empty where nothing did.
std::string to_text(const Statistics& statistics);

}  // namespace pinjaw::bus

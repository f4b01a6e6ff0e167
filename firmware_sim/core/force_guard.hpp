#pragma once

#include <cstdint>

#include "firmware_sim/core/config.hpp"
#include "firmware_sim/core/io.hpp"

/// The last gate before the valves that can raise force. It knows no states and no commands: only the limit,
/// sensor B, and what the rest of the core wants (docs/reliability.md 2.1 and 3).
namespace pinjaw::core {

struct ForceGuard {
  std::uint16_t over_ms = 0;   ///< how long sensor B has put F_high over the limit
  std::uint16_t under_ms = 0;  ///< how long it has not
  bool cut = false;            ///< the supply is cut
};

/// `wanted` as far as the limit allows: the set point is clamped so that F_set + u <= `limit_dn`, and with
/// F_high over the limit for 3 ms the supply is cut and the chamber shut in, until F_high is under it again
/// for 20 ms. Letting air out is never in its way.
Valves guarded(const Config& config, std::int32_t limit_dn, const Sensors& sensors, std::uint32_t elapsed_ms,
               const Valves& wanted, ForceGuard& guard);

}  // namespace pinjaw::core

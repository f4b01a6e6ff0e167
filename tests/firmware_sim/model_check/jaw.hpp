#pragma once

#include <cstdint>

#include "firmware_sim/core/config.hpp"
#include "firmware_sim/core/io.hpp"

/// The plant as the search sees it: three levels of grip, and where the valves let them go.
namespace pinjaw::core::model {

/// How the jaws grip the part, or whether it lies on a passive station's seats (Full) or not (Open).
enum class Grip : std::uint8_t {
  Open,   ///< apart, as far as the layout wants
  Light,  ///< on the part, with less than F_req
  Full,   ///< F_low >= F_req
};

/// Where the valves of the last step let the jaws go. They may go there at any time, or never.
enum class Pull : std::uint8_t {
  Stay,
  Open,    ///< to Open, by way of Light
  Light,   ///< from Open to Light; what is shut in stays
  Full,    ///< to Full, by way of Light
  Ease,    ///< to Light from either side
  Either,  ///< a passive station that does not answer for the part: it comes and goes
};

/// What the sensors read; no local enable.
Sensors read(const Config& config, Grip grip);

/// Where `valves` let an active node's jaws go.
Pull pull_of(const Config& config, const Valves& valves);

/// Where a passive station's part may go: it stays as long as the station's record says that it has one.
/// Robots that take a part off a station which answers for it are no part of the protocol.
Pull passive_pull(Custody recorded);

/// The next level towards where `pull` leads; the same one where it leads nowhere.
Grip pulled(Grip grip, Pull pull);

}  // namespace pinjaw::core::model

#pragma once

#include <cstdint>

#include "firmware_sim/core/state.hpp"

/// The questions on which dangerous transitions hang, each a pure function of the state (docs/reliability.md,
/// section 2.6).
namespace pinjaw::core {

/// F_lim_eff = min(F_hw, F_layout, F_permit). While nothing is held F_permit is the light squeeze with its
/// uncertainty; once held it never falls by a timeout.
std::int32_t force_limit_dn(const State& state);

/// I3: the session is current, and the host that opened it is there and lets this node move.
bool motion_permitted(const State& state);

/// F_high over that limit; never for a passive station.
bool presses_too_hard(const State& state);

/// F_req of the committed layout; 0 for a passive station.
std::int32_t force_required_dn(const State& state);

/// F_low >= F_req; for a passive station every seat switch on.
bool holds_enough(const State& state);

/// |separation - contact| within the layout's tolerance.
bool separation_in_window(const State& state);

/// The jaws are closer than the committed layout's part lets them be.
bool closed_past_part(const State& state);

/// The jaws have moved by more than the slip tolerance since the part was gripped.
bool slipped(const State& state);

/// G_hold, without its time: holds_enough, F_high within the limit, separation in the window, no slip,
/// sensors good.
bool holds_well(const State& state);

/// G_hold for t_stable.
bool hold_is_stable(const State& state);

/// G_peer, without its time: the named receiver says TAKE of this token and pair, is TAKEN and stable with
/// its F_req, all of it fresh, and reports no fault for which it must hold.
bool peer_holds(const State& state);

/// The peer of the record says `fact` of the record's token and pair to this node. Facts do not age.
bool peer_says(const State& state, wire::Fact fact);

/// The peer of the record says, now or as an outcome of the past, how the record's handoff ended.
bool peer_concludes(const State& state, wire::Fact outcome);

/// The giver that this node accepted still offers that token; fresh.
bool giver_offers(const State& state);

/// That giver says that it has taken the token back; true for ever, so freshness does not matter.
bool giver_retains(const State& state);

/// Sensors prove that nothing is between the jaws: fully open, fully closed or closed past the part, nowhere
/// where a part may be, with no squeeze; for a passive station every seat switch off.
bool no_part_proven(const State& state);

/// The jaws are so far from the part that it is free.
bool clear_of_part(const State& state);

/// The jaws are where the layout wants them before a part comes.
bool fully_open(const State& state);

/// The fault that the sensors' trouble is.
wire::FaultCode sensor_fault(const Measurement& measurement);

/// Supply or sensors are such that the node must neither give nor take.
bool degraded(const State& state);

}  // namespace pinjaw::core

#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "firmware_sim/core/config.hpp"
#include "firmware_sim/core/io.hpp"
#include "protocol/wire/frame.hpp"
#include "protocol/wire/timing.hpp"

/// The second channel before the opening valve (docs/reliability.md 2.1). It shares nothing with the state
/// machine that decides but the record of who holds the part: it reads raw frames with a decoder of its own,
/// bit by bit, and permits an opening only where it saw itself that somebody else holds, or that an operator
/// releases by hand. Where it and the state machine differ, the jaws hold.
namespace pinjaw::core {

/// The handoff in which this node may let go, as the record tells it.
struct Release {
  std::uint8_t peer = 0;  ///< 15: the operator; 0: none is under way
  std::uint16_t token = 0;
  std::uint16_t pair = 0;
  std::uint16_t peer_required_dn = 0;  ///< F_req of the peer's layout
  bool decided = false;                ///< the record says that the decision is taken
  std::uint16_t challenge = 0;         ///< what the operator was told to answer with; 0: nothing
};

struct ReleaseGuard {
  /// One cyclic message of the peer: usable after three counters in order, fresh for 70 ms.
  struct Watched {
    std::uint8_t counter = 15;  ///< of the last; 15: none yet
    std::uint8_t in_a_row = 0;
    wire::Countdown fresh;
    bool good = false;  ///< the newest says what a release needs
  };
  Watched custody;
  Watched state;
  std::uint8_t peer = 0;    ///< whom the two are of
  std::uint16_t token = 0;  ///< the handoff that is watched
  wire::Countdown peer_faulty;
  std::uint16_t good_ms = 0;  ///< how long both have been good and fresh
  wire::Countdown asked;      ///< MANUAL_RELEASE 1 was heard with the local enable on
  bool peer_permits = false;  ///< for `token`
  bool hand_permits = false;
  bool decided_before = false;  ///< the record that power on found says that the decision is taken (R6)
};

/// What power on finds.
ReleaseGuard guard_after_reset(const NvmRecord& record);

/// Begins to listen anew. A decision that `before` did not permit does not count as one found at power on.
ReleaseGuard guard_after_bus_off(const ReleaseGuard& before, const Config& config, const NvmRecord& record);

/// Takes in one step's frames, in order of arrival, and lets time pass.
void watch(ReleaseGuard& guard, const Config& config, const Release& release,
           std::span<const wire::Frame> received, bool local_enable, std::uint16_t elapsed_ms);

/// Takes in a frame that comes alone, in a step whose time has passed.
void watch(ReleaseGuard& guard, const Config& config, const Release& release, const wire::Frame& frame,
           bool local_enable);

/// The giver's force may go down to that of RELAX: its peer says now that it holds.
bool sees_peer_hold(const ReleaseGuard& guard, const Config& config);

/// The handoff of `record` may be decided: its peer was seen to hold.
bool permits_release(const ReleaseGuard& guard, const Config& config, const NvmRecord& record);

/// A record that says 'decided' may be stored, and the jaws may open on it.
bool permits_decision(const ReleaseGuard& guard, const Config& config, const NvmRecord& record);

/// The jaws may open: nothing is recorded as held, or the decision is permitted and `stored`.
bool permits_opening(const ReleaseGuard& guard, const Config& config, const NvmRecord& record, bool stored);

}  // namespace pinjaw::core

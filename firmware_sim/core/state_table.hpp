#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/wire/codes.hpp"

/// The controller's state machine as data: every state by every event, nothing left to a default.
///
/// Source: docs/reliability.md, section 2.6. An event's name contains its guard: `PeerHolds` is raised
/// only while G_peer holds, so the table needs no conditions, and a rule such as 'opens only after a
/// decision' is a property of the table that the compiler checks.
namespace pinjaw::core {

using StateId = wire::State;
constexpr std::size_t kStates = wire::kStateCount;

enum class Event : std::uint8_t {
  // The host's and the operator's wishes, their guards checked.
  CmdHold,
  CmdWrite,
  CmdCommit,
  CmdArm,       ///< a new session only
  CmdArmReady,  ///< a new session, permit on and no fault
  CmdDisarm,
  CmdCloseLight,
  CmdAccept,
  CmdSqueeze,
  CmdOffer,
  CmdAbort,
  CmdOpenEmpty,
  CmdClearFault,
  CmdClearEmpty,     ///< CLEAR_FAULT with no part proven and no custody
  CmdManualAsk,      ///< MANUAL_RELEASE 1: asks for a challenge
  CmdManualRelease,  ///< MANUAL_RELEASE 2: answers it, local enable on
  // What the boot finds.
  BootBare,
  BootLoaded,
  BootHeld,
  BootBad,
  RecordOffered,
  RecordLatched,
  RecordDecided,
  RecordSole,
  RecordNone,
  // What sensors and timers say.
  Contact,
  NoPart,
  Misseated,
  HoldStableForPeer,
  HoldStableForOperator,
  OverForce,
  SqueezeTimeout,
  Slip,
  HoldLost,
  HoldRestored,
  Opened,
  OpenTimeout,
  SensorFault,
  StoreFault,
  // What the bus says, or has ceased to say.
  HostLost,
  PeerLost,
  PeerReleased,
  PeerRetained,
  PeerSilent,       ///< 2 s in TAKEN without an answer
  PeerHolds,        ///< G_peer for three cycles
  PeerWatched,      ///< G_peer through the whole of RELAX
  PeerDoubted,      ///< a term of G_peer false
  OfferUnanswered,  ///< host lost with no TAKE seen, or 30 s
};
constexpr std::size_t kEvents = 48;

enum class ReactionKind : std::uint8_t { Ignored, Refused, Stay, Go };

/// What a state does with an event. Ignored and Refused change nothing; Stay may act; Go changes the state.
struct Reaction {
  ReactionKind kind = ReactionKind::Ignored;
  StateId next = StateId::Boot;
  friend bool operator==(const Reaction&, const Reaction&) = default;
};

/// One place of the table. Re: refused, Ig: ignored, St: stays and may act; else the next state, in StateId's
/// order.
enum class Cell : std::uint8_t { Bt, Rc, Un, Ld, Rd, Sg, Sd, Sq, Tk, Hd, Of, Rx, Rs, Op, Fh, Fe, Re, Ig, St };

/// A row for each event, a column for each state.
using StateTable = std::array<std::array<Cell, kStates>, kEvents>;

/// The table that controllers work by; the compiler checks its safety rules.
extern const StateTable kStateTable;

/// Total: defined for every pair.
Reaction reaction(const StateTable& table, StateId state, Event event);

/// I2: a node in such a state answers for its part and never opens on its own.
constexpr bool holds(StateId state) {
  switch (state) {
    case StateId::Recover:
    case StateId::Taken:
    case StateId::Hold:
    case StateId::Offered:
    case StateId::FaultHold:
      return true;
    default:
      return false;
  }
}

/// States that may have a part of their own between the jaws: H, and those that grip without answering for
/// it.
constexpr bool grips(StateId state) {
  return holds(state) || state == StateId::Relax || state == StateId::Resqueeze;
}

constexpr bool is_command(Event event) {
  return event <= Event::CmdManualRelease;
}

}  // namespace pinjaw::core

#include "firmware_sim/core/state_table.hpp"

namespace pinjaw::core {
namespace {

// clang-format off
consteval StateTable rows() {
  using enum Cell;
  return {{
    //                           Bt  Rc  Un  Ld  Rd  Sg  Sd  Sq  Tk  Hd  Of  Rx  Rs  Op  Fh  Fe
    /* CmdHold               */ {St, St, St, St, St, St, St, Sd, St, St, Hd, Rs, St, St, St, St},
    /* CmdWrite              */ {Re, Re, St, St, Ld, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re},
    /* CmdCommit             */ {Re, Re, Ld, St, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re},
    /* CmdArm                */ {Re, St, Re, St, St, St, St, St, St, St, St, St, St, St, St, St},
    /* CmdArmReady           */ {Re, St, Re, Rd, St, St, St, St, St, St, St, St, St, St, St, St},
    /* CmdDisarm             */ {Re, Re, St, St, Ld, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re},
    /* CmdCloseLight         */ {Re, Re, Re, Re, Sg, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re},
    /* CmdAccept             */ {Re, Re, Re, Re, Sg, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re},
    /* CmdSqueeze            */ {Re, Re, Re, Re, Re, Re, Sq, Re, Re, Re, Re, Re, Re, Re, Re, Re},
    /* CmdOffer              */ {Re, Re, Re, Re, Re, Re, Re, Re, Re, Of, Re, Re, Re, Re, Re, Re},
    /* CmdAbort              */ {Re, Re, Re, Re, St, Rd, Rd, Re, Re, Re, Hd, Rs, Re, Re, Rd, Rd},
    /* CmdOpenEmpty          */ {Re, Re, Re, Re, St, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, St},
    /* CmdClearFault         */ {Re, St, St, St, St, St, St, St, St, St, St, St, St, St, Rc, Re},
    /* CmdClearEmpty         */ {Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Re, Ld, Ld},
    /* CmdManualAsk          */ {Re, Re, Re, Re, Re, Re, Re, Re, Re, St, Re, Re, Re, Re, Re, Re},
    /* CmdManualRelease      */ {Re, Re, Re, Re, Re, Re, Re, Re, Re, Op, Re, Re, Re, Re, Re, Re},
    /* BootBare              */ {Un, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* BootLoaded            */ {Ld, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* BootHeld              */ {Rc, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* BootBad               */ {Fh, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* RecordOffered         */ {Ig, Rs, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* RecordLatched         */ {Ig, Tk, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* RecordDecided         */ {Ig, Op, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* RecordSole            */ {Ig, Hd, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* RecordNone            */ {Ig, Fh, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* Contact               */ {Ig, Ig, Ig, Ig, Ig, Sd, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* NoPart                */ {Ig, Ig, Ig, Ig, Ig, Fe, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* Misseated             */ {Ig, Ig, Ig, Ig, Ig, Fe, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* HoldStableForPeer     */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Tk, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* HoldStableForOperator */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Hd, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* OverForce             */ {Ig, Ig, Ig, Ig, Ig, St, St, Sd, St, St, Hd, St, St, Ig, Ig, Ig},
    /* SqueezeTimeout        */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Sd, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* Slip                  */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Sd, St, St, Hd, Rs, Ig, Ig, Ig, Ig},
    /* HoldLost              */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, St, St, Hd, Ig, Ig, Ig, Ig, Ig},
    /* HoldRestored          */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Hd, Ig, Ig, Ig},
    /* Opened                */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Rd, Ig, St},
    /* OpenTimeout           */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Fe, Ig, Ig},
    /* SensorFault           */ {Ig, St, St, St, Fe, Fe, Fe, Fe, St, Fh, Hd, Rs, St, St, St, St},
    /* StoreFault            */ {Fh, St, St, St, Fe, Fe, Fe, Fe, St, Fh, Hd, Rs, St, Fh, St, St},
    /* HostLost              */ {Ig, St, St, St, Ld, St, St, Sd, St, St, St, St, St, St, St, St},
    /* PeerLost              */ {Ig, Ig, Ig, Ig, Ig, St, St, St, St, Ig, St, Ig, Ig, Ig, Ig, Ig},
    /* PeerReleased          */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Hd, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* PeerRetained          */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Sd, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* PeerSilent            */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, St, Ig, Ig, Ig, Ig, Ig, Ig, Ig},
    /* PeerHolds             */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Rx, Ig, Ig, Ig, Ig, Ig},
    /* PeerWatched           */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Op, Ig, Ig, Ig, Ig},
    /* PeerDoubted           */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Rs, Ig, Ig, Ig, Ig},
    /* OfferUnanswered       */ {Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Ig, Hd, Ig, Ig, Ig, Ig, Ig},
  }};
}
// clang-format on

}  // namespace

constexpr StateTable kStateTable = rows();

namespace {

constexpr Reaction reaction_of(Cell cell, StateId state) {
  using enum Cell;
  switch (cell) {
    case Re:
      return {ReactionKind::Refused, state};
    case Ig:
      return {ReactionKind::Ignored, state};
    case St:
      return {ReactionKind::Stay, state};
    default:
      return {ReactionKind::Go, static_cast<StateId>(cell)};
  }
}

constexpr Reaction look_up(const StateTable& table, StateId state, Event event) {
  return reaction_of(table[static_cast<std::size_t>(event)][static_cast<std::size_t>(state)], state);
}

/// Whether `rule(state, event, reaction)` is true of the whole table.
template <class Rule>
consteval bool everywhere(Rule rule) {
  for (std::size_t s = 0; s < kStates; ++s) {
    for (std::size_t e = 0; e < kEvents; ++e) {
      const auto state = static_cast<StateId>(s);
      const auto event = static_cast<Event>(e);
      if (!rule(state, event, look_up(kStateTable, state, event))) return false;
    }
  }
  return true;
}

static_assert(everywhere([](StateId state, Event event, Reaction r) {
                if (r.kind != ReactionKind::Go || r.next != StateId::Opening) return true;
                return (state == StateId::Relax && event == Event::PeerWatched) ||
                       (state == StateId::Hold && event == Event::CmdManualRelease) ||
                       (state == StateId::Recover && event == Event::RecordDecided);
              }),
              "jaws open only after a decision, stored before or taken now, or by the operator's hand");

static_assert(everywhere([](StateId state, Event event, Reaction r) {
                if (r.kind != ReactionKind::Go || !holds(state) || grips(r.next)) return true;
                return (r.next == StateId::Opening) ||
                       (state == StateId::Taken && event == Event::PeerRetained) ||
                       (state == StateId::FaultHold &&
                        (event == Event::CmdClearEmpty || event == Event::CmdAbort));
              }),
              "who answers for a part lets go only by decision, by its giver's RETAIN, with no part there, "
              "or with a part that "
              "by the record another answers for");

static_assert(everywhere([](StateId, Event event, Reaction r) {
                const bool silence = event == Event::HostLost || event == Event::PeerLost ||
                                     event == Event::PeerSilent || event == Event::OfferUnanswered;
                return !silence || r.kind != ReactionKind::Go ||
                       (r.next != StateId::Opening && r.next != StateId::Ready);
              }),
              "I6: silence opens nothing");

static_assert(everywhere([](StateId state, Event event, Reaction r) {
                if (state != StateId::Taken || r.kind != ReactionKind::Go) return true;
                return event == Event::PeerReleased || event == Event::PeerRetained;
              }),
              "R3: a latched receiver moves only on its giver's word");

static_assert(everywhere([](StateId state, Event event, Reaction r) {
                if (state != StateId::Taken || !is_command(event)) return true;
                const bool harmless = event == Event::CmdHold || event == Event::CmdClearFault ||
                                      event == Event::CmdArm || event == Event::CmdArmReady;
                return harmless == (r.kind == ReactionKind::Stay);
              }),
              "no command but HOLD, CLEAR_FAULT and ARM means anything to a latched receiver");

static_assert(everywhere([](StateId, Event event, Reaction r) {
                return event != Event::CmdHold || r.kind == ReactionKind::Stay || r.kind == ReactionKind::Go;
              }),
              "HOLD is never refused");

static_assert(everywhere([](StateId, Event event, Reaction r) {
                return is_command(event) ? r.kind != ReactionKind::Ignored : r.kind != ReactionKind::Refused;
              }),
              "a command is never dropped without an answer; an observation has no one to refuse");

static_assert(everywhere([](StateId state, Event, Reaction r) {
                return state != StateId::Opening || r.kind != ReactionKind::Go || r.next == StateId::Ready ||
                       r.next == StateId::FaultEmpty || r.next == StateId::FaultHold;
              }),
              "R6: after the decision nothing leads back to offering or retaining");

}  // namespace

Reaction reaction(const StateTable& table, StateId state, Event event) {
  return look_up(table, state, event);
}

}  // namespace pinjaw::core

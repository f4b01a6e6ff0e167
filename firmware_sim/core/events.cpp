#include "firmware_sim/core/events.hpp"

#include <algorithm>

#include "firmware_sim/core/custody.hpp"
#include "firmware_sim/core/guards.hpp"
#include "firmware_sim/core/rules.hpp"
#include "firmware_sim/core/transitions.hpp"

namespace pinjaw::core {
namespace {

using Occurrence = std::optional<Event>;

constexpr std::uint16_t kContact_ms = 80;     // section 3: seat dwell
constexpr std::uint16_t kBlocked_ms = 500;    // chosen: time for the push that breaks loose a jaw that sticks
constexpr std::uint8_t kBadHold_ms = 3;       // I5
constexpr std::uint16_t kStarved_ms = 500;    // chosen: six times the regulator's lag
constexpr std::uint16_t kRefill_ms = 10'000;  // chosen: what one refill counts; a sound chamber cools once
constexpr std::uint16_t kLeaks_ms =
    40'000;  // chosen: five refills in ten seconds, or air wanted all the time

/// Three quarters of F_light press: what stands still now is stopped by something.
bool presses(const State& state) {
  return 4 * state.measurement.squeeze.measured_dn >= 3 * state.layouts.layout.f_light_dn;
}

/// A fault that is a condition: set and cleared as it comes and goes.
void follow(State& state, wire::FaultCode code, bool there) {
  if (there) return raise(state, code);
  state.faults.clear(code);
}

/// An event that only sets a fault is raised once.
bool is_news(const State& state, wire::FaultCode code) {
  return !state.faults.active(code);
}

Occurrence in_boot(const State& state) {
  const Custody custody = state.store.record.custody;
  if (state.store.failed || !state.store.readable) return Event::BootBad;
  if (has_custody(custody) || !no_part_proven(state)) return Event::BootHeld;
  return state.layouts.committed ? Event::BootLoaded : Event::BootBare;
}

Occurrence in_recover(const State& state) {
  if (!state.layouts.committed) return Event::RecordNone;
  switch (state.store.record.custody) {
    case Custody::Offered:
      return Event::RecordOffered;
    case Custody::Latched:
      return Event::RecordLatched;
    case Custody::Decided:
      return Event::RecordDecided;
    case Custody::Sole:
    case Custody::Retained:
      return Event::RecordSole;
    default:
      return Event::RecordNone;
  }
}

Occurrence in_seating(const State& state) {
  if (state.frozen) return std::nullopt;
  const Measurement& m = state.measurement;
  if (state.config.passive) return m.seated ? Occurrence(Event::Contact) : std::nullopt;
  if (closed_past_part(state)) return Event::NoPart;
  if (separation_in_window(state)) {
    if (m.still_ms >= kContact_ms && presses(state)) return Event::Contact;
  } else if (state.control.blocked_ms >= kBlocked_ms && presses(state)) {
    return Event::Misseated;
  }
  return state.timers.state.running() ? std::nullopt : Occurrence(Event::Misseated);
}

Occurrence in_squeezing(const State& state) {
  if (presses_too_hard(state)) return Event::OverForce;
  if (slipped(state)) return Event::Slip;
  if (hold_is_stable(state) || !keeps(Rule::TakeOnStableHold)) {
    return state.receiving.giver == wire::kOperatorPeer ? Event::HoldStableForOperator
                                                        : Event::HoldStableForPeer;
  }
  return state.timers.state.running() ? std::nullopt : Occurrence(Event::SqueezeTimeout);
}

/// Events of a held part that only set a fault.
Occurrence while_held(const State& state) {
  if (state.bad_hold_ms >= kBadHold_ms && is_news(state, wire::FaultCode::HoldLost)) return Event::HoldLost;
  if (slipped(state) && is_news(state, wire::FaultCode::Slip)) return Event::Slip;
  if (presses_too_hard(state) && is_news(state, wire::FaultCode::OverForce)) return Event::OverForce;
  return std::nullopt;
}

Occurrence in_taken(const State& state) {
  if (peer_concludes(state, wire::Fact::Released)) return Event::PeerReleased;
  if (peer_concludes(state, wire::Fact::Retain)) return Event::PeerRetained;
  if (!state.timers.state.running() && is_news(state, wire::FaultCode::InDoubt)) return Event::PeerSilent;
  return while_held(state);
}

Occurrence in_offered(const State& state) {
  const bool host_there = state.host.alive() && state.host.epoch() == state.session_epoch;
  const bool unanswered = !host_there && !state.answer_seen;
  if (!state.timers.state.running() || unanswered || state.faults.must_hold()) return Event::OfferUnanswered;
  if (const Occurrence fault = while_held(state)) return fault;
  const bool good = !state.timers.peer_good.running() && sees_peer_hold(state.release_guard, state.config);
  return state.announced.fact == wire::Fact::Offer && good ? Occurrence(Event::PeerHolds) : std::nullopt;
}

Occurrence in_relax(const State& state) {
  if (!peer_holds(state) || state.faults.must_hold()) return Event::PeerDoubted;
  if (slipped(state)) return Event::Slip;
  // The other channel counts frames in its own way and may want a few more.
  const bool both = permits_release(state.release_guard, state.config, state.store.record);
  return state.timers.state.running() || !both ? std::nullopt : Occurrence(Event::PeerWatched);
}

/// R6: the jaws are away from the part, and the decision that let them is stored.
bool has_opened(const State& state) {
  const bool decided = (state.store.durable() || !keeps(Rule::DecisionBeforeOpen)) &&
                       state.store.record.custody == Custody::Decided;
  return decided && clear_of_part(state);
}

Occurrence in_opening(const State& state) {
  if (has_opened(state)) return Event::Opened;
  return state.timers.state.running() ? std::nullopt : Occurrence(Event::OpenTimeout);
}

Occurrence in_fault_empty(const State& state) {
  return has_opened(state) ? Occurrence(Event::Opened) : std::nullopt;
}

Occurrence by_state(const State& state) {
  switch (state.id) {
    case StateId::Recover:
      return in_recover(state);
    case StateId::Seating:
      return in_seating(state);
    case StateId::Squeezing:
      return in_squeezing(state);
    case StateId::Taken:
      return in_taken(state);
    case StateId::Hold:
      return while_held(state);
    case StateId::Offered:
      return in_offered(state);
    case StateId::Relax:
      return in_relax(state);
    case StateId::Resqueeze:
      return hold_is_stable(state) || !keeps(Rule::RetainOnGoodHold) ? Occurrence(Event::HoldRestored)
                                                                     : std::nullopt;
    case StateId::Opening:
      return in_opening(state);
    case StateId::FaultEmpty:
      return in_fault_empty(state);
    default:
      return std::nullopt;
  }
}

bool moves(const State& state, Event event) {
  return reaction(*state.config.table, state.id, event).kind == ReactionKind::Go;
}

/// The force of a squeeze is permitted by a session and its host, and ends with either (2.4).
bool host_is_lost(const State& state) {
  return !state.host.alive() || (state.id == StateId::Squeezing && !motion_permitted(state));
}

bool giver_stale(const State& state) {
  switch (state.id) {
    case StateId::Seating:
    case StateId::Seated:
    case StateId::Squeezing:
    case StateId::Taken: {
      const Peer* giver = state.peers.find(state.receiving.giver);
      return giver != nullptr && !giver->custody_fresh.running();
    }
    default:
      return false;
  }
}

/// A node that answers for how well it holds: not one that only now finds out, or waits with a fault.
bool answers_for_hold(StateId id) {
  return holds(id) && id != StateId::FaultHold && id != StateId::Recover;
}

void track_hold(State& state, std::uint16_t elapsed_ms) {
  const bool gripping = holds(state.id) || state.id == StateId::Squeezing || state.id == StateId::Resqueeze;
  if (gripping && holds_well(state)) {
    state.timers.stable.advance(elapsed_ms);
  } else {
    state.timers.stable.start(state.layouts.layout.stable_ms);
  }
  const bool answers = answers_for_hold(state.id);
  const bool bad = answers && !holds_enough(state);
  state.bad_hold_ms =
      bad ? static_cast<std::uint8_t>(std::min<std::int32_t>(state.bad_hold_ms + elapsed_ms, 100))
          : std::uint8_t{0};
  if (answers && hold_is_stable(state)) {
    state.hold_proven = true;
    state.faults.clear(wire::FaultCode::HoldLost);
  }
}

/// The part that another answers for is this node's concern until the jaws are open: stopped on their way,
/// air that is shut in closes them again.
void track_giver(State& state) {
  if (giver_retains(state)) state.receiving.retained = true;
  const bool open = state.id == StateId::Loaded || state.id == StateId::Ready;
  if (open && state.layouts.committed && fully_open(state)) state.receiving = {};
}

/// The model of a hold is a shut chamber: it neither asks for air again and again nor waits for it in vain.
void track_air(State& state, std::uint16_t elapsed_ms) {
  ForceControl& control = state.control;
  const bool answers = answers_for_hold(state.id);
  const bool asks = answers && hold_is_stable(state) && control.flow == Flow::Filling;
  std::int32_t asked_ms = control.asked_ms + (asks ? 1 : -1) * static_cast<std::int32_t>(elapsed_ms);
  if (asks && control.refilling) asked_ms += kRefill_ms;
  control.asked_ms =
      static_cast<std::uint16_t>(std::clamp<std::int32_t>(asked_ms, 0, kLeaks_ms + kRefill_ms));
  const bool starves =
      state.bad_hold_ms >= kBadHold_ms && control.flow == Flow::Filling && !state.measurement.supply_low;
  control.starved_ms = counted(control.starved_ms, starves, elapsed_ms);
  if (control.asked_ms >= kLeaks_ms) raise(state, wire::FaultCode::Leak);
  if (control.asked_ms == 0) state.faults.clear(wire::FaultCode::Leak);
  if (control.starved_ms >= kStarved_ms && is_news(state, wire::FaultCode::ValveStuck)) {
    raise(state, wire::FaultCode::ValveStuck);
  }
}

/// The jaws' rest before they were told to close says nothing of what blocks them. A jaw that sticks and
/// slips by turns keeps most of its push.
void track_block(State& state, std::uint16_t elapsed_ms) {
  std::uint16_t& blocked_ms = state.control.blocked_ms;
  const bool told = state.id == StateId::Seating && !state.frozen && motion_permitted(state) &&
                    state.control.flow == Flow::Filling;
  if (told && state.measurement.still_ms > 0) {
    blocked_ms = counted(blocked_ms, true, elapsed_ms);
  } else {
    blocked_ms = static_cast<std::uint16_t>(blocked_ms - std::min(blocked_ms, elapsed_ms));
  }
}

void track_peer(State& state, std::uint16_t elapsed_ms) {
  if (state.id != StateId::Offered) return;
  if (peer_says(state, wire::Fact::Take)) state.answer_seen = true;
  if (peer_holds(state)) {
    state.timers.peer_good.advance(elapsed_ms);
  } else {
    state.timers.peer_good.start(kPeerGood_ms);
  }
}

}  // namespace

void track(State& state, std::uint16_t elapsed_ms) {
  track_hold(state, elapsed_ms);
  track_giver(state);
  track_air(state, elapsed_ms);
  track_block(state, elapsed_ms);
  track_peer(state, elapsed_ms);
  follow(state, wire::FaultCode::HostLost, !state.host.alive());
  follow(state, wire::FaultCode::SupplyAirLow, state.measurement.supply_low);
  follow(state, wire::FaultCode::BusOff, state.bus.off());
  follow(state, wire::FaultCode::BusPassive, state.bus.passive());
  if (state.bus.recovered()) state.faults.note(wire::FaultCode::BusOffRecovered);
  if (state.bus.overran()) state.faults.note(wire::FaultCode::ReceiveOverrun);
  if (!giver_stale(state)) state.faults.clear(wire::FaultCode::PeerLost);
  if (!state.host.alive() || state.host.epoch() != state.session_epoch) end_session(state);
}

std::optional<Event> next_event(const State& state) {
  if (state.id == StateId::Boot) return in_boot(state);
  const bool trouble = state.measurement.trouble != SensorTrouble::None;
  if (trouble && (moves(state, Event::SensorFault) || is_news(state, sensor_fault(state.measurement)))) {
    return Event::SensorFault;
  }
  if (state.store.failed &&
      (moves(state, Event::StoreFault) || is_news(state, wire::FaultCode::CustodyMemory))) {
    return Event::StoreFault;
  }
  if (host_is_lost(state) && moves(state, Event::HostLost)) return Event::HostLost;
  if (giver_stale(state) && is_news(state, wire::FaultCode::PeerLost)) return Event::PeerLost;
  return by_state(state);
}

}  // namespace pinjaw::core

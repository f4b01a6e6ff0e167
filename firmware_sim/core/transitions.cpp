#include "firmware_sim/core/transitions.hpp"

#include <algorithm>

#include "firmware_sim/core/custody.hpp"
#include "firmware_sim/core/guards.hpp"
#include "firmware_sim/core/rules.hpp"

namespace pinjaw::core {
namespace {

// Section 2.6, each a time limit of a state.
constexpr std::uint16_t kSqueeze_ms = 2000;
constexpr std::uint16_t kInDoubt_ms = 2000;
constexpr std::uint16_t kOffer_ms = 30000;
constexpr std::uint16_t kWatch_ms = 200;
constexpr std::int32_t kMoveBase_ms = 500;
constexpr std::int32_t kSlowest_10um_per_ms = 3;  // 30 mm/s

wire::FaultCode fault_of(const State& state, Event event) {
  switch (event) {
    case Event::BootBad:
    case Event::RecordNone:
    case Event::StoreFault:
      return wire::FaultCode::CustodyMemory;
    case Event::NoPart:
      return wire::FaultCode::NoPart;
    case Event::Misseated:
      return wire::FaultCode::MisSeated;
    case Event::OverForce:
      return wire::FaultCode::OverForce;
    case Event::SqueezeTimeout:
    case Event::HoldLost:
      return wire::FaultCode::HoldLost;
    case Event::Slip:
      return wire::FaultCode::Slip;
    case Event::OpenTimeout:
      return wire::FaultCode::ValveStuck;
    case Event::SensorFault:
      return sensor_fault(state.measurement);
    case Event::PeerLost:
      return wire::FaultCode::PeerLost;
    case Event::PeerSilent:
      return wire::FaultCode::InDoubt;
    case Event::CmdManualRelease:
      return wire::FaultCode::ManualRelease;
    default:
      return wire::FaultCode::None;
  }
}

/// Section 2.6: 0.5 s + travel at 30 mm/s.
std::uint16_t move_time_ms(const State& state, std::int32_t to_10um) {
  const std::int32_t travel_10um =
      std::max(state.measurement.separation_10um - to_10um, to_10um - state.measurement.separation_10um);
  return static_cast<std::uint16_t>(
      std::min<std::int32_t>(kMoveBase_ms + travel_10um / kSlowest_10um_per_ms, 60000));
}

/// Remembers how the handoff of the record ended that this node gave in (R10).
void remember_outcome(NvmRecord& record, bool retained) {
  if (record.peer == wire::kOperatorPeer) return;
  std::copy_backward(record.outcomes.begin(), record.outcomes.end() - 1, record.outcomes.end());
  record.outcomes[0] = {
      .retained = retained, .peer = record.peer, .token = record.token, .pair = record.pair};
}

void record_custody(State& state, Custody custody) {
  NvmRecord& record = to_store(state.store);
  record.custody = custody;
  if (custody == Custody::Released || custody == Custody::Retained)
    remember_outcome(record, custody == Custody::Retained);
  record.force_set_dn = state.force_set_dn;
  record.permit_dn = state.permit_dn;
}

/// Where slip counts from: the grip as it is now.
void grip_here(State& state) {
  state.reference_10um = state.measurement.separation_10um;
  state.timers.stable.start(state.layouts.layout.stable_ms);
}

/// F_set and F_permit of a grip that was there before this session.
void take_up_recorded_force(State& state) {
  const NvmRecord& record = state.store.record;
  const std::int32_t least_dn = force_required_dn(state) + state.config.uncertainty_dn;
  state.permit_dn = record.permit_dn;
  state.force_set_dn = state.config.passive
                           ? std::uint16_t{0}
                           : std::max(record.force_set_dn, static_cast<std::uint16_t>(least_dn));
  state.control = {};
}

void name_handoff(NvmRecord& record, const Receiving& handoff) {
  record.peer = handoff.giver;
  record.token = handoff.token;
  record.pair = handoff.pair;
}

void enter_loaded(State& state, Event event) {
  end_session(state);
  state.opening_wanted = false;
  state.permit_dn = 0;
  state.force_set_dn = 0;
  if (event == Event::CmdClearEmpty) {
    state.faults.clear_all();
    state.store.readable = true;  // what it said is settled by there being no part
    state.receiving = {};
    name_handoff(state.store.record, state.receiving);
    record_custody(state, Custody::Empty);
  }
}

void enter_ready(State& state, Event event) {
  state.permit_dn = 0;
  state.force_set_dn = 0;
  state.opening_wanted = !state.config.passive && event != Event::CmdArmReady;
  if (event == Event::Opened) record_custody(state, Custody::Released);
  if (event == Event::CmdAbort) state.faults.clear_all();
}

void enter_seating(State& state) {
  state.opening_wanted = false;
  state.control = {};
  state.timers.state.start(move_time_ms(state, state.layouts.layout.separation_contact_10um));
  NvmRecord& record = to_store(state.store);
  record.custody = Custody::Empty;
  name_handoff(record, state.receiving);  // who answers for the part that the jaws now close on
  if (state.receiving.giver != wire::kOperatorPeer) {
    remember_token(record, state.receiving.giver, state.receiving.token);
  }
}

void enter_seated(State& state, StateId from, Event event) {
  state.permit_dn = 0;
  state.force_set_dn = 0;
  if (event == Event::CmdHold) {
    state.frozen = true;
    end_session(state);
  }
  if (from == StateId::Taken) {
    state.faults.clear(wire::FaultCode::InDoubt);
    state.receiving.retained = true;
    record_custody(state, Custody::Empty);
  }
}

void enter_squeezing(State& state) {
  state.timers.state.start(kSqueeze_ms);
  state.control = {};
  state.control.reference_dn =
      std::clamp<std::int32_t>(state.measurement.squeeze.measured_dn, 0, state.force_set_dn);
  grip_here(state);
}

void enter_taken(State& state, StateId from) {
  state.timers.state.start(kInDoubt_ms);
  state.hold_proven = from == StateId::Squeezing;
  if (from != StateId::Squeezing) {
    const NvmRecord& record = state.store.record;
    state.receiving = {.giver = record.peer, .token = record.token, .pair = record.pair};
    take_up_recorded_force(state);
    return grip_here(state);
  }
  name_handoff(state.store.record, state.receiving);
  record_custody(state, Custody::Latched);
}

void enter_hold(State& state, StateId from) {
  switch (from) {
    case StateId::Squeezing:
      state.receiving = {};
      name_handoff(state.store.record, {.giver = wire::kOperatorPeer});
      state.hold_proven = true;
      record_custody(state, Custody::Sole);
      break;
    case StateId::Taken:
      state.receiving = {};
      state.hold_proven = true;
      state.faults.clear(wire::FaultCode::InDoubt);
      record_custody(state, Custody::Sole);
      break;
    case StateId::Offered:
    case StateId::Resqueeze:
      state.faults.note(wire::FaultCode::HandoffAborted);
      record_custody(state, Custody::Retained);
      break;
    default:
      take_up_recorded_force(state);
      return grip_here(state);
  }
  state.reference_10um = state.measurement.separation_10um;
}

void enter_offered(State& state) {
  NvmRecord& record = state.store.record;
  if (keeps(Rule::NewTokenEachOffer)) ++record.handoff_number;
  record.token = record.handoff_number;
  record.pair = state.layouts.layout.peer(record.peer)->pair_crc;
  record_custody(state, Custody::Offered);
  state.answer_seen = false;
  state.timers.state.start(kOffer_ms);
  state.timers.peer_good.start(kPeerGood_ms);
}

void enter_opening(State& state, Event event) {
  state.timers.state.start(move_time_ms(state, state.layouts.layout.separation_open_10um));
  if (event == Event::RecordDecided) return;
  if (event == Event::CmdManualRelease) state.store.record.peer = wire::kOperatorPeer;
  record_custody(state, Custody::Decided);
}

void enter(State& state, StateId from, Event event) {
  switch (state.id) {
    case StateId::Loaded:
      return enter_loaded(state, event);
    case StateId::Ready:
      return enter_ready(state, event);
    case StateId::Seating:
      return enter_seating(state);
    case StateId::Seated:
      return enter_seated(state, from, event);
    case StateId::Squeezing:
      return enter_squeezing(state);
    case StateId::Taken:
      return enter_taken(state, from);
    case StateId::Hold:
      return enter_hold(state, from);
    case StateId::Offered:
      return enter_offered(state);
    case StateId::Relax:
      return state.timers.state.start(kWatch_ms);
    case StateId::Resqueeze:
      if (from == StateId::Recover) take_up_recorded_force(state);
      return grip_here(state);
    case StateId::Opening:
      return enter_opening(state, event);
    case StateId::FaultEmpty:
      state.opening_wanted = false;
      return;
    default:
      return;
  }
}

/// F_set as high as F_lim_eff lets it be: a receiver that is latched may not let go.
void press_as_permitted(State& state) {
  if (state.config.passive) return;
  const std::int32_t most_dn = force_limit_dn(state) - state.config.uncertainty_dn;
  state.force_set_dn = static_cast<std::uint16_t>(std::max<std::int32_t>(state.force_set_dn, most_dn));
}

/// Actions of events that change no state.
void stay(State& state, Event event) {
  switch (event) {
    case Event::CmdHold:
      if (grips(state.id) || state.id == StateId::Opening) return;
      state.opening_wanted = false;
      state.frozen = true;
      [[fallthrough]];
    case Event::CmdWrite:
    case Event::CmdDisarm:
      return end_session(state);
    case Event::CmdCommit:
      return enter_loaded(state, event);
    case Event::CmdOpenEmpty:
    case Event::CmdAbort:
      state.opening_wanted = !state.config.passive;
      return;
    case Event::Opened:
      return record_custody(state, Custody::Released);
    case Event::HoldLost:
      if (state.id == StateId::Taken) press_as_permitted(state);
      return;
    default:
      return;
  }
}

}  // namespace

bool apply(State& state, Event event) {
  const StateId from = state.id;
  const Reaction what = reaction(*state.config.table, from, event);
  if (what.kind == ReactionKind::Ignored) ++state.counters.events_ignored;
  if (what.kind == ReactionKind::Refused) ++state.counters.events_refused;
  if (what.kind == ReactionKind::Ignored || what.kind == ReactionKind::Refused) return false;
  if (event == Event::CmdClearFault) state.faults.clear_all();
  raise(state, fault_of(state, event));
  if (what.kind == ReactionKind::Stay) {
    stay(state, event);
  } else {
    state.id = what.next;
    enter(state, from, event);
  }
  return true;
}

void raise(State& state, wire::FaultCode code) {
  state.faults.raise(code);
  if (severity_of(code) >= wire::Severity::Hold) end_session(state);
}

void end_session(State& state) {
  state.gate.close();
}

}  // namespace pinjaw::core

#include <algorithm>

#include "firmware_sim/core/commands.hpp"
#include "firmware_sim/core/custody.hpp"
#include "firmware_sim/core/guards.hpp"
#include "firmware_sim/core/rules.hpp"
#include "protocol/wire/commands.hpp"

namespace pinjaw::core {
namespace {

using wire::CommandResult;
using wire::Reason;

constexpr Answer kOk{};

constexpr Answer refused(Reason reason) {
  return {CommandResult::Refused, reason};
}

bool is_ok(const Answer& answer) {
  return answer.result == CommandResult::Ok;
}

/// What every motion needs (I3).
Answer motion_allowed(const State& state) {
  if (!state.host.alive()) return {CommandResult::NoPermit, Reason::HostSilent};
  if (!state.host.permits()) return {CommandResult::NoPermit, Reason::NotPermitted};
  if (!state.store.durable()) return {CommandResult::Busy, Reason::None};
  return kOk;
}

/// What giving and taking need besides.
Answer handoff_allowed(const State& state) {
  if (state.faults.must_hold()) return refused(Reason::FaultActive);
  if (degraded(state)) return refused(Reason::Degraded);
  return motion_allowed(state);
}

Decision decide_arm(const State& state, const wire::Command& command) {
  if (!state.layouts.committed) return {refused(Reason::NoLayout)};
  if (wire::armed_crc24(command) != wire::crc24(state.layouts.crc)) return {refused(Reason::LayoutDiffers)};
  if (state.host.two_hosts()) return {refused(Reason::TwoHosts)};
  if (!state.host.alive()) return {refused(Reason::HostSilent)};
  if (command.session != state.host.epoch()) return {{CommandResult::BadSession, Reason::WrongSession}};
  if (!state.store.durable()) return {{CommandResult::Busy, Reason::None}};
  const bool ready = state.host.permits() && !state.faults.must_hold();
  return {kOk, ready ? Event::CmdArmReady : Event::CmdArm};
}

Answer check_ready_to_close(const State& state) {
  if (const Answer answer = handoff_allowed(state); !is_ok(answer)) return answer;
  if (state.opening_wanted) return {CommandResult::Busy, Reason::None};
  return clear_of_part(state) ? kOk : refused(Reason::PartSuspected);
}

Answer check_close_light(const State& state) {
  if (!state.measurement.local_enable) return refused(Reason::NoLocalEnable);
  return check_ready_to_close(state);
}

Answer check_accept(const State& state, const wire::Command& command) {
  if (const Answer answer = check_ready_to_close(state); !is_ok(answer)) return answer;
  const std::uint8_t giver = command.argument;
  const wire::LayoutPeer* named = state.layouts.layout.peer(giver);
  const Peer* peer = state.peers.find(giver);
  if (named == nullptr || peer == nullptr) return refused(Reason::PeerNotInLayout);
  if (!peer->custody_fresh.running()) return refused(Reason::PeerStale);
  const wire::Custody& offer = peer->custody;
  if (offer.fact != wire::Fact::Offer || offer.peer != state.config.node)
    return refused(Reason::PeerNotOffering);
  if (offer.pair != named->pair_crc && keeps(Rule::ComparePair)) return refused(Reason::PairDiffers);
  return token_is_new(state.store.record, giver, offer.token) ? kOk : refused(Reason::TokenOld);
}

Answer check_squeeze(const State& state, const wire::Command& command) {
  const wire::SqueezeForces forces = wire::squeeze_forces(command);
  if (state.config.passive) {
    if (forces.set_dn != 0) return refused(Reason::Passive);
  } else {
    const wire::Layout& layout = state.layouts.layout;
    const std::int32_t u_dn = state.config.uncertainty_dn;
    const std::int32_t limit_dn = std::min<std::int32_t>(layout.f_limit_dn, state.config.hardware_limit_dn);
    if (forces.set_dn + u_dn > forces.permit_dn) return {CommandResult::Limit, Reason::ForceOverPermit};
    if (forces.permit_dn > limit_dn) return {CommandResult::Limit, Reason::ForceOverLimit};
    if (forces.set_dn < layout.f_required_dn + u_dn) return refused(Reason::ForceUnderRequired);
  }
  if (state.receiving.giver != wire::kOperatorPeer && !giver_offers(state)) {
    return refused(Reason::PeerStale);
  }
  return handoff_allowed(state);
}

/// The last handoff's RETAIN must be said before the part is given to anybody else: from then on it is said
/// as an outcome of the past, and an outcome must have been true once (R5).
bool owes_retain(const State& state) {
  return state.store.record.custody == Custody::Retained && state.announced.fact != wire::Fact::Retain;
}

Answer check_offer(const State& state, const wire::Command& command) {
  if (state.layouts.layout.peer(command.argument) == nullptr) return refused(Reason::PeerNotInLayout);
  if (owes_retain(state)) return {CommandResult::Busy, Reason::HandoffRunning};
  return handoff_allowed(state);
}

/// The jaws may open again only while somebody else answers for the part, or nothing is there.
Answer check_abort(const State& state) {
  if (state.id == StateId::Offered || state.id == StateId::Relax) return kOk;
  if (state.id == StateId::FaultEmpty || state.id == StateId::FaultHold) {
    if (has_custody(state.store.record.custody)) return refused(Reason::PartHeld);
    if (degraded(state) || state.store.failed) return refused(Reason::CauseRemains);
  }
  if (state.receiving.giver == 0) {
    if (!no_part_proven(state)) return refused(Reason::PartSuspected);
  } else if (state.receiving.giver == wire::kOperatorPeer) {
    if (!state.measurement.local_enable) return refused(Reason::NoLocalEnable);
  } else if (!state.receiving.retained && !giver_offers(state)) {
    return refused(Reason::PeerStale);
  }
  return motion_allowed(state);
}

Answer check_open_empty(const State& state) {
  if (has_custody(state.store.record.custody) && keeps(Rule::SoleRefusesOpen))
    return refused(Reason::PartHeld);
  if (!no_part_proven(state)) return refused(Reason::PartSuspected);
  return motion_allowed(state);
}

Decision decide_clear_fault(const State& state) {
  const bool cause_remains = state.measurement.trouble != SensorTrouble::None ||
                             (state.store.failed && state.id != StateId::FaultHold);
  if (state.id != StateId::FaultHold && state.id != StateId::FaultEmpty) return {kOk, Event::CmdClearFault};
  if (cause_remains) return {refused(Reason::CauseRemains)};
  const bool custody = has_custody(state.store.record.custody);
  if (!custody && no_part_proven(state)) return {kOk, Event::CmdClearEmpty};
  if (state.id == StateId::FaultEmpty) return {refused(custody ? Reason::PartHeld : Reason::PartSuspected)};
  if (!state.layouts.committed) return {refused(Reason::NoLayout)};
  // Whose the part is, no record says: another node may answer for it. Only a hand at the station can tell.
  if (!custody && !state.measurement.local_enable) return {refused(Reason::NoLocalEnable)};
  return {kOk, Event::CmdClearFault};
}

Answer check_manual(const State& state, const wire::Command& command) {
  if (command.argument != 1 && command.argument != 2) return refused(Reason::BadArgument);
  if (!state.measurement.local_enable) return refused(Reason::NoLocalEnable);
  if (owes_retain(state)) return {CommandResult::Busy, Reason::HandoffRunning};
  if (command.argument == 1) return kOk;
  if (!state.timers.challenge.running() || command.b != state.challenge)
    return refused(Reason::ChallengeWrong);
  return kOk;
}

Event event_of(const wire::Command& command) {
  switch (command.op) {
    case wire::Op::Disarm:
      return Event::CmdDisarm;
    case wire::Op::CloseLight:
      return Event::CmdCloseLight;
    case wire::Op::Squeeze:
      return Event::CmdSqueeze;
    case wire::Op::Offer:
      return Event::CmdOffer;
    case wire::Op::Accept:
      return Event::CmdAccept;
    case wire::Op::Abort:
      return Event::CmdAbort;
    case wire::Op::OpenEmpty:
      return Event::CmdOpenEmpty;
    case wire::Op::ManualRelease:
      return command.argument == 2 ? Event::CmdManualRelease : Event::CmdManualAsk;
    default:  // ARM and CLEAR_FAULT have functions of their own
      return Event::CmdHold;
  }
}

Answer check(const State& state, const wire::Command& command) {
  switch (command.op) {
    case wire::Op::CloseLight:
      return check_close_light(state);
    case wire::Op::Squeeze:
      return check_squeeze(state, command);
    case wire::Op::Offer:
      return check_offer(state, command);
    case wire::Op::Accept:
      return check_accept(state, command);
    case wire::Op::Abort:
      return check_abort(state);
    case wire::Op::OpenEmpty:
      return check_open_empty(state);
    case wire::Op::ManualRelease:
      return check_manual(state, command);
    default:
      return kOk;
  }
}

}  // namespace

Decision decide(const State& state, const wire::Command& command) {
  Decision decision{kOk, event_of(command)};
  if (command.op == wire::Op::Arm) decision = decide_arm(state, command);
  if (command.op == wire::Op::ClearFault) decision = decide_clear_fault(state);
  if (!is_ok(decision.answer)) return decision;
  if (reaction(*state.config.table, state.id, decision.event).kind == ReactionKind::Refused) {
    return {{CommandResult::BadState, Reason::WrongState}, decision.event};
  }
  decision.answer = check(state, command);
  return decision;
}

}  // namespace pinjaw::core

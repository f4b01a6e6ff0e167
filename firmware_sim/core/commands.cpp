#include "firmware_sim/core/commands.hpp"

#include <optional>

#include "firmware_sim/core/custody.hpp"
#include "firmware_sim/core/transitions.hpp"
#include "protocol/wire/commands.hpp"

namespace pinjaw::core {
namespace {

using wire::Admission;
using wire::CommandResult;
using wire::Reason;

constexpr std::uint16_t kChallenge_ms = 3000;  // section 2.6

/// Answers to commands that are not looked at further; nothing for one that is.
std::optional<Answer> turned_away(Admission admission) {
  switch (admission) {
    case Admission::NotArmed:
      return Answer{CommandResult::BadSession, Reason::NotArmed};
    case Admission::WrongSession:
      return Answer{CommandResult::BadSession, Reason::WrongSession};
    case Admission::OldSequence:
      return Answer{CommandResult::BadSequence, Reason::SequenceOld};
    case Admission::UsedUp:
      return Answer{CommandResult::BadSequence, Reason::SequenceUsedUp};
    default:
      return std::nullopt;
  }
}

/// Sessions are handed out from blocks that were stored before, so that none comes twice after a power cut:
/// the next block is asked for while this one has a number left, as one may be skipped.
void open_session(State& state) {
  state.next_session = next_session_number(state);
  const std::uint32_t left = state.store.record.session_block - state.next_session;
  if (left <= 1 || left > kSessionBlock) {
    to_store(state.store).session_block = state.next_session + kSessionBlock;
  }
  state.gate.open(static_cast<std::uint16_t>(state.next_session & 0xFFFFU));
  state.session_epoch = state.host.epoch();
  state.frozen = false;
}

/// Another number in each step, 1..4095; no secret, but not one that was heard before. Knuth's multiplicative
/// hash.
std::uint16_t new_challenge(const State& state) {
  const std::uint32_t mixed = (state.counters.steps ^ (state.next_session << 7)) * 2654435761U;
  return static_cast<std::uint16_t>(1U + (mixed >> 16) % 4095U);
}

/// What a command brings with it, taken up before its event.
void take_up(State& state, const wire::Command& command) {
  switch (command.op) {
    case wire::Op::Arm:
      return open_session(state);
    case wire::Op::CloseLight:
      state.receiving = {.giver = wire::kOperatorPeer};
      return;
    case wire::Op::Accept: {
      const wire::Custody& offer = state.peers.find(command.argument)->custody;
      state.receiving = {.giver = command.argument, .token = offer.token, .pair = offer.pair};
      return;
    }
    case wire::Op::Squeeze:
      state.force_set_dn = wire::squeeze_forces(command).set_dn;
      state.permit_dn = wire::squeeze_forces(command).permit_dn;
      return;
    case wire::Op::Offer:
      state.store.record.peer = command.argument;
      return;
    case wire::Op::ManualRelease:
      if (command.argument != 1) return state.timers.challenge.stop();
      state.challenge = new_challenge(state);
      state.timers.challenge.start(kChallenge_ms);
      state.faults.note(wire::FaultCode::ManualRelease);
      return;
    case wire::Op::ClearFault:
      if (state.store.failed) {  // another try
        state.store.failed = false;
        state.store.record_waits = true;
        state.store.layout_waits = state.layouts.committed;
      }
      // A part without a record is the node's own from now on: it can then be offered, or released by hand.
      if (state.id == StateId::FaultHold && !has_custody(state.store.record.custody)) {
        to_store(state.store).custody = Custody::Sole;
      }
      return;
    default:
      return;
  }
}

}  // namespace

wire::Acknowledge acknowledgement(const State& state, const wire::Command& command, const Answer& answer) {
  return {.sequence = command.sequence,
          .op = command.op,
          .result = answer.result,
          .session = state.gate.session(),
          .reason = answer.reason,
          .state = state.id,
          .next_sequence = state.gate.next_sequence()};
}

namespace {

/// The answer to `command`, which is what `said` means without its seal. Not inlined: whoever looks at a seal
/// needs the stack for itself.
[[gnu::noinline]] wire::Acknowledge carry_out(State& state, const wire::Command& said,
                                              const wire::Command& command) {
  const Admission admission = state.gate.admit(command);
  Answer answer;
  if (const std::optional<Answer> away = turned_away(admission)) {
    answer = *away;
  } else {
    const Decision decision = decide(state, command);
    answer = decision.answer;
    if (answer.result == CommandResult::Ok) {
      if (decision.event != Event::CmdClearEmpty) take_up(state, command);
      apply(state, decision.event);
    }
  }
  wire::Acknowledge acknowledge = acknowledgement(state, command, answer);
  if (admission != Admission::New || command.op == wire::Op::Hold) return acknowledge;
  if (command.op == wire::Op::Arm && answer.result != CommandResult::Ok) return acknowledge;
  acknowledge.next_sequence =
      command.sequence == 255 ? command.sequence : static_cast<std::uint8_t>(command.sequence + 1);
  state.gate.remember(said, acknowledge);
  return acknowledge;
}

}  // namespace

wire::Acknowledge obey(State& state, const wire::Command& said) {
  if (state.gate.admit(said) == Admission::Repeated) return state.gate.last_answer();
  if (const auto answer = answer_question(state, said)) return *answer;
  wire::Command command = said;
  if (const auto away = unseal(state, command)) return acknowledgement(state, said, *away);
  return carry_out(state, said, command);
}

}  // namespace pinjaw::core

#include "firmware_sim/core/authentication.hpp"

#include <limits>

#include "firmware_sim/core/commands.hpp"
#include "firmware_sim/core/transitions.hpp"
#include "protocol/wire/seal.hpp"

namespace pinjaw::core {
namespace {

using wire::CommandResult;
using wire::Op;
using wire::Reason;

/// Why an ARM is turned away before anybody looks at its MAC; it would be refused with a right one, too, and
/// a host that waits for another one to fall silent must not be locked out.
std::optional<Answer> not_judged(const State& state) {
  // A memory that was lost, or is used up, might give a number twice: the cell needs a new key.
  const bool fresh = state.store.readable && numbers_are_left(state);
  if (!fresh) return Answer{CommandResult::Refused, Reason::CauseRemains};
  if (state.host.two_hosts()) return Answer{CommandResult::Refused, Reason::TwoHosts};
  if (!state.host.alive()) return Answer{CommandResult::Refused, Reason::HostSilent};
  return std::nullopt;
}

Answer missed(State& state) {
  ++state.counters.wrong_macs;
  state.lock_out.miss();
  if (state.lock_out.locked()) {
    raise(state, wire::FaultCode::Authentication);
    end_session(state);
  } else {
    state.faults.note(wire::FaultCode::Authentication);
  }
  return {CommandResult::BadSession, Reason::Authentication};
}

}  // namespace

std::uint32_t next_session_number(const State& state) {
  const std::uint32_t next = state.next_session + 1;
  return (next & 0xFFFFU) == 0 ? next + 1 : next;
}

bool numbers_are_left(const State& state) {
  constexpr std::uint32_t kReserve = 4 * kSessionBlock;
  return state.next_session < std::numeric_limits<std::uint32_t>::max() - kReserve;
}

std::optional<wire::Acknowledge> answer_question(const State& state, const wire::Command& said) {
  const auto step = static_cast<wire::ArmStep>(said.argument);
  if (said.op != Op::Arm || step == wire::ArmStep::Open) return std::nullopt;
  wire::Acknowledge answer{.sequence = said.sequence,
                           .op = said.op,
                           .result = CommandResult::Refused,
                           .session = state.gate.session(),
                           .reason = Reason::BadArgument,
                           .state = state.id,
                           .next_sequence = state.gate.next_sequence()};
  if (!state.config.key || step > wire::ArmStep::Proof) return answer;
  if (state.lock_out.locked()) {
    answer.reason = Reason::LockedOut;
    return answer;
  }
  answer.result = CommandResult::BadSession;
  answer.reason = Reason::Authentication;
  answer.session = wire::number_answer(*state.config.key, state.config.node, step, next_session_number(state),
                                       wire::nonce_of(said));
  return answer;
}

wire::Result<wire::Command, Answer> unsealed(State& state, const wire::Command& said) {
  if (!state.config.key || said.op == Op::Hold) return said;
  if (state.lock_out.locked()) return Answer{CommandResult::Refused, Reason::LockedOut};
  wire::Command command = said;
  wire::Freshness freshness{.number = state.next_session, .epoch = state.session_epoch};
  if (said.op == Op::Arm) {
    if (const auto answer = not_judged(state)) return *answer;
    freshness = {.number = next_session_number(state), .epoch = state.host.epoch()};
    command.session = state.host.epoch();
  } else {
    if (!state.gate.armed()) return Answer{CommandResult::BadSession, Reason::NotArmed};
    command.session = state.gate.session();
  }
  if (!wire::seal_is_right(*state.config.key, state.config.node, said, freshness)) return missed(state);
  return command;
}

void advance_lock_out(State& state, std::uint16_t elapsed_ms) {
  state.lock_out.advance(elapsed_ms);
  if (!state.lock_out.locked()) state.faults.clear(wire::FaultCode::Authentication);
}

}  // namespace pinjaw::core

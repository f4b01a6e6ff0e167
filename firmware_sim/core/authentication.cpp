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

constexpr Answer kWrongMac{CommandResult::BadSession, Reason::Authentication};
constexpr Answer kLockedOut{CommandResult::Refused, Reason::LockedOut};
constexpr std::uint32_t kFrameBlock = 16;  // chosen: 2^20 frames, an hour of a busy node, for one store

/// The next block, where there is one: at the end the controller falls silent.
void take_block(NvmRecord& record) {
  constexpr std::uint32_t kLast = std::numeric_limits<std::uint32_t>::max() - kFrameBlock;
  if (record.frame_block < kLast) record.frame_block += kFrameBlock;
}

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
  return kWrongMac;
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
  if (!state.config.key || step > wire::ArmStep::Proof) {
    return acknowledgement(state, said, {CommandResult::Refused, Reason::BadArgument});
  }
  if (state.lock_out.locked()) return acknowledgement(state, said, kLockedOut);
  wire::Acknowledge answer = acknowledgement(state, said, kWrongMac);
  answer.session = wire::number_answer(*state.config.key, state.config.node, step, next_session_number(state),
                                       wire::nonce_of(said));
  return answer;
}

std::optional<Answer> unseal(State& state, wire::Command& command) {
  if (!state.config.key || command.op == Op::Hold) return std::nullopt;
  if (state.lock_out.locked()) return kLockedOut;
  wire::Freshness freshness{.number = state.next_session, .epoch = state.session_epoch};
  if (command.op == Op::Arm) {
    if (const auto answer = not_judged(state)) return answer;
    freshness = {.number = next_session_number(state), .epoch = state.host.epoch()};
  } else if (!state.gate.armed()) {
    return Answer{CommandResult::BadSession, Reason::NotArmed};
  }
  if (!wire::seal_is_right(*state.config.key, state.config.node, command, freshness)) return missed(state);
  command.session = command.op == Op::Arm ? state.host.epoch() : state.gate.session();
  return std::nullopt;
}

void start_link(State& state, NvmRecord& record) {
  if (!on_can_fd(state.config)) return;
  state.link = {state.config.node, (wire::FrameNumber{record.frame_block} << 16) + 1};
  take_block(record);
}

void keep_link(State& state) {
  if (!on_can_fd(state.config)) return;
  std::uint16_t sources = 1U << wire::kHostNode;
  if (state.layouts.committed) {
    for (const wire::LayoutPeer& peer : state.layouts.layout.used_peers())
      sources |= static_cast<std::uint16_t>(1U << peer.node);
  }
  state.link.follow(sources);
  if (state.link.take_alarm()) state.faults.note(wire::FaultCode::Authentication);
  if (!state.store.durable() || !state.store.readable) return;
  state.frame_block = state.store.record.frame_block;
  if (static_cast<std::uint32_t>(state.link.next_number() >> 16) + 2 < state.frame_block) return;
  take_block(state.store.record);
  state.store.record_waits = state.store.record.frame_block != state.frame_block;
}

void advance_lock_out(State& state, std::uint16_t elapsed_ms) {
  state.lock_out.advance(elapsed_ms);
  if (!state.lock_out.locked()) state.faults.clear(wire::FaultCode::Authentication);
}

}  // namespace pinjaw::core

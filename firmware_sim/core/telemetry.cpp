#include "firmware_sim/core/telemetry.hpp"

#include <algorithm>

#include "firmware_sim/core/force_control.hpp"
#include "firmware_sim/core/guards.hpp"
#include "firmware_sim/core/rules.hpp"
#include "firmware_sim/core/sending.hpp"
#include "protocol/wire/codec.hpp"
#include "protocol/wire/reception.hpp"

namespace pinjaw::core {
namespace {

constexpr std::uint16_t kIdentityBurst_ms = 20;  // chosen: five pages within 0.1 s of a boot or a request
constexpr std::uint8_t kIdentityPages = 5;
constexpr std::uint16_t kProduct = 0x504A;  // "PJ"

template <class Message>
void send_cyclic(State& state, SendQueue& queue, const Message& message, std::uint8_t& counter) {
  counter = wire::next_counter(counter);
  send(state, queue, wire::pack(message, {.node = state.config.node, .counter = counter}));
}

std::uint16_t positive(std::int32_t value) {
  return static_cast<std::uint16_t>(std::clamp<std::int32_t>(value, 0, 0xFFFF));
}

/// True once a period has passed; then the next one begins.
bool is_due(wire::Countdown& timer, std::uint16_t elapsed_ms, std::uint16_t period_ms) {
  timer.advance(elapsed_ms);
  if (timer.running()) return false;
  timer.start(period_ms);
  return true;
}

bool part_felt(const State& state) {
  if (state.config.passive) return state.measurement.seated;
  switch (state.id) {
    case StateId::Seated:
    case StateId::Squeezing:
      return true;
    default:
      return grips(state.id) && state.layouts.committed && separation_in_window(state);
  }
}

bool in_handoff(const State& state) {
  switch (state.id) {
    case StateId::Loaded:
    case StateId::Ready:
      return state.announced.fact == wire::Fact::Released;
    case StateId::Hold:
      return state.announced.fact == wire::Fact::Retain;
    case StateId::Seating:
    case StateId::Seated:
    case StateId::Squeezing:
    case StateId::Taken:
    case StateId::Offered:
    case StateId::Relax:
    case StateId::Resqueeze:
    case StateId::Opening:
      return true;
    default:
      return false;
  }
}

wire::NodeState status_of(const State& state) {
  const Measurement& m = state.measurement;
  return {.state = state.id,
          .armed = state.gate.armed(),
          .layout_ok = state.layouts.committed,
          .host_alive = state.host.alive(),
          .part = part_felt(state),
          .hold_stable = holds(state.id) && hold_is_stable(state),
          .at_limit = (!state.config.passive && state.guard.cut) || presses_too_hard(state),
          .manual_enable = m.local_enable,
          .degraded = degraded(state),
          .custody = state.announced.fact,
          .f_low_dn = positive(state.config.passive ? 0 : m.squeeze.low_dn),
          .separation_50um = positive(m.separation_10um / 5),
          .fault = state.faults.worst()};
}

wire::Force force_of(const State& state) {
  if (state.config.passive)
    return {.f_high_dn = 0, .f_set_dn = 0, .f_limit_effective_dn = 0, .f_measured_dn = 0};
  return {.f_high_dn = positive(state.measurement.squeeze.high_dn),
          .f_set_dn = positive(force_set_dn(state)),
          .f_limit_effective_dn = positive(force_limit_dn(state)),
          .f_measured_dn = positive(state.measurement.squeeze.measured_dn)};
}

wire::Custody custody_of(const State& state) {
  return {.fact = state.announced.fact,
          .peer = state.announced.peer,
          .token = state.announced.token,
          .pair = state.announced.pair,
          .f_low_n = static_cast<std::uint8_t>(std::clamp<std::int32_t>(
              state.config.passive ? 0 : state.measurement.squeeze.low_dn / 10, 0, 254))};
}

std::uint8_t valve_bits(const Valves& valves) {
  return static_cast<std::uint8_t>((valves.spool == Spool::Close ? 1U : 0U) |
                                   (valves.spool == Spool::Open ? 2U : 0U) | (valves.relax ? 4U : 0U) |
                                   (valves.pre_vent ? 8U : 0U) | (valves.supply_cut ? 16U : 0U));
}

wire::Pneumatics pneumatics_of(const State& state, const Valves& valves) {
  const Measurement& m = state.measurement;
  return {.close_2500ubar = positive((m.close_ubar[0] + m.close_ubar[1]) / 2 / 2500),
          .open_2500ubar = positive(m.open_ubar / 2500),
          .supply_2500ubar = positive(m.supply_mbar * 2 / 5),
          .valves = valve_bits(valves),
          .temperature_degc = std::nullopt};
}

wire::Identity identity_of(const State& state) {
  wire::Identity identity{.page = static_cast<wire::IdentityPage>(state.identity_page)};
  identity.product = kProduct;
  identity.hardware = 1;
  identity.minor = 1;
  identity.serial = state.config.serial;
  identity.reset = state.reset;
  identity.boots = state.store.record.boot_count;
  identity.memory = state.store.failed ? wire::MemoryStatus::Lost : wire::MemoryStatus::Good;
  return identity;
}

void report_identity(State& state, std::uint16_t elapsed_ms, SendQueue& queue) {
  const std::uint16_t period_ms = state.identity_burst ? kIdentityBurst_ms : wire::kIdentityPeriod_ms;
  if (!is_due(state.timers.identity, elapsed_ms, period_ms)) return;
  send_cyclic(state, queue, identity_of(state), state.send_counters.identity);
  if (++state.identity_page == kIdentityPages) {
    state.identity_page = 0;
    state.identity_burst = false;
    state.timers.identity.start(wire::kIdentityPeriod_ms);
  }
}

wire::FaultReport report_of(const State& state, wire::FaultCode code) {
  wire::FaultReport report{
      .code = code, .severity = severity_of(code), .active = state.faults.active(code), .state = state.id};
  if (code == wire::FaultCode::ManualRelease && state.timers.challenge.running()) {
    report.severity = wire::Severity::Info;
    report.argument = state.challenge;
  }
  return report;
}

void report_faults(State& state, std::uint16_t elapsed_ms, SendQueue& queue) {
  if (is_due(state.timers.faults, elapsed_ms, wire::kFaultPeriod_ms)) {
    state.faults.report_all_again();
    if (state.timers.challenge.running()) state.faults.note(wire::FaultCode::ManualRelease);
  }
  const wire::FaultCode code = state.faults.take_report();
  if (code == wire::FaultCode::None) return;
  send_cyclic(state, queue, report_of(state, code), state.send_counters.fault);
}

/// The next of the outcomes that the present fact does not say anyway, if any; they take turns.
const Outcome* next_outcome(State& state) {
  const NvmRecord& record = state.store.record;
  const bool ended = record.custody == Custody::Released || record.custody == Custody::Retained;
  const bool said_now =
      ended && record.outcomes[0].peer == record.peer && record.outcomes[0].token == record.token;
  for (std::size_t i = 0; i < record.outcomes.size(); ++i) {
    const std::uint8_t at = state.outcome_next;
    state.outcome_next = static_cast<std::uint8_t>((at + 1U) % record.outcomes.size());
    const Outcome& outcome = record.outcomes[at];
    if (outcome.peer != 0 && !(said_now && at == 0)) return &outcome;
  }
  return nullptr;
}

/// R10: how earlier handoffs ended stays true, so it is repeated for a receiver that missed it.
void repeat_outcomes(State& state, std::uint16_t elapsed_ms, SendQueue& queue) {
  if (!is_due(state.timers.outcome, elapsed_ms, wire::kCustodyIdle_ms)) return;
  if (!state.store.durable() || !state.store.readable || !keeps(Rule::AnnounceOldOutcomes)) return;
  const Outcome* outcome = next_outcome(state);
  if (outcome == nullptr) return;
  const wire::Custody said{.fact = outcome->retained ? wire::Fact::Retain : wire::Fact::Released,
                           .peer = outcome->peer,
                           .token = outcome->token,
                           .pair = outcome->pair,
                           .f_low_n = std::nullopt};
  send_cyclic(state, queue, said, state.send_counters.custody);
}

void report_custody(State& state, std::uint16_t elapsed_ms, bool changed, SendQueue& queue) {
  const std::uint16_t period_ms = in_handoff(state) ? wire::kCustodyHandoff_ms : wire::kCustodyIdle_ms;
  if (changed || state.timers.custody.left_ms() > period_ms) state.timers.custody.stop();
  if (!is_due(state.timers.custody, elapsed_ms, period_ms)) return;
  send_cyclic(state, queue, custody_of(state), state.send_counters.custody);
}

}  // namespace

void report(State& state, std::uint16_t elapsed_ms, const Valves& valves, const Announcement& said_before,
            SendQueue& queue) {
  report_faults(state, elapsed_ms, queue);
  report_custody(state, elapsed_ms, state.announced != said_before, queue);
  repeat_outcomes(state, elapsed_ms, queue);
  Timers& timers = state.timers;
  SendCounters& counters = state.send_counters;
  if (is_due(timers.status, elapsed_ms, wire::kStatePeriod_ms)) {
    send_cyclic(state, queue, status_of(state), counters.status);
  }
  if (is_due(timers.force, elapsed_ms, wire::kStatePeriod_ms)) {
    send_cyclic(state, queue, force_of(state), counters.force);
  }
  if (is_due(timers.pneumatics, elapsed_ms, wire::kPneumaticsPeriod_ms)) {
    send_cyclic(state, queue, pneumatics_of(state, valves), counters.pneumatics);
  }
  if (is_due(timers.layout, elapsed_ms, wire::kLayoutStatusPeriod_ms)) {
    send_cyclic(state, queue, wire::LayoutStatus{state.layouts.crc, state.config.kit_id}, counters.layout);
  }
  report_identity(state, elapsed_ms, queue);
}

}  // namespace pinjaw::core

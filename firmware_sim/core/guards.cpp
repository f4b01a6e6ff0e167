#include "firmware_sim/core/guards.hpp"

#include <algorithm>

#include "firmware_sim/core/rules.hpp"

namespace pinjaw::core {
namespace {

constexpr std::int32_t kClear_10um = 200;   // section 2.6, OPENING: 2 mm past the window
constexpr std::int32_t kAtStop_10um = 50;   // chosen: an end stop's play and the sensor's offset
constexpr std::int32_t kNoSqueeze_dn = 50;  // section 2.5: F_low under 5 N

bool squeezes(StateId id) {
  return grips(id) || id == StateId::Squeezing;
}

/// R4: `said` is `fact` of the handoff that the record tells of, said to this node.
bool concerns(const wire::Custody& said, wire::Fact fact, const State& state) {
  const NvmRecord& record = state.store.record;
  return said.fact == fact && (said.peer == state.config.node || !keeps(Rule::CompareNodes)) &&
         (said.token == record.token || !keeps(Rule::CompareToken)) &&
         (said.pair == record.pair || !keeps(Rule::ComparePair));
}

/// The same of the handoff that this node receives in and has not latched.
bool concerns_receiving(const wire::Custody& said, wire::Fact fact, const State& state) {
  return said.fact == fact && said.peer == state.config.node && said.token == state.receiving.token &&
         said.pair == state.receiving.pair;
}

}  // namespace

std::int32_t force_limit_dn(const State& state) {
  std::int32_t limit_dn = state.config.hardware_limit_dn;
  if (!state.layouts.committed) return limit_dn;
  const wire::Layout& layout = state.layouts.layout;
  limit_dn = std::min<std::int32_t>(limit_dn, layout.f_limit_dn);
  if (!squeezes(state.id)) return std::min(limit_dn, layout.f_light_dn + 2 * state.config.uncertainty_dn);
  return state.permit_dn == 0 ? limit_dn : std::min<std::int32_t>(limit_dn, state.permit_dn);
}

std::int32_t force_required_dn(const State& state) {
  return state.layouts.committed ? state.layouts.layout.f_required_dn : 0;
}

bool motion_permitted(const State& state) {
  return state.gate.armed() && state.host.permits();
}

bool presses_too_hard(const State& state) {
  return !state.config.passive && state.measurement.squeeze.high_dn > force_limit_dn(state);
}

bool holds_enough(const State& state) {
  if (!state.layouts.committed) return false;
  if (state.config.passive) return state.measurement.seated;
  return state.measurement.squeeze.low_dn >= force_required_dn(state);
}

bool separation_in_window(const State& state) {
  const wire::Layout& layout = state.layouts.layout;
  const std::int32_t off_10um = state.measurement.separation_10um - layout.separation_contact_10um;
  return off_10um <= layout.separation_tolerance_10um && off_10um >= -layout.separation_tolerance_10um;
}

bool closed_past_part(const State& state) {
  const wire::Layout& layout = state.layouts.layout;
  return state.measurement.separation_10um <
         layout.separation_contact_10um - layout.separation_tolerance_10um;
}

bool slipped(const State& state) {
  if (state.config.passive || !state.layouts.committed) return false;
  const std::int32_t drift_um = 10 * (state.measurement.separation_10um - state.reference_10um);
  const std::int32_t tolerance_um = state.layouts.layout.slip_tolerance_um;
  return drift_um > tolerance_um || drift_um < -tolerance_um;
}

bool holds_well(const State& state) {
  if (!holds_enough(state)) return false;
  if (state.config.passive) return true;
  return state.measurement.squeeze.high_dn <= force_limit_dn(state) && separation_in_window(state) &&
         !slipped(state) && state.measurement.suspected == SensorTrouble::None;
}

bool hold_is_stable(const State& state) {
  return !state.timers.stable.running() && holds_well(state);
}

bool peer_says(const State& state, wire::Fact fact) {
  const Peer* peer = state.peers.find(state.store.record.peer);
  return peer != nullptr && concerns(peer->custody, fact, state);
}

bool peer_concludes(const State& state, wire::Fact outcome) {
  const Peer* peer = state.peers.find(state.store.record.peer);
  return peer != nullptr && (concerns(peer->custody, outcome, state) || concerns(peer->past, outcome, state));
}

bool peer_holds(const State& state) {
  const std::uint8_t node = state.store.record.peer;
  const Peer* peer = state.peers.find(node);
  const wire::LayoutPeer* named = state.layouts.committed ? state.layouts.layout.peer(node) : nullptr;
  if (peer == nullptr || named == nullptr || !peer->fresh() || peer->faulty.running()) return false;
  if (!peer_says(state, wire::Fact::Take)) return false;
  return peer->state.state == StateId::Taken && peer->state.hold_stable &&
         peer->state.f_low_dn.value_or(0) >= named->f_required_dn;
}

bool giver_offers(const State& state) {
  const Peer* peer = state.peers.find(state.receiving.giver);
  return peer != nullptr && peer->custody_fresh.running() &&
         concerns_receiving(peer->custody, wire::Fact::Offer, state);
}

bool giver_retains(const State& state) {
  const Peer* peer = state.peers.find(state.receiving.giver);
  return peer != nullptr && (concerns_receiving(peer->custody, wire::Fact::Retain, state) ||
                             concerns_receiving(peer->past, wire::Fact::Retain, state));
}

bool no_part_proven(const State& state) {
  const Measurement& m = state.measurement;
  if (state.config.passive) return m.seats_clear;
  if (m.suspected != SensorTrouble::None || m.squeeze.low_dn >= kNoSqueeze_dn) return false;
  const bool closed = m.separation_10um <= state.config.separation_min_10um + kAtStop_10um;
  const bool open = m.separation_10um >= state.config.separation_max_10um - kAtStop_10um;
  if (!state.layouts.committed) return open || closed;
  return closed_past_part(state) || (closed && !separation_in_window(state)) || fully_open(state);
}

bool clear_of_part(const State& state) {
  const wire::Layout& layout = state.layouts.layout;
  const std::int32_t clear_10um =
      layout.separation_contact_10um + layout.separation_tolerance_10um + kClear_10um;
  return state.measurement.separation_10um > clear_10um || fully_open(state);
}

bool fully_open(const State& state) {
  if (state.config.passive) return true;
  const std::int32_t open_10um =
      std::min<std::int32_t>(state.layouts.layout.separation_open_10um, state.config.separation_max_10um);
  const std::int32_t window_10um =
      state.layouts.layout.separation_contact_10um + state.layouts.layout.separation_tolerance_10um;
  return state.measurement.separation_10um >= std::max(open_10um - kAtStop_10um, window_10um + 1);
}

wire::FaultCode sensor_fault(const Measurement& measurement) {
  switch (measurement.trouble) {
    case SensorTrouble::PressureRange:
      return wire::FaultCode::PressureRange;
    case SensorTrouble::Position:
      return wire::FaultCode::Position;
    default:
      return wire::FaultCode::SensorsDisagree;
  }
}

bool degraded(const State& state) {
  return state.measurement.supply_low || state.measurement.trouble != SensorTrouble::None;
}

}  // namespace pinjaw::core

#pragma once

#include "firmware_sim/core/core.hpp"
#include "tests/firmware_sim/core/bench.hpp"

/// A controller in any state, made rather than led there: for tests of one question at a time.
namespace pinjaw::core::test {

/// Everyone it needs is heard, in order and just now.
inline void hear_host(State& state, std::uint16_t epoch = 77, bool permit = true) {
  for (std::uint8_t counter = 0; counter < 3; ++counter) {
    state.host.hear({.label = {.counter = counter},
                     .message = {.permit = static_cast<std::uint16_t>(permit ? 0x3FFF : 0), .epoch = epoch}},
                    state.config.node);
  }
}

inline void hear_peer(State& state, std::uint8_t node, const wire::Custody& custody,
                      const wire::NodeState& status = {}) {
  for (std::uint8_t counter = 0; counter < 3; ++counter) {
    state.peers.hear(wire::Received<wire::Custody>{{node, counter}, custody});
    state.peers.hear(wire::Received<wire::NodeState>{{node, counter}, status});
  }
}

/// The arm in `id`: its layout committed (contact at 30 mm +- 0.5 mm, open at 50 mm, F_light 12 N, F_req 40
/// N, F_limit 140 N, u 12 N), the jaws at contact, the host alive with a permit.
inline State made(StateId id) {
  State state = power_on(Config{.node = kArm, .kit_id = 0x1234}, NvmImage{});
  state.id = id;
  state.layouts.committed = true;
  state.layouts.layout = layout_for(kArm);
  state.layouts.crc = wire::layout_crc_of(state.layouts.layout);
  state.peers.follow(state.layouts.layout);
  state.store.record_waits = false;
  state.measurement.started = true;
  state.measurement.separation_10um = 3000;
  state.reference_10um = 3000;
  hear_host(state);
  return state;
}

inline void squeeze_with(State& state, std::int32_t measured_dn) {
  state.measurement.squeeze = {measured_dn, measured_dn - 120, measured_dn + 120};
}

}  // namespace pinjaw::core::test

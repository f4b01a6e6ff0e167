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
/// N, F_limit 140 N, u 12 N), the jaws at contact, the host alive with a permit and a session.
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
  state.gate.open(900);
  state.session_epoch = 77;
  return state;
}

inline void squeeze_with(State& state, std::int32_t measured_dn) {
  state.measurement.squeeze = {measured_dn, measured_dn - 120, measured_dn + 120};
}

/// Jaws that hold 52 N at contact for long enough, with every time limit running.
inline State held(StateId id) {
  State state = made(id);
  squeeze_with(state, 520);
  state.timers.state.start(1);
  state.timers.peer_good.start(1);
  state.receiving.giver = wire::kOperatorPeer;
  return state;
}

/// Has latched token 7 of the pedestal, which says `fact` of it.
inline State taken(wire::Fact fact) {
  State state = held(StateId::Taken);
  state.store.record = {.custody = Custody::Latched, .peer = kPedestal, .token = 7, .pair = 8};
  state.receiving = {.giver = kPedestal, .token = 7, .pair = 8};
  hear_peer(state, kPedestal, {.fact = fact, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40});
  return state;
}

/// Has offered token 7 to the pedestal, which says that it took it, and holds.
inline State offering(StateId id) {
  State state = held(id);
  state.store.record = {.custody = Custody::Offered, .peer = kPedestal, .token = 7, .pair = 8};
  state.announced = {wire::Fact::Offer, kPedestal, 7, 8};
  hear_peer(state, kPedestal, {.fact = wire::Fact::Take, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40},
            {.state = StateId::Taken, .hold_stable = true, .f_low_dn = 400});
  return state;
}

}  // namespace pinjaw::core::test

#pragma once

#include "firmware_sim/core/state.hpp"
#include "protocol/wire/codec.hpp"

namespace pinjaw::core {

/// The next frame number is stored as given out.
inline bool has_frame_number(const State& state) {
  return static_cast<std::uint32_t>(state.link.next_number() >> 16) < state.frame_block;
}

/// Queues a frame, sealed on CAN FD; one for which there is no room, or no number that is stored, is counted.
inline void send(State& state, SendQueue& queue, const wire::Frame& frame) {
  const bool numbered = !on_can_fd(state.config) || has_frame_number(state);
  if (queue.size >= SendQueue::kCapacity || !numbered) {
    ++state.counters.frames_not_sent;
    return;
  }
  queue.frames[queue.size++] = on_can_fd(state.config) ? state.link.seal(*state.config.key, frame) : frame;
}

}  // namespace pinjaw::core

#pragma once

#include "firmware_sim/core/state.hpp"
#include "protocol/wire/codec.hpp"

namespace pinjaw::core {

/// The next frame number is stored as given out.
inline bool has_frame_number(const State& state) {
  return static_cast<std::uint32_t>(state.link.next_number() >> 16) < state.frame_block;
}

/// Queues a frame as it is; one for which there is no room is counted.
inline void queue_frame(State& state, SendQueue& queue, const wire::Frame& frame) {
  if (queue.size < SendQueue::kCapacity) {
    queue.frames[queue.size++] = frame;
  } else {
    ++state.counters.frames_not_sent;
  }
}

/// Queues a frame, sealed on CAN FD; one for which there is no number that is stored is counted, too.
inline void send(State& state, SendQueue& queue, const wire::Frame& frame) {
  if (!on_can_fd(state.config)) return queue_frame(state, queue, frame);
  if (has_frame_number(state)) {
    queue_frame(state, queue, state.link.seal(*state.config.key, frame));
  } else {
    ++state.counters.frames_not_sent;
  }
}

}  // namespace pinjaw::core

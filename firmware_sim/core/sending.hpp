#pragma once

#include "firmware_sim/core/state.hpp"
#include "protocol/wire/codec.hpp"

namespace pinjaw::core {

/// Queues a frame; one for which there is no room is counted.
inline void send(State& state, SendQueue& queue, const wire::Frame& frame) {
  if (queue.size >= SendQueue::kCapacity) {
    ++state.counters.frames_not_sent;
    return;
  }
  queue.frames[queue.size++] = frame;
}

}  // namespace pinjaw::core

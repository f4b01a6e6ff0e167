#pragma once

#include "firmware_sim/core/state.hpp"
#include "protocol/wire/codec.hpp"

/// The service behind ISO-TP: WRITE, COMMIT, READBACK, IDENT, LOG (docs/reliability.md 2.4).
namespace pinjaw::core {

/// Takes a segment that the host sent to this node.
void take_segment(State& state, const wire::Segment& segment, SendQueue& queue);

/// Lets time pass: sends what is due of an answer, and the answer to COMMIT once the layout is stored.
void advance_service(State& state, std::uint16_t elapsed_ms, SendQueue& queue);

/// Takes up a stored layout at power on, unless it is none that this controller may use.
void restore_layout(State& state, const LayoutBlob& blob);

}  // namespace pinjaw::core

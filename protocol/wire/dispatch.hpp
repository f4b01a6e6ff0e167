#pragma once

#include <optional>

#include "protocol/wire/codec.hpp"

namespace pinjaw::wire {

namespace detail {
// Not inlined: the stack holds one message, not one of each.
template <class Message, class Handler>
[[gnu::noinline]] constexpr std::optional<FrameError> parse_into(const Frame& frame, Handler& handler) {
  const auto received = parse<Message>(frame);
  if (!received) return received.error();
  handler(*received);
  return std::nullopt;
}
}  // namespace detail

/// Parses `frame` as what its id says and calls `handler(const Received<Message>&)`, or
/// `handler(const Segment&)` for a segment of a layout transfer. Gives what was wrong, or nothing.
template <class Handler>
constexpr std::optional<FrameError> dispatch(const Frame& frame, Handler&& handler) {
  const auto identifier = identify(frame);
  if (!identifier) return identifier.error();
  switch (identifier->type) {
    case MessageType::GlobalHold:
      return detail::parse_into<GlobalHold>(frame, handler);
    case MessageType::Fault:
      return detail::parse_into<FaultReport>(frame, handler);
    case MessageType::Custody:
      return detail::parse_into<Custody>(frame, handler);
    case MessageType::State:
      return detail::parse_into<NodeState>(frame, handler);
    case MessageType::Force:
      return detail::parse_into<Force>(frame, handler);
    case MessageType::HostHeartbeat:
      return detail::parse_into<HostHeartbeat>(frame, handler);
    case MessageType::Time:
      return detail::parse_into<HostTime>(frame, handler);
    case MessageType::Command:
      return detail::parse_into<Command>(frame, handler);
    case MessageType::Acknowledge:
      return detail::parse_into<Acknowledge>(frame, handler);
    case MessageType::Pneumatics:
      return detail::parse_into<Pneumatics>(frame, handler);
    case MessageType::LayoutStatus:
      return detail::parse_into<LayoutStatus>(frame, handler);
    case MessageType::Identity:
      return detail::parse_into<Identity>(frame, handler);
    case MessageType::TransferRequest:
    case MessageType::TransferResponse:
      break;
  }
  const auto segment = parse_segment(frame);
  if (!segment) return segment.error();
  handler(*segment);
  return std::nullopt;
}

}  // namespace pinjaw::wire

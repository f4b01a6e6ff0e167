#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "protocol/wire/bits.hpp"
#include "protocol/wire/crc.hpp"
#include "protocol/wire/frame.hpp"
#include "protocol/wire/messages.hpp"
#include "protocol/wire/result.hpp"

/// Messages to frames and back. `parse` is the only way from a frame to a message, so no unchecked frame is
/// held.
namespace pinjaw::wire {

/// Why a frame is no message of ours.
enum class FrameError : std::uint8_t {
  UnknownId,
  Extended,  ///< 29-bit id
  NotData,   ///< remote or error frame
  Length,    ///< not 8 bytes
  Checksum,  ///< corrupted, or meant for another id
  Version,
  Counter,   ///< CTR 15
  Reserved,  ///< a bit that belongs to no field is set
  Value,     ///< a field holds a number that means nothing
};
inline constexpr std::size_t kFrameErrorCount = 9;

/// Whose frame it is, and which in its row.
struct Label {
  std::uint8_t node = 0;     ///< 0 where the message is the host's
  std::uint8_t counter = 0;  ///< CTR 0..14; 0 where the message has SEQ instead
  friend constexpr bool operator==(const Label&, const Label&) = default;
};

template <class Message>
struct Received {
  Label label;
  Message message;
};

/// A message's type and node by its id.
struct Identifier {
  MessageType type{};
  std::uint8_t node = 0;
  friend constexpr bool operator==(const Identifier&, const Identifier&) = default;
};

constexpr bool node_is_legal(const MessageSpec& spec, std::uint8_t node) {
  if (!spec.per_node) return node == 0;
  if (spec.direction == Direction::AnyToAll) return node <= 15;
  return node >= kFirstNode && node <= kLastNode;
}

constexpr std::uint32_t id_of(Identifier identifier) {
  return std::uint32_t{spec_of(identifier.type).base_id} + identifier.node;
}

constexpr std::optional<Identifier> identify(std::uint32_t id) {
  for (const MessageSpec& spec : kMessages) {
    const std::uint32_t width = spec.per_node ? 16U : 1U;
    if (id < spec.base_id || id >= spec.base_id + width) continue;
    const auto node = static_cast<std::uint8_t>(id - spec.base_id);
    if (node_is_legal(spec, node)) return Identifier{spec.type, node};
  }
  return std::nullopt;
}

namespace detail {

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

/// A member's raw number. Quantities past the field's range are written as its largest.
template <class T>
constexpr std::uint64_t to_raw(const FieldSpec& field, const T& member) {
  if constexpr (kIsOptional<T>) {
    if (!member) return ones(field.length);
    return std::min<std::uint64_t>(*member, field.largest());
  } else if constexpr (std::is_same_v<T, FaultCode>) {
    return field.length == 8 ? index_of(member) : static_cast<std::uint64_t>(member);
  } else if constexpr (std::is_same_v<T, Fact>) {
    return member == Fact::Unknown ? ones(field.length) : static_cast<std::uint64_t>(member);
  } else if constexpr (std::is_enum_v<T>) {
    return static_cast<std::uint64_t>(member);
  } else {
    return std::min<std::uint64_t>(member, field.largest());
  }
}

/// Precondition: field.admits(raw).
template <class T>
constexpr T from_raw(const FieldSpec& field, std::uint64_t raw) {
  if constexpr (kIsOptional<T>) {
    if (raw == ones(field.length)) return std::nullopt;
    return static_cast<typename T::value_type>(raw);
  } else if constexpr (std::is_same_v<T, FaultCode>) {
    return field.length == 8 ? kFaultCodes[raw] : static_cast<FaultCode>(raw);
  } else if constexpr (std::is_same_v<T, Fact>) {
    return raw == ones(field.length) ? Fact::Unknown : static_cast<Fact>(raw);
  } else {
    return static_cast<T>(raw);
  }
}

struct Writer {
  std::uint64_t word = 0;
  template <class T>
  constexpr void operator()(const FieldSpec& field, const T& member) {
    word |= (to_raw(field, member) & ones(field.length)) << field.start;
  }
};

struct Reader {
  std::uint64_t word = 0;
  std::uint64_t seen = 0;
  bool legal = true;
  template <class T>
  constexpr void operator()(const FieldSpec& field, T& member) {
    const std::uint64_t raw = (word >> field.start) & ones(field.length);
    seen |= field.mask();
    if (!field.admits(raw)) {
      legal = false;
    } else {
      member = from_raw<T>(field, raw);
    }
  }
};

constexpr std::uint8_t checksum(Identifier identifier, const Payload& data) {
  Crc8 crc;
  crc.add(static_cast<std::uint8_t>(static_cast<unsigned>(identifier.type) << 4 | identifier.node));
  crc.add(0x5A);
  for (std::size_t i = 1; i < data.size(); ++i) crc.add(data[i]);
  return crc.value();
}

/// The bits before the message's own fields.
constexpr std::uint64_t header_mask(Protection protection) {
  return protection == Protection::Counter ? 0xFFFFU : 0xFFU;
}

/// What every frame must satisfy before its fields are looked at.
constexpr std::optional<FrameError> header_error(const Frame& frame, const MessageSpec& spec,
                                                 std::uint8_t node) {
  if (frame.length != 8) return FrameError::Length;
  if (frame.data[0] != checksum({spec.type, node}, frame.data)) return FrameError::Checksum;
  if (spec.protection != Protection::Counter) return std::nullopt;
  if (frame.data[1] >> 4 != kProtocolVersion) return FrameError::Version;
  if ((frame.data[1] & 0xFU) > kCounterField.largest()) return FrameError::Counter;
  return std::nullopt;
}

}  // namespace detail

/// Which message a frame would be by its id alone; its content is not yet checked.
constexpr Result<Identifier, FrameError> identify(const Frame& frame) {
  if (frame.kind != FrameKind::Data) return FrameError::NotData;
  if (frame.extended) return FrameError::Extended;
  const std::optional<Identifier> identifier = identify(frame.id);
  if (!identifier) return FrameError::UnknownId;
  return *identifier;
}

/// The frame that says `message`.
/// Preconditions: label.node 1..14 (0 for the host's messages, 0..15 for GlobalHold), label.counter 0..14.
template <class Message>
constexpr Frame pack(const Message& message, Label label) {
  constexpr const MessageSpec& kSpec = spec_of(Message::kType);
  detail::Writer writer;
  Message::fields(message, writer);
  if constexpr (kSpec.protection == Protection::Counter) {
    writer.word |= std::uint64_t{label.counter & 0xFU} << kCounterField.start;
    writer.word |= std::uint64_t{kProtocolVersion} << kVersionField.start;
  }
  Frame frame{.id = id_of({Message::kType, label.node}), .data = to_payload(writer.word)};
  frame.data[0] = detail::checksum({Message::kType, label.node}, frame.data);
  return frame;
}

/// The message that `frame` says, or the first thing wrong with it; UnknownId where it is another message's.
template <class Message>
constexpr Result<Received<Message>, FrameError> parse(const Frame& frame) {
  constexpr const MessageSpec& kSpec = spec_of(Message::kType);
  const auto identifier = identify(frame);
  if (!identifier) return identifier.error();
  if (identifier->type != Message::kType) return FrameError::UnknownId;
  if (const auto error = detail::header_error(frame, kSpec, identifier->node)) return *error;
  Received<Message> received{.label = {.node = identifier->node}, .message = {}};
  if constexpr (kSpec.protection == Protection::Counter) received.label.counter = frame.data[1] & 0xFU;
  detail::Reader reader{.word = to_word(frame.data), .seen = detail::header_mask(kSpec.protection)};
  Message::fields(received.message, reader);
  if (!reader.legal) return FrameError::Value;
  if ((reader.word & ~reader.seen) != 0) return FrameError::Reserved;
  return received;
}

/// A segment of a layout transfer: 8 bytes whose content the ISO-TP machines check.
struct Segment {
  Identifier identifier;
  Payload data;
};

constexpr Result<Segment, FrameError> parse_segment(const Frame& frame) {
  const auto identifier = identify(frame);
  if (!identifier) return identifier.error();
  if (spec_of(identifier->type).protection != Protection::None) return FrameError::UnknownId;
  if (frame.length != 8) return FrameError::Length;
  return Segment{*identifier, frame.data};
}

constexpr Frame pack_segment(const Segment& segment) {
  return {.id = id_of(segment.identifier), .data = segment.data};
}

}  // namespace pinjaw::wire

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
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

namespace detail {

/// What the codec needs of a row of the table while it runs: a controller keeps no names and no comments.
struct Address {
  std::uint16_t base_id = 0;
  std::uint16_t legal_nodes = 0;  ///< bit n: the id base_id + n is a message's
  Protection protection{};
};

inline constexpr auto kAddresses = [] {
  std::array<Address, kMessages.size()> addresses{};
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    const MessageSpec& spec = kMessages[i];
    addresses[i] = {.base_id = spec.base_id, .protection = spec.protection};
    for (std::uint8_t node = 0; node < 16; ++node) {
      if (node_is_legal(spec, node)) addresses[i].legal_nodes |= static_cast<std::uint16_t>(1U << node);
    }
  }
  return addresses;
}();

constexpr const Address& address_of(MessageType type) {
  return kAddresses[static_cast<std::size_t>(type) - 1];
}

/// The same of a field, in two words that fold to constants wherever the row is one.
struct FieldRule {
  enum Kind : std::uint32_t { Number, Named, FaultCodes };
  std::uint32_t shape;  ///< start, length, kind: 8 bits each
  std::uint32_t names;  ///< Named: a bit for each legal value

  constexpr FieldRule(std::uint32_t shape_of, std::uint32_t names_of) : shape(shape_of), names(names_of) {}
  [[gnu::always_inline]] constexpr explicit FieldRule(const FieldSpec& field)
      : shape(field.start | std::uint32_t{field.length} << 8), names(field.value_bits) {
    Kind kind = Number;
    if (!field.values.empty()) kind = names != 0 ? Named : FaultCodes;
    shape |= kind << 16;
  }
  [[nodiscard]] constexpr unsigned start() const { return shape & 0xFFU; }
  [[nodiscard]] constexpr std::uint64_t mask() const { return ones(shape >> 8 & 0xFFU); }
  [[nodiscard]] constexpr std::uint32_t kind() const { return shape >> 16; }
  [[nodiscard]] constexpr bool admits(std::uint64_t raw) const {
    if (kind() == Named) return raw < 32 && (names >> raw & 1U) != 0;
    return kind() != FaultCodes || raw == 0 || index_of(static_cast<FaultCode>(raw)) != 0;
  }
};

/// Largest raw number of a field that has no bound but its bits.
[[gnu::always_inline]] constexpr std::uint64_t largest_of(const FieldSpec& field) {
  return ones(field.length) - (field.all_ones_is_unknown ? 1U : 0U);
}

}  // namespace detail

constexpr std::uint32_t id_of(Identifier identifier) {
  return std::uint32_t{detail::address_of(identifier.type).base_id} + identifier.node;
}

constexpr std::optional<Identifier> identify(std::uint32_t id) {
  for (std::size_t i = 0; i < detail::kAddresses.size(); ++i) {
    const std::uint32_t node = id - detail::kAddresses[i].base_id;  // wraps past 15 where id is less
    if (node < 16 && (detail::kAddresses[i].legal_nodes >> node & 1U) != 0) {
      return Identifier{static_cast<MessageType>(i + 1), static_cast<std::uint8_t>(node)};
    }
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
[[gnu::always_inline]] constexpr std::uint64_t to_raw(const FieldSpec& field, const T& member) {
  if constexpr (kIsOptional<T>) {
    if (!member) return ones(field.length);
    return std::min<std::uint64_t>(*member, largest_of(field));
  } else if constexpr (std::is_same_v<T, FaultCode>) {
    return field.length == 8 ? index_of(member) : static_cast<std::uint64_t>(member);
  } else if constexpr (std::is_same_v<T, Fact>) {
    return member == Fact::Unknown ? ones(field.length) : static_cast<std::uint64_t>(member);
  } else if constexpr (std::is_enum_v<T>) {
    return static_cast<std::uint64_t>(member);
  } else {
    return std::min<std::uint64_t>(member, largest_of(field));
  }
}

/// Precondition: field.admits(raw).
template <class T>
[[gnu::always_inline]] constexpr T from_raw(const FieldSpec& field, std::uint64_t raw) {
  if constexpr (kIsOptional<T>) {
    if (raw == ones(field.length)) return std::nullopt;
    return static_cast<typename T::value_type>(raw);
  } else if constexpr (std::is_same_v<T, FaultCode>) {
    return field.length == 8 ? kFaultCodes[static_cast<std::size_t>(raw)] : static_cast<FaultCode>(raw);
  } else if constexpr (std::is_same_v<T, Fact>) {
    return raw == ones(field.length) ? Fact::Unknown : static_cast<Fact>(raw);
  } else {
    return static_cast<T>(raw);
  }
}

// Not inlined: one copy for all fields of all messages is a third of a controller's code.
struct Writer {
  std::uint64_t word = 0;
  template <class T>
  [[gnu::always_inline]] constexpr void operator()(const FieldSpec& field, const T& member) {
    put(FieldRule(field).shape, to_raw(field, member));
  }
  [[gnu::noinline]] constexpr void put(std::uint32_t shape, std::uint64_t raw) {
    const FieldRule rule(shape, 0);
    word |= (raw & rule.mask()) << rule.start();
  }
};

struct Reader {
  std::uint64_t word = 0;
  std::uint64_t seen = 0;
  bool legal = true;
  template <class T>
  [[gnu::always_inline]] constexpr void operator()(const FieldSpec& field, T& member) {
    member = from_raw<T>(field, take(FieldRule(field).shape, FieldRule(field).names));
  }
  /// The field's raw number; 0 where it means nothing, and then the frame is not legal.
  [[gnu::noinline]] constexpr std::uint64_t take(std::uint32_t shape, std::uint32_t names) {
    const FieldRule rule(shape, names);
    const std::uint64_t raw = (word >> rule.start()) & rule.mask();
    seen |= rule.mask() << rule.start();
    if (rule.admits(raw)) return raw;
    legal = false;
    return 0;
  }
};

/// Nothing but CTR, which is no member of a message, has a bound that FieldRule does not know.
static_assert([] {
  for (const MessageSpec& spec : kMessages) {
    for (const FieldSpec& field : spec.fields) {
      if (field.raw_maximum != 0 && !same_text(field.name, kCounterField.name)) return false;
    }
  }
  return true;
}());

[[gnu::noinline]] constexpr std::uint8_t checksum(Identifier identifier, const Payload& data) {
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

}  // namespace detail

/// Which message a frame would be by its id alone; its content is not yet checked.
constexpr Result<Identifier, FrameError> identify(const Frame& frame) {
  if (frame.kind != FrameKind::Data) return FrameError::NotData;
  if (frame.extended) return FrameError::Extended;
  const std::optional<Identifier> identifier = identify(frame.id);
  if (!identifier) return FrameError::UnknownId;
  return *identifier;
}

namespace detail {

// What all messages have in common stands in functions of its own: once in a controller's flash.

/// What every frame must satisfy before its fields are looked at; then `reader` is ready for them.
[[gnu::noinline]] constexpr std::optional<FrameError> open(const Frame& frame, MessageType type, Label& label,
                                                           Reader& reader) {
  const auto identifier = identify(frame);
  if (!identifier) return identifier.error();
  if (identifier->type != type) return FrameError::UnknownId;
  if (frame.length != 8) return FrameError::Length;
  if (frame.data[0] != checksum(*identifier, frame.data)) return FrameError::Checksum;
  const Protection protection = address_of(type).protection;
  label.node = identifier->node;
  if (protection == Protection::Counter) {
    if (frame.data[1] >> 4 != kProtocolVersion) return FrameError::Version;
    label.counter = frame.data[1] & 0xFU;
    if (label.counter > kCounterField.raw_maximum) return FrameError::Counter;
  }
  reader = {.word = to_word(frame.data), .seen = header_mask(protection)};
  return std::nullopt;
}

/// What every frame must satisfy once its fields were read.
[[gnu::noinline]] constexpr std::optional<FrameError> close(const Reader& reader) {
  if (!reader.legal) return FrameError::Value;
  if ((reader.word & ~reader.seen) != 0) return FrameError::Reserved;
  return std::nullopt;
}

/// The frame of written fields.
[[gnu::noinline]] constexpr Frame seal(std::uint64_t word, MessageType type, Label label) {
  const Identifier identifier{type, label.node};
  if (address_of(type).protection == Protection::Counter) {
    word |= std::uint64_t{(label.counter & 0xFU) | unsigned{kProtocolVersion} << 4} << kCounterField.start;
  }
  Frame frame{.id = id_of(identifier), .data = to_payload(word)};
  frame.data[0] = checksum(identifier, frame.data);
  return frame;
}
static_assert(kVersionField.start == kCounterField.start + 4);

}  // namespace detail

/// The frame that says `message`.
/// Preconditions: label.node 1..14 (0 for the host's messages, 0..15 for GlobalHold), label.counter 0..14.
template <class Message>
constexpr Frame pack(const Message& message, Label label) {
  detail::Writer writer;
  Message::fields(message, writer);
  return detail::seal(writer.word, Message::kType, label);
}

/// The message that `frame` says, or the first thing wrong with it; UnknownId where it is another message's.
template <class Message>
constexpr Result<Received<Message>, FrameError> parse(const Frame& frame) {
  detail::Reader reader;
  Received<Message> received{};
  if (const auto error = detail::open(frame, Message::kType, received.label, reader)) return *error;
  Message::fields(received.message, reader);
  if (const auto error = detail::close(reader)) return *error;
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
  if (detail::address_of(identifier->type).protection != Protection::None) return FrameError::UnknownId;
  if (frame.length != 8) return FrameError::Length;
  return Segment{*identifier, frame.data};
}

constexpr Frame pack_segment(const Segment& segment) {
  return {.id = id_of(segment.identifier), .data = segment.data};
}

}  // namespace pinjaw::wire

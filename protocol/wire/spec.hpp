#pragma once

#include <cstdint>
#include <span>

#include "protocol/wire/bits.hpp"

/// What one row of the message table says.
namespace pinjaw::wire {

/// A number of an enumeration and its name in the DBC and the documents.
struct ValueName {
  std::uint32_t value = 0;
  const char* name = "";
};

/// A bit for each value of a list whose values are all under 32; 0 for any other list.
constexpr std::uint32_t bits_of(std::span<const ValueName> values) {
  std::uint32_t bits = 0;
  for (const ValueName& value : values) {
    if (value.value >= 32) return 0;
    bits |= std::uint32_t{1} << value.value;
  }
  return bits;
}

/// physical = raw * numerator / denominator
struct Ratio {
  std::uint16_t numerator = 1;
  std::uint16_t denominator = 1;
};

/// When a field is there: in every frame, as the selector, or only where the selector says so.
enum class Presence : std::uint8_t { Always, Selector, Selected };

struct FieldSpec {
  const char* name = "";
  std::uint8_t start = 0;   ///< lowest bit, Intel numbering
  std::uint8_t length = 0;  ///< bits
  Ratio factor{};
  const char* unit = "";
  bool all_ones_is_unknown = false;     ///< the largest raw value says that the quantity is not known
  std::uint64_t raw_maximum = 0;        ///< largest raw value; 0: as many as fit
  std::span<const ValueName> values{};  ///< not empty: an enumeration, and no other value is legal
  std::uint32_t value_bits = bits_of(values);
  Presence presence = Presence::Always;
  std::uint8_t selector = 0;  ///< with Presence::Selected: the selector's value
  const char* comment = "";

  /// Largest raw value that is a number, not 'unknown'.
  [[nodiscard]] constexpr std::uint64_t largest() const {
    if (raw_maximum != 0) return raw_maximum;
    return ones(length) - (all_ones_is_unknown ? 1 : 0);
  }
  [[nodiscard]] constexpr std::uint64_t mask() const { return ones(length) << start; }

  /// Whether `raw` is a legal value of this field.
  [[nodiscard]] constexpr bool admits(std::uint64_t raw) const {
    for (const ValueName& value : values) {
      if (value.value == raw) return true;
    }
    if (!values.empty()) return false;
    return raw <= largest() || (all_ones_is_unknown && raw == ones(length));
  }
};

enum class Direction : std::uint8_t { AnyToAll, NodeToAll, HostToAll, HostToNode, NodeToHost };

/// How the first bytes protect a frame.
enum class Protection : std::uint8_t {
  Counter,   ///< CRC, CTR and VER: cyclic frames
  Sequence,  ///< CRC and SEQ: commands and their answers
  None,      ///< ISO-TP segments; what they carry has its own CRC-32
};

enum class MessageType : std::uint8_t {
  GlobalHold = 1,
  Fault,
  Custody,
  State,
  Force,
  HostHeartbeat,
  Time,
  Command,
  Acknowledge,
  Pneumatics,
  LayoutStatus,
  Identity,
  TransferRequest,
  TransferResponse,
};

struct MessageSpec {
  MessageType type{};  ///< also the high half of the Data ID's first byte
  const char* name = "";
  std::uint16_t base_id = 0;  ///< plus the node where `per_node`
  bool per_node = true;
  Direction direction{};
  Protection protection{};
  std::uint16_t period_ms = 0;  ///< longest time between two; 0: sent on events only
  std::span<const FieldSpec> fields;
  const char* comment = "";
};

}  // namespace pinjaw::wire

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/wire/bits.hpp"
#include "protocol/wire/result.hpp"
#include "protocol/wire/services.hpp"

/// The layout record: what a controller is sent of a design. Forces are sums of both jaws.
namespace pinjaw::wire {

inline constexpr std::size_t kMaxPins = 16;
inline constexpr std::size_t kMaxPeers = 4;
inline constexpr std::size_t kMaxLayoutBytes = 256;
inline constexpr std::uint32_t kLayoutMagic = 0x314C4A50;  ///< "PJL1"
inline constexpr std::uint8_t kLayoutSchema = 1;
inline constexpr std::uint16_t kMaxForce_dn = 2500;          ///< what CUSTODY.F_LOW can say
inline constexpr std::uint16_t kMaxSeparation_10um = 20400;  ///< what STATE.SEP can say

enum class NodeClass : std::uint8_t { Gripper = 1, Passive = 2 };
enum class Jaw : std::uint8_t { Left = 0, Right = 1 };

struct LayoutPin {
  Jaw jaw = Jaw::Left;
  std::int8_t column = 0;
  std::int8_t row = 0;
  std::uint16_t length_10um = 0;
  friend constexpr bool operator==(const LayoutPin&, const LayoutPin&) = default;
};

/// A node that this one may hand the part to or take it from, and the layout it must have.
struct LayoutPeer {
  std::uint8_t node = 0;
  std::uint32_t layout_crc = 0;
  std::uint16_t f_required_dn = 0;
  std::uint16_t pair_crc = 0;
  friend constexpr bool operator==(const LayoutPeer&, const LayoutPeer&) = default;
};

struct Layout {
  NodeClass node_class = NodeClass::Gripper;
  std::uint16_t kit_id = 0;
  std::uint32_t part_id = 0;
  std::uint32_t grid_pitch_nm = 0;
  std::uint32_t pin_diameter_nm = 0;
  std::uint8_t pin_count = 0;
  std::array<LayoutPin, kMaxPins> pins{};  ///< the first pin_count
  std::uint16_t separation_open_10um = 0;
  std::uint16_t separation_contact_10um = 0;
  std::uint16_t separation_tolerance_10um = 0;
  std::uint16_t f_light_dn = 0;
  std::uint16_t f_required_dn = 0;
  std::uint16_t f_limit_dn = 0;
  std::uint16_t slip_tolerance_um = 0;
  std::uint16_t stable_ms = 0;
  bool passive = false;
  std::uint8_t peer_count = 0;
  std::array<LayoutPeer, kMaxPeers> peers{};  ///< the first peer_count

  [[nodiscard]] constexpr std::span<const LayoutPin> used_pins() const {
    return std::span(pins).first(std::min<std::size_t>(pin_count, kMaxPins));
  }
  [[nodiscard]] constexpr std::span<const LayoutPeer> used_peers() const {
    return std::span(peers).first(std::min<std::size_t>(peer_count, kMaxPeers));
  }
  [[nodiscard]] constexpr const LayoutPeer* peer(std::uint8_t node) const {
    for (const LayoutPeer& entry : used_peers()) {
      if (entry.node == node) return &entry;
    }
    return nullptr;
  }
  friend constexpr bool operator==(const Layout&, const Layout&) = default;
};

struct EncodedLayout {
  std::array<std::uint8_t, kMaxLayoutBytes> bytes{};
  std::size_t size = 0;
  [[nodiscard]] constexpr std::span<const std::uint8_t> span() const { return std::span(bytes).first(size); }
};

/// The controller that a layout is meant for.
struct LayoutTarget {
  std::uint8_t node = 0;
  NodeClass node_class = NodeClass::Gripper;
  std::uint16_t kit_id = 0;
  std::uint16_t f_hardware_dn = 0;     ///< most the hardware can and may do
  std::uint16_t f_uncertainty_dn = 0;  ///< u: F_low = F - u, F_high = F + u
};

/// The record, checksums included. Precondition: pin_count <= 16, peer_count <= 4.
EncodedLayout encode(const Layout& layout);
void encode(const Layout& layout, ByteWriter& out);

/// CRC-32 over the record's bytes before the checksum; peers do not count, so that two layouts can name each
/// other.
std::uint32_t layout_crc_of(const Layout& layout);

/// Reads a record and checks its form, checksums and ranges and everything that holds on any controller.
Result<Layout, TransferStatus> decode_layout(std::span<const std::uint8_t> bytes);
/// The same into a layout that is there; what it holds means nothing unless the answer is Ok.
TransferStatus decode_layout(std::span<const std::uint8_t> bytes, Layout& layout);

/// Ok, or why `target` must not work by `layout`. Precondition: it came from decode_layout.
TransferStatus admissible(const Layout& layout, const LayoutTarget& target);

/// One side of a handoff.
struct PairSide {
  std::uint8_t node = 0;
  std::uint32_t layout_crc = 0;
};

/// CRC-16 over the part and both layouts, lower node first: the same in both directions.
std::uint16_t pair_crc_of(std::uint32_t part_id, PairSide one, PairSide other);

/// First bits of a SHA-256 given as hexadecimal text; 0 where the text has too few digits.
std::uint16_t kit_id_of(std::span<const char> sha256_hex);
std::uint32_t part_id_of(std::span<const char> sha256_hex);

/// Forces for the record from micronewtons: a requirement rounds up, a limit down, both within 0..65535 dN.
constexpr std::uint16_t requirement_dn(std::int64_t micro_n) {
  return static_cast<std::uint16_t>(std::clamp<std::int64_t>((micro_n + 99'999) / 100'000, 0, 65535));
}
constexpr std::uint16_t limit_dn(std::int64_t micro_n) {
  return static_cast<std::uint16_t>(std::clamp<std::int64_t>(micro_n / 100'000, 0, 65535));
}
/// F_req = max(required, 2 F_light): a light squeeze must be told from a hold.
constexpr std::uint16_t layout_requirement_dn(std::uint16_t required_dn, std::uint16_t light_dn) {
  return static_cast<std::uint16_t>(std::max<unsigned>(required_dn, std::min(2U * light_dn, 65535U)));
}

}  // namespace pinjaw::wire

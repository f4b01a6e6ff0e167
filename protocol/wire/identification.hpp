#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "protocol/wire/bits.hpp"
#include "protocol/wire/layout.hpp"

namespace pinjaw::wire {

/// What the IDENT service answers: enough for a host to compare kit and forces before it sends a layout.
struct Identification {
  static constexpr std::size_t kBytes = 13;

  std::uint8_t node = 0;
  NodeClass node_class = NodeClass::Gripper;
  std::uint16_t kit_id = 0;
  std::uint16_t f_hardware_dn = 0;
  std::uint16_t f_uncertainty_dn = 0;
  std::uint32_t layout_crc = 0;  ///< of the committed layout
  bool layout_committed = false;
  friend constexpr bool operator==(const Identification&, const Identification&) = default;

  constexpr void put(ByteWriter& out) const {
    out.put(node, 1);
    out.put(static_cast<std::uint8_t>(node_class), 1);
    out.put(kit_id, 2);
    out.put(f_hardware_dn, 2);
    out.put(f_uncertainty_dn, 2);
    out.put(layout_crc, 4);
    out.put(layout_committed ? 1 : 0, 1);
  }
  /// From the body of an answer; nothing where its length or class is not ours.
  static constexpr std::optional<Identification> read(std::span<const std::uint8_t> body) {
    if (body.size() != kBytes || (body[1] != 1 && body[1] != 2)) return std::nullopt;
    ByteReader in(body);
    Identification read;
    read.node = static_cast<std::uint8_t>(in.take(1));
    read.node_class = static_cast<NodeClass>(in.take(1));
    read.kit_id = static_cast<std::uint16_t>(in.take(2));
    read.f_hardware_dn = static_cast<std::uint16_t>(in.take(2));
    read.f_uncertainty_dn = static_cast<std::uint16_t>(in.take(2));
    read.layout_crc = in.take(4);
    read.layout_committed = in.take(1) == 1;
    return read;
  }
};

}  // namespace pinjaw::wire

#include "protocol/wire/layout.hpp"

#include <algorithm>
#include <utility>

#include "protocol/wire/bits.hpp"
#include "protocol/wire/codes.hpp"
#include "protocol/wire/crc.hpp"

namespace pinjaw::wire {

namespace {

constexpr std::uint8_t kCylinder = 0;

/// Where a record is written to that only its checksum is wanted of.
struct ChecksumOnly {
  Crc32 crc;
  void put(std::uint32_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) crc.add(static_cast<std::uint8_t>(value >> (8 * i)));
  }
};

template <class Out>
void put_pins(Out& out, const Layout& layout) {
  out.put(layout.pin_count, 1);
  for (const LayoutPin& pin : layout.used_pins()) {
    out.put(static_cast<std::uint8_t>(pin.jaw), 1);
    out.put(static_cast<std::uint8_t>(pin.column), 1);
    out.put(static_cast<std::uint8_t>(pin.row), 1);
    out.put(kCylinder, 1);
    out.put(pin.length_10um, 2);
  }
}

template <class Out>
void put_body(Out& out, const Layout& layout) {
  out.put(kLayoutMagic, 4);
  out.put(kLayoutSchema, 1);
  out.put(static_cast<std::uint8_t>(layout.node_class), 1);
  out.put(layout.kit_id, 2);
  out.put(layout.part_id, 4);
  out.put(layout.grid_pitch_nm, 4);
  out.put(layout.pin_diameter_nm, 4);
  put_pins(out, layout);
  out.put(layout.separation_open_10um, 2);
  out.put(layout.separation_contact_10um, 2);
  out.put(layout.separation_tolerance_10um, 2);
  out.put(layout.f_light_dn, 2);
  out.put(layout.f_required_dn, 2);
  out.put(layout.f_limit_dn, 2);
  out.put(layout.slip_tolerance_um, 2);
  out.put(layout.stable_ms, 2);
  out.put(layout.passive ? 1 : 0, 1);
}

template <class Out>
void put_peers(Out& out, const Layout& layout) {
  out.put(layout.peer_count, 1);
  for (const LayoutPeer& peer : layout.used_peers()) {
    out.put(peer.node, 1);
    out.put(peer.layout_crc, 4);
    out.put(peer.f_required_dn, 2);
    out.put(peer.pair_crc, 2);
  }
}

TransferStatus read_pins(ByteReader& in, Layout& layout) {
  layout.pin_count = static_cast<std::uint8_t>(in.take(1));
  if (in.truncated()) return TransferStatus::Length;
  if (layout.pin_count < 1 || layout.pin_count > kMaxPins) return TransferStatus::PinCount;
  for (LayoutPin& pin : std::span(layout.pins).first(layout.pin_count)) {
    const std::uint32_t jaw = in.take(1);
    pin.jaw = jaw == 0 ? Jaw::Left : Jaw::Right;
    pin.column = static_cast<std::int8_t>(in.take(1));
    pin.row = static_cast<std::int8_t>(in.take(1));
    const std::uint32_t kind = in.take(1);
    pin.length_10um = static_cast<std::uint16_t>(in.take(2));
    if (in.truncated()) return TransferStatus::Length;
    if (jaw > 1 || kind != kCylinder || pin.column < 0 || pin.row < 0 || pin.length_10um == 0) {
      return TransferStatus::Pin;
    }
  }
  return TransferStatus::Ok;
}

TransferStatus read_head(ByteReader& in, Layout& layout) {
  if (in.take(4) != kLayoutMagic) return in.truncated() ? TransferStatus::Length : TransferStatus::Magic;
  if (in.take(1) != kLayoutSchema) return in.truncated() ? TransferStatus::Length : TransferStatus::Schema;
  const std::uint32_t node_class = in.take(1);
  layout.node_class = node_class == 1 ? NodeClass::Gripper : NodeClass::Passive;
  layout.kit_id = static_cast<std::uint16_t>(in.take(2));
  layout.part_id = in.take(4);
  layout.grid_pitch_nm = in.take(4);
  layout.pin_diameter_nm = in.take(4);
  if (in.truncated()) return TransferStatus::Length;
  if (node_class < 1 || node_class > 2) return TransferStatus::NodeClass;
  return TransferStatus::Ok;
}

/// Of a record that ends before, what follows finds nothing to read and says so.
TransferStatus read_numbers(ByteReader& in, Layout& layout) {
  const auto u16 = [&in] { return static_cast<std::uint16_t>(in.take(2)); };
  layout.separation_open_10um = u16();
  layout.separation_contact_10um = u16();
  layout.separation_tolerance_10um = u16();
  layout.f_light_dn = u16();
  layout.f_required_dn = u16();
  layout.f_limit_dn = u16();
  layout.slip_tolerance_um = u16();
  layout.stable_ms = u16();
  const std::uint32_t passive = in.take(1);
  layout.passive = passive == 1;
  return passive > 1 ? TransferStatus::PassiveFields : TransferStatus::Ok;
}

TransferStatus read_peers(ByteReader& in, Layout& layout) {
  layout.peer_count = static_cast<std::uint8_t>(in.take(1));
  if (layout.peer_count > kMaxPeers) return TransferStatus::Peers;
  for (LayoutPeer& peer : std::span(layout.peers).first(layout.peer_count)) {
    peer.node = static_cast<std::uint8_t>(in.take(1));
    peer.layout_crc = in.take(4);
    peer.f_required_dn = static_cast<std::uint16_t>(in.take(2));
    peer.pair_crc = static_cast<std::uint16_t>(in.take(2));
  }
  return in.truncated() ? TransferStatus::Length : TransferStatus::Ok;
}

/// Reads a checksum and compares it with that of the bytes from `begin` to it.
TransferStatus check_sum(ByteReader& in, std::span<const std::uint8_t> bytes, std::size_t begin,
                         TransferStatus wrong) {
  const std::size_t end = in.used();
  const std::uint32_t told = in.take(4);
  if (in.truncated()) return TransferStatus::Length;
  return told == crc_of<Crc32>(bytes.subspan(begin, end - begin)) ? TransferStatus::Ok : wrong;
}

bool has_duplicate_hole(std::span<const LayoutPin> pins) {
  for (const LayoutPin& pin : pins) {
    for (const LayoutPin& other : pins) {
      if (&other != &pin && other.jaw == pin.jaw && other.column == pin.column && other.row == pin.row)
        return true;
    }
  }
  return false;
}

/// Precondition: there is a pin.
bool on_both_jaws(std::span<const LayoutPin> pins) {
  for (const LayoutPin& pin : pins) {
    if (pin.jaw != pins.front().jaw) return true;
  }
  return false;
}

TransferStatus check_passive(const Layout& layout) {
  const bool forceless = layout.f_light_dn == 0 && layout.f_required_dn == 0;
  return forceless && !on_both_jaws(layout.used_pins()) ? TransferStatus::Ok : TransferStatus::PassiveFields;
}

TransferStatus check_gripper(const Layout& layout) {
  if (!on_both_jaws(layout.used_pins())) return TransferStatus::JawWithoutPins;
  const unsigned reach = unsigned{layout.separation_contact_10um} + layout.separation_tolerance_10um;
  if (layout.separation_open_10um <= reach || layout.separation_open_10um > kMaxSeparation_10um) {
    return TransferStatus::Separation;
  }
  if (layout.f_light_dn >= layout.f_required_dn || layout.f_light_dn == 0) return TransferStatus::LightForce;
  if (layout.f_required_dn > layout.f_limit_dn) return TransferStatus::ForceWindow;
  if (layout.f_limit_dn > kMaxForce_dn) return TransferStatus::ForceOverHardware;
  if (layout.slip_tolerance_um == 0) return TransferStatus::Timing;
  return TransferStatus::Ok;
}

TransferStatus check_peers(const Layout& layout) {
  const std::span<const LayoutPeer> peers = layout.used_peers();
  for (std::size_t i = 0; i < peers.size(); ++i) {
    if (peers[i].node < kFirstNode || peers[i].node > kLastNode) return TransferStatus::Peers;
    if (layout.peer(peers[i].node) != &peers[i]) return TransferStatus::Peers;
  }
  return TransferStatus::Ok;
}

TransferStatus check_content(const Layout& layout) {
  if (has_duplicate_hole(layout.used_pins())) return TransferStatus::DuplicateHole;
  if (layout.passive != (layout.node_class == NodeClass::Passive)) return TransferStatus::PassiveFields;
  if (layout.stable_ms == 0) return TransferStatus::Timing;
  const TransferStatus status = layout.passive ? check_passive(layout) : check_gripper(layout);
  return status == TransferStatus::Ok ? check_peers(layout) : status;
}

/// The first `count` digits' number; 0 where there are fewer.
std::uint32_t first_digits(std::span<const char> hex, std::size_t count) {
  constexpr char kDigits[] = "0123456789abcdefABCDEF";
  constexpr std::size_t kCount = sizeof kDigits - 1;
  if (hex.size() < count) return 0;
  std::uint32_t value = 0;
  for (const char c : hex.first(count)) {
    const auto place = static_cast<std::size_t>(std::find(kDigits, kDigits + kCount, c) - kDigits);
    if (place == kCount) return 0;
    value = value << 4 | static_cast<std::uint32_t>(place < 16 ? place : place - 6);
  }
  return value;
}

}  // namespace

void encode(const Layout& layout, ByteWriter& out) {
  put_body(out, layout);
  out.put(layout_crc_of(layout), 4);
  put_peers(out, layout);
  ChecksumOnly peers;
  put_peers(peers, layout);
  out.put(peers.crc.value(), 4);
}

EncodedLayout encode(const Layout& layout) {
  EncodedLayout encoded;
  ByteWriter out(encoded.bytes);
  encode(layout, out);
  encoded.size = out.used();
  return encoded;
}

std::uint32_t layout_crc_of(const Layout& layout) {
  ChecksumOnly body;
  put_body(body, layout);
  return body.crc.value();
}

TransferStatus decode_layout(std::span<const std::uint8_t> bytes, Layout& layout) {
  layout = {};
  ByteReader in(bytes);
  TransferStatus status = read_head(in, layout);
  if (status == TransferStatus::Ok) status = read_pins(in, layout);
  if (status == TransferStatus::Ok) status = read_numbers(in, layout);
  if (status != TransferStatus::Ok) return status;
  status = check_sum(in, bytes, 0, TransferStatus::LayoutChecksum);
  if (status != TransferStatus::Ok) return status;
  const std::size_t peers = in.used();
  status = read_peers(in, layout);
  if (status != TransferStatus::Ok) return status;
  status = check_sum(in, bytes, peers, TransferStatus::PeersChecksum);
  if (in.left() != 0) return TransferStatus::Length;
  return status == TransferStatus::Ok ? check_content(layout) : status;
}

Result<Layout, TransferStatus> decode_layout(std::span<const std::uint8_t> bytes) {
  Layout layout;
  if (const TransferStatus status = decode_layout(bytes, layout); status != TransferStatus::Ok) return status;
  return layout;
}

TransferStatus admissible(const Layout& layout, const LayoutTarget& target) {
  if (layout.node_class != target.node_class) return TransferStatus::NodeClass;
  if (layout.kit_id != target.kit_id) return TransferStatus::Kit;
  const std::uint32_t own_crc = layout_crc_of(layout);
  for (const LayoutPeer& peer : layout.used_peers()) {
    if (peer.node == target.node) return TransferStatus::Peers;
    const PairSide own{target.node, own_crc};
    if (peer.pair_crc != pair_crc_of(layout.part_id, own, {peer.node, peer.layout_crc})) {
      return TransferStatus::PairChecksum;
    }
  }
  if (layout.passive) return TransferStatus::Ok;
  if (layout.f_limit_dn > target.f_hardware_dn) return TransferStatus::ForceOverHardware;
  if (layout.f_required_dn + 2U * target.f_uncertainty_dn > layout.f_limit_dn)
    return TransferStatus::ForceWindow;
  return TransferStatus::Ok;
}

std::uint16_t pair_crc_of(std::uint32_t part_id, PairSide one, PairSide other) {
  if (other.node < one.node) std::swap(one, other);
  std::array<std::uint8_t, 12> bytes{};
  ByteWriter out(bytes);
  out.put(part_id, 4);
  out.put(one.layout_crc, 4);
  out.put(other.layout_crc, 4);
  return crc_of<Crc16>(bytes);
}

std::uint16_t kit_id_of(std::span<const char> sha256_hex) {
  return static_cast<std::uint16_t>(first_digits(sha256_hex, 4));
}

std::uint32_t part_id_of(std::span<const char> sha256_hex) {
  return first_digits(sha256_hex, 8);
}

}  // namespace pinjaw::wire

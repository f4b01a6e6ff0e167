#include "tests/firmware_sim/model_check/layouts.hpp"

#include <algorithm>

namespace pinjaw::core::model {
namespace {

constexpr std::uint16_t kKit = 0x1234;
constexpr std::uint32_t kPart = 0xCAFE0001;

wire::Layout body_of(std::uint8_t node) {
  wire::Layout layout{
      .kit_id = kKit, .part_id = kPart, .grid_pitch_nm = 11'112'500, .pin_diameter_nm = 4'762'500};
  layout.stable_ms = 150;
  layout.slip_tolerance_um = 200;
  layout.pin_count = 3;
  for (std::uint8_t i = 0; i < 3; ++i) {
    layout.pins[i] = {
        .jaw = wire::Jaw::Left, .column = 0, .row = static_cast<std::int8_t>(i), .length_10um = 1650};
  }
  if (node == kPallet) {
    layout.node_class = wire::NodeClass::Passive;
    layout.passive = true;
    return layout;
  }
  layout.pin_count = 4;
  layout.pins[3] = {.jaw = wire::Jaw::Right, .column = 0, .row = 1, .length_10um = 1650};
  layout.separation_open_10um = kOpen_10um;
  layout.separation_contact_10um = kContact_10um;
  layout.separation_tolerance_10um = 50;
  layout.f_light_dn = 120;
  layout.f_required_dn = kRequired_dn;
  layout.f_limit_dn = kPermit_dn;
  return layout;
}

}  // namespace

Config config_of(std::uint8_t node) {
  Config config;
  config.node = node;
  config.kit_id = kKit;
  config.passive = node == kPallet;
  if (config.passive) config.seat_switches = 7;
  config.ramp_dn_per_ms = config.hardware_limit_dn;
  return config;
}

wire::Layout layout_of(std::uint8_t node, std::span<const std::uint8_t> nodes, std::uint8_t misfit) {
  wire::Layout layout = body_of(node);
  if (node == misfit) layout.pins[0].length_10um = 1700;
  const wire::PairSide own{node, wire::layout_crc_of(layout)};
  for (const std::uint8_t other : nodes) {
    if (other == node) continue;
    const wire::Layout theirs = body_of(other);
    const wire::PairSide side{other, wire::layout_crc_of(theirs)};
    layout.peers[layout.peer_count++] = {.node = other,
                                         .layout_crc = side.layout_crc,
                                         .f_required_dn = theirs.f_required_dn,
                                         .pair_crc = wire::pair_crc_of(kPart, own, side)};
  }
  return layout;
}

LayoutBlob blob_of(const wire::Layout& layout) {
  const wire::EncodedLayout encoded = wire::encode(layout);
  LayoutBlob blob;
  std::copy(encoded.bytes.begin(), encoded.bytes.end(), blob.bytes.begin());
  blob.size = static_cast<std::uint16_t>(encoded.size);
  return blob;
}

}  // namespace pinjaw::core::model

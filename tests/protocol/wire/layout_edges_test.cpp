// Promises: I8, TRANSFER.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "protocol/wire/crc.hpp"
#include "protocol/wire/layout.hpp"

/// The layout record's limits, each met from both sides.
namespace pinjaw::wire {
namespace {

Layout with_pins(std::uint8_t left, std::uint8_t right) {
  Layout layout{.kit_id = 1,
                .part_id = 0x01020304,
                .grid_pitch_nm = 11'112'500,
                .pin_diameter_nm = 4'762'500,
                .separation_open_10um = 5000,
                .separation_contact_10um = 3000,
                .separation_tolerance_10um = 50,
                .f_light_dn = 120,
                .f_required_dn = 400,
                .f_limit_dn = 1400,
                .slip_tolerance_um = 200,
                .stable_ms = 150};
  for (std::uint8_t i = 0; i < left + right; ++i) {
    const Jaw jaw = i < left ? Jaw::Left : Jaw::Right;
    if (i < kMaxPins) layout.pins.at(i) = {jaw, static_cast<std::int8_t>(i), 3, 1650};
  }
  layout.pin_count = static_cast<std::uint8_t>(left + right);
  return layout;
}

Layout pallet(std::uint8_t pins) {
  Layout layout = with_pins(pins, 0);
  layout.node_class = NodeClass::Passive;
  layout.passive = true;
  layout.f_light_dn = layout.f_required_dn = 0;
  return layout;
}

TransferStatus verdict(const Layout& layout) {
  const EncodedLayout encoded = encode(layout);
  const auto decoded = decode_layout(encoded.span());
  if (!decoded) return decoded.error();
  EXPECT_EQ(encode(*decoded).bytes, encoded.bytes);
  return TransferStatus::Ok;
}

TEST(LayoutLimits, one_to_sixteen_pins) {
  EXPECT_EQ(verdict(pallet(1)), TransferStatus::Ok);
  EXPECT_EQ(verdict(pallet(16)), TransferStatus::Ok);
  EXPECT_EQ(verdict(with_pins(1, 1)), TransferStatus::Ok);
  EXPECT_EQ(verdict(with_pins(8, 8)), TransferStatus::Ok);
  EXPECT_EQ(verdict(with_pins(15, 1)), TransferStatus::Ok);
  EXPECT_EQ(verdict(pallet(0)), TransferStatus::PinCount);
}

TEST(LayoutLimits, a_count_over_the_room_gives_the_room) {
  Layout layout;
  layout.pin_count = 200;
  layout.peer_count = 200;
  EXPECT_EQ(layout.used_pins().size(), 16U);
  EXPECT_EQ(layout.used_peers().size(), 4U);
  layout.pin_count = 16;
  layout.peer_count = 4;
  EXPECT_EQ(layout.used_pins().size(), 16U);
  EXPECT_EQ(layout.used_peers().size(), 4U);
  layout.pin_count = 3;
  layout.peer_count = 1;
  EXPECT_EQ(layout.used_pins().size(), 3U);
  EXPECT_EQ(layout.used_peers().size(), 1U);
}

TEST(LayoutLimits, what_was_there_before_is_no_part_of_a_record_that_is_read) {
  const EncodedLayout one_pin = encode(pallet(1));
  const auto wanted = decode_layout(one_pin.span());
  ASSERT_TRUE(wanted.has_value());
  Layout before = with_pins(8, 8);
  before.peer_count = 1;
  before.peers[0] = {2, 3, 4, 5};
  ASSERT_EQ(decode_layout(one_pin.span(), before), TransferStatus::Ok);
  EXPECT_EQ(before, *wanted);
}

TEST(LayoutLimits, a_gripper_has_pins_on_both_jaws_and_a_pallet_on_one) {
  EXPECT_EQ(verdict(with_pins(2, 0)), TransferStatus::JawWithoutPins);
  EXPECT_EQ(verdict(with_pins(0, 2)), TransferStatus::JawWithoutPins);
  Layout right = pallet(2);
  for (LayoutPin& pin : right.pins) pin.jaw = Jaw::Right;
  EXPECT_EQ(verdict(right), TransferStatus::Ok);
  Layout both = pallet(2);
  both.pins[1].jaw = Jaw::Right;
  EXPECT_EQ(verdict(both), TransferStatus::PassiveFields);
}

TEST(LayoutLimits, a_pallet_has_no_force_and_its_class_says_so) {
  Layout layout = pallet(2);
  layout.f_light_dn = 1;
  EXPECT_EQ(verdict(layout), TransferStatus::PassiveFields);
  layout = pallet(2);
  layout.f_required_dn = 1;
  EXPECT_EQ(verdict(layout), TransferStatus::PassiveFields);
  layout = pallet(2);
  layout.node_class = NodeClass::Gripper;
  EXPECT_EQ(verdict(layout), TransferStatus::PassiveFields)
      << "passive, says the flag; a gripper, says the class";
  layout = with_pins(2, 2);
  layout.node_class = NodeClass::Passive;
  EXPECT_EQ(verdict(layout), TransferStatus::PassiveFields);
}

TEST(LayoutLimits, open_is_wider_than_the_contact_window_and_within_what_state_can_say) {
  Layout layout = with_pins(2, 2);
  layout.separation_open_10um = 3050;
  EXPECT_EQ(verdict(layout), TransferStatus::Separation);
  layout.separation_open_10um = 3051;
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
  layout.separation_open_10um = 20400;
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
  layout.separation_open_10um = 20401;
  EXPECT_EQ(verdict(layout), TransferStatus::Separation);
}

TEST(LayoutLimits, light_is_under_required_under_limit_under_250_newton) {
  Layout layout = with_pins(2, 2);
  layout.f_light_dn = 399;
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
  layout.f_light_dn = 400;
  EXPECT_EQ(verdict(layout), TransferStatus::LightForce);
  layout.f_light_dn = 1;
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
  layout.f_limit_dn = 400;
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
  layout.f_limit_dn = 399;
  EXPECT_EQ(verdict(layout), TransferStatus::ForceWindow);
  layout.f_limit_dn = 2500;
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
  layout.f_limit_dn = 2501;
  EXPECT_EQ(verdict(layout), TransferStatus::ForceOverHardware);
  layout = with_pins(2, 2);
  layout.slip_tolerance_um = 1;
  layout.stable_ms = 1;
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
}

TEST(LayoutLimits, a_hole_is_used_once_by_a_jaw_whichever_two_pins_it_are) {
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      Layout layout = with_pins(4, 1);
      layout.pins.at(a) = layout.pins.at(b);
      EXPECT_EQ(verdict(layout), TransferStatus::DuplicateHole) << a << ' ' << b;
      layout.pins.at(a).row = static_cast<std::int8_t>(layout.pins.at(b).row + 1);
      EXPECT_EQ(verdict(layout), TransferStatus::Ok) << "another row";
    }
  }
  Layout layout = with_pins(1, 1);
  layout.pins[1] = layout.pins[0];
  layout.pins[1].jaw = Jaw::Right;
  EXPECT_EQ(verdict(layout), TransferStatus::Ok) << "the other jaw's hole";
}

TEST(LayoutLimits, a_pin_stands_in_row_and_column_0_or_more_and_has_a_length) {
  Layout layout = with_pins(2, 2);
  layout.pins[0] = {Jaw::Left, 0, 0, 1};
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
  layout.pins[0] = {Jaw::Left, 127, 127, 65535};
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
}

TEST(LayoutLimits, up_to_four_peers_with_nodes_1_to_14_each_once) {
  Layout layout = with_pins(2, 2);
  layout.peer_count = 4;
  layout.peers = {{{.node = 1}, {.node = 14}, {.node = 2}, {.node = 13}}};
  EXPECT_EQ(verdict(layout), TransferStatus::Ok);
  for (const std::uint8_t strange : {std::uint8_t{0}, std::uint8_t{15}}) {
    Layout bad = layout;
    bad.peers[3].node = strange;
    EXPECT_EQ(verdict(bad), TransferStatus::Peers) << int{strange};
  }
  layout.peers[3].node = 1;
  EXPECT_EQ(verdict(layout), TransferStatus::Peers);
}

TEST(LayoutLimits, a_peer_is_found_by_its_node_among_those_in_use) {
  Layout layout = with_pins(2, 2);
  layout.peer_count = 2;
  layout.peers = {{{.node = 3, .f_required_dn = 30}, {.node = 5, .f_required_dn = 50}, {.node = 7}}};
  ASSERT_NE(layout.peer(5), nullptr);
  EXPECT_EQ(layout.peer(5)->f_required_dn, 50);
  EXPECT_EQ(layout.peer(3), &layout.peers[0]);
  EXPECT_EQ(layout.peer(7), nullptr) << "not in use";
  EXPECT_EQ(layout.peer(0), nullptr);
}

/// A record with the bytes of `layout`, one of them changed, and all checksums right.
std::vector<std::uint8_t> changed(const Layout& layout, std::size_t at, std::uint8_t value) {
  const EncodedLayout good = encode(layout);
  std::vector<std::uint8_t> bytes(good.span().begin(), good.span().end());
  bytes.at(at) = value;
  const std::size_t body = 21 + std::size_t{layout.pin_count} * 6 + 17;
  const auto seal = [&bytes](std::size_t begin, std::size_t end) {
    ByteWriter(std::span(bytes).subspan(end, 4))
        .put(crc_of<Crc32>(std::span(bytes).subspan(begin, end - begin)), 4);
  };
  seal(0, body);
  seal(body + 4, bytes.size() - 4);
  return bytes;
}

TEST(LayoutLimits, numbers_that_mean_nothing_are_named_by_their_subject) {
  const Layout layout = with_pins(2, 2);
  EXPECT_EQ(decode_layout(changed(layout, 20, 17)).error(), TransferStatus::PinCount);
  EXPECT_EQ(decode_layout(changed(layout, 21, 2)).error(), TransferStatus::Pin) << "jaw";
  EXPECT_EQ(decode_layout(changed(layout, 22, 0x80)).error(), TransferStatus::Pin) << "column -128";
  EXPECT_EQ(decode_layout(changed(layout, 23, 0xFF)).error(), TransferStatus::Pin) << "row -1";
  EXPECT_EQ(decode_layout(changed(layout, 24, 1)).error(), TransferStatus::Pin) << "kind";
  EXPECT_EQ(decode_layout(changed(layout, 61, 2)).error(), TransferStatus::PassiveFields);
  EXPECT_EQ(decode_layout(changed(layout, 66, 5)).error(), TransferStatus::Peers);
}

TEST(LayoutLimits, a_wrong_checksum_is_named_by_what_it_covers) {
  Layout layout = with_pins(2, 2);
  layout.peer_count = 1;
  layout.peers[0].node = 2;
  EncodedLayout encoded = encode(layout);
  encoded.bytes.at(62) ^= 1U;
  EXPECT_EQ(decode_layout(encoded.span()).error(), TransferStatus::LayoutChecksum);
  encoded = encode(layout);
  encoded.bytes.at(encoded.size - 1) ^= 1U;
  EXPECT_EQ(decode_layout(encoded.span()).error(), TransferStatus::PeersChecksum);
}

TEST(LayoutLimits, fields_travel_in_the_order_of_the_specification) {
  Layout layout = with_pins(1, 1);
  layout.peer_count = 1;
  layout.peers[0] = {.node = 9, .layout_crc = 0xA1A2A3A4, .f_required_dn = 0xB1B2, .pair_crc = 0xC1C2};
  const EncodedLayout encoded = encode(layout);
  std::array<std::uint8_t, 256> bytes{};
  ByteWriter out(bytes);
  for (const char c : {'P', 'J', 'L', '1'}) out.put(static_cast<std::uint8_t>(c), 1);
  out.put(1, 1);
  out.put(1, 1);
  out.put(1, 2);
  out.put(0x01020304, 4);
  out.put(11'112'500, 4);
  out.put(4'762'500, 4);
  out.put(2, 1);
  for (const unsigned jaw : {0U, 1U}) {
    out.put(jaw, 1);
    out.put(jaw, 1);  // the column
    out.put(3, 1);
    out.put(0, 1);
    out.put(1650, 2);
  }
  for (const unsigned number : {5000U, 3000U, 50U, 120U, 400U, 1400U, 200U, 150U}) out.put(number, 2);
  out.put(0, 1);
  const std::uint32_t body_crc = crc_of<Crc32>(std::span(bytes).first(out.used()));
  EXPECT_EQ(layout_crc_of(layout), body_crc);
  out.put(body_crc, 4);
  const std::size_t peers = out.used();
  out.put(1, 1);
  out.put(9, 1);
  out.put(0xA1A2A3A4, 4);
  out.put(0xB1B2, 2);
  out.put(0xC1C2, 2);
  out.put(crc_of<Crc32>(std::span(bytes).subspan(peers, out.used() - peers)), 4);
  EXPECT_EQ(encoded.size, out.used());
  EXPECT_EQ(encoded.bytes, bytes);
}

TEST(LayoutLimits, a_layout_that_says_nothing_is_all_zero) {
  const EncodedLayout encoded = encode(Layout{});
  for (std::size_t i = 6; i < 21 + 17; ++i) EXPECT_EQ(encoded.bytes.at(i), 0) << i;
  EXPECT_EQ(encoded.bytes[5], 1) << "a gripper";
  Layout one;
  one.pin_count = one.peer_count = 1;
  const EncodedLayout with_one = encode(one);
  for (std::size_t i = 21; i < 27; ++i) EXPECT_EQ(with_one.bytes.at(i), 0) << i;
  for (std::size_t i = 49; i < 58; ++i) EXPECT_EQ(with_one.bytes.at(i), 0) << i;
  EXPECT_EQ(EncodedLayout{}.size, 0U);
}

TEST(PairChecksum, covers_part_and_both_layouts_lower_node_first) {
  std::array<std::uint8_t, 12> bytes{};
  ByteWriter out(bytes);
  out.put(0x01020304, 4);
  out.put(0x11121314, 4);
  out.put(0x21222324, 4);
  EXPECT_EQ(pair_crc_of(0x01020304, {2, 0x11121314}, {3, 0x21222324}), crc_of<Crc16>(bytes));
  EXPECT_EQ(pair_crc_of(0x01020304, {3, 0x21222324}, {2, 0x11121314}), crc_of<Crc16>(bytes));
  EXPECT_EQ(pair_crc_of(0x01020304, {2, 0x11121314}, {2, 0x21222324}), crc_of<Crc16>(bytes)) << "as given";
}

TEST(Admission, looks_at_every_peer_and_at_the_force_only_of_grippers) {
  const LayoutTarget target{.node = 2, .kit_id = 1, .f_hardware_dn = 1400, .f_uncertainty_dn = 120};
  Layout layout = with_pins(2, 2);
  layout.peer_count = 2;
  const PairSide own{2, layout_crc_of(layout)};
  layout.peers[0] = {1, 7, 300, pair_crc_of(layout.part_id, own, {1, 7})};
  layout.peers[1] = {3, 8, 300, pair_crc_of(layout.part_id, own, {3, 8})};
  EXPECT_EQ(admissible(layout, target), TransferStatus::Ok);
  Layout wrong = layout;
  wrong.peers[1].pair_crc ^= 1U;
  EXPECT_EQ(admissible(wrong, target), TransferStatus::PairChecksum);
  wrong.peer_count = 1;
  EXPECT_EQ(admissible(wrong, target), TransferStatus::Ok);
  EXPECT_EQ(admissible(pallet(2), {.node = 2, .node_class = NodeClass::Passive, .kit_id = 1}),
            TransferStatus::Ok);
  layout.peer_count = 0;
  layout.f_limit_dn = 640;
  EXPECT_EQ(admissible(layout, target), TransferStatus::Ok) << "400 + 2 x 120";
  layout.f_limit_dn = 639;
  EXPECT_EQ(admissible(layout, target), TransferStatus::ForceWindow);
  EXPECT_EQ(LayoutTarget{}.node, 0);
  EXPECT_EQ(LayoutTarget{}.kit_id, 0);
  EXPECT_EQ(LayoutTarget{}.f_hardware_dn, 0);
  EXPECT_EQ(LayoutTarget{}.f_uncertainty_dn, 0);
  EXPECT_EQ(LayoutTarget{}.node_class, NodeClass::Gripper);
}

TEST(Ids, take_every_hexadecimal_digit_of_either_case_and_no_other_character) {
  const auto kit = [](const std::string& hex) { return kit_id_of(hex); };
  EXPECT_EQ(kit("0009"), 0x0009);
  EXPECT_EQ(kit("19af"), 0x19AF);
  EXPECT_EQ(kit("19AF"), 0x19AF);
  EXPECT_EQ(kit("beef0"), 0xBEEF);
  EXPECT_EQ(kit("bee"), 0);
  for (const char strange : {'/', ':', '@', 'G', '`', 'g', ' ', '\0', '~'}) {
    EXPECT_EQ(kit(std::string("111") + strange), 0) << int{strange};
    EXPECT_EQ(kit(strange + std::string("111")), 0) << int{strange};
  }
  EXPECT_EQ(part_id_of(std::string("0123456f")), 0x0123456FU);
  EXPECT_EQ(part_id_of(std::string("0123456")), 0U);
}

TEST(Forces, of_the_record_are_cut_to_what_it_can_say) {
  EXPECT_EQ(requirement_dn(0), 0);
  EXPECT_EQ(requirement_dn(1), 1);
  EXPECT_EQ(requirement_dn(100'000), 1);
  EXPECT_EQ(requirement_dn(100'001), 2);
  EXPECT_EQ(requirement_dn(65535LL * 100'000), 65535);
  EXPECT_EQ(requirement_dn(65535LL * 100'000 + 1), 65535);
  EXPECT_EQ(requirement_dn(-1'000'000), 0);
  EXPECT_EQ(limit_dn(-1), 0);
  EXPECT_EQ(limit_dn(-100'000), 0);
  EXPECT_EQ(limit_dn(99'999), 0);
  EXPECT_EQ(limit_dn(100'000), 1);
  EXPECT_EQ(limit_dn(65536LL * 100'000), 65535);
  EXPECT_EQ(layout_requirement_dn(240, 120), 240);
  EXPECT_EQ(layout_requirement_dn(239, 120), 240);
  EXPECT_EQ(layout_requirement_dn(0, 32767), 65534);
  EXPECT_EQ(layout_requirement_dn(0, 32768), 65535);
  EXPECT_EQ(layout_requirement_dn(0, 65535), 65535);
}

TEST(Limits, of_the_record_are_those_of_the_specification) {
  EXPECT_EQ(kMaxPins, 16U);
  EXPECT_EQ(kMaxPeers, 4U);
  EXPECT_EQ(kMaxLayoutBytes, 256U);
  EXPECT_EQ(kMaxForce_dn, 2500);
  EXPECT_EQ(kMaxSeparation_10um, 20400);
}

}  // namespace
}  // namespace pinjaw::wire

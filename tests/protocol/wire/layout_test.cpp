// Promises: TRANSFER, I8.
#include "protocol/wire/layout.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string_view>
#include <vector>

#include "protocol/wire/bits.hpp"
#include "protocol/wire/crc.hpp"

namespace pinjaw::wire {
namespace {

constexpr std::uint8_t kNode = 2;

Layout sample() {
  Layout layout{.kit_id = 0xACC1,
                .part_id = 0xDEADBEEF,
                .grid_pitch_nm = 11'112'500,
                .pin_diameter_nm = 4'762'500,
                .pin_count = 4,
                .separation_open_10um = 6000,
                .separation_contact_10um = 3120,
                .separation_tolerance_10um = 50,
                .f_light_dn = 120,
                .f_required_dn = 771,
                .f_limit_dn = 1400,
                .slip_tolerance_um = 200,
                .stable_ms = 150,
                .peer_count = 2};
  layout.pins[0] = {Jaw::Left, 0, 3, 1650};
  layout.pins[1] = {Jaw::Left, 1, 5, 1700};
  layout.pins[2] = {Jaw::Right, 0, 2, 1650};
  layout.pins[3] = {Jaw::Right, 0, 6, 1800};
  const PairSide own{kNode, layout_crc_of(layout)};
  layout.peers[0] = {1, 0x11112222, 300, pair_crc_of(layout.part_id, own, {1, 0x11112222})};
  layout.peers[1] = {3, 0x33334444, 0, pair_crc_of(layout.part_id, own, {3, 0x33334444})};
  return layout;
}

Layout passive() {
  Layout layout = sample();
  layout.node_class = NodeClass::Passive;
  layout.passive = true;
  layout.pin_count = 3;
  for (LayoutPin& pin : layout.pins) pin.jaw = Jaw::Left;
  layout.f_light_dn = layout.f_required_dn = layout.f_limit_dn = 0;
  layout.separation_open_10um = layout.separation_contact_10um = 0;
  layout.peer_count = 0;
  return layout;
}

LayoutTarget target() {
  return {.node = kNode, .kit_id = 0xACC1, .f_hardware_dn = 1400, .f_uncertainty_dn = 120};
}

TransferStatus decoded(const Layout& layout) {
  const EncodedLayout encoded = encode(layout);
  const auto result = decode_layout(encoded.span());
  return result ? TransferStatus::Ok : result.error();
}

TEST(LayoutRecord, comes_back_as_it_was_sent) {
  for (const Layout& layout : {sample(), passive()}) {
    const EncodedLayout encoded = encode(layout);
    const auto back = decode_layout(encoded.span());
    ASSERT_TRUE(back.has_value()) << to_string(back.error());
    const EncodedLayout again = encode(*back);
    EXPECT_EQ(again.size, encoded.size);
    EXPECT_EQ(again.bytes, encoded.bytes);
  }
  EXPECT_EQ(*decode_layout(encode(sample()).span()), sample());
  EXPECT_EQ(encode(sample()).size, 21U + 4 * 6 + 17 + 4 + 1 + 2 * 9 + 4);
}

TEST(LayoutRecord, with_most_pins_and_peers_fits_one_transfer) {
  Layout layout = sample();
  layout.pin_count = kMaxPins;
  layout.peer_count = kMaxPeers;
  EXPECT_LE(encode(layout).size + kResponseHeader, kMaxLayoutBytes);
}

TEST(LayoutRecord, cut_or_lengthened_anywhere_is_refused) {
  const EncodedLayout encoded = encode(sample());
  for (std::size_t size = 0; size < encoded.size; ++size) {
    const auto result = decode_layout(encoded.span().first(size));
    ASSERT_FALSE(result.has_value()) << size;
    EXPECT_EQ(result.error(), TransferStatus::Length) << size;
  }
  EXPECT_EQ(decode_layout(std::span(encoded.bytes).first(encoded.size + 1)).error(), TransferStatus::Length);
}

TEST(LayoutRecord, with_any_one_or_two_bits_flipped_is_refused) {
  const EncodedLayout good = encode(sample());
  for (std::size_t a = 0; a < good.size * 8; ++a) {
    EncodedLayout bad = good;
    bad.bytes[a / 8] = static_cast<std::uint8_t>(bad.bytes[a / 8] ^ (1U << a % 8));
    ASSERT_FALSE(decode_layout(bad.span()).has_value()) << a;
    for (std::size_t b = 0; b < a; ++b) {
      EncodedLayout worse = bad;
      worse.bytes[b / 8] = static_cast<std::uint8_t>(worse.bytes[b / 8] ^ (1U << b % 8));
      ASSERT_FALSE(decode_layout(worse.span()).has_value()) << a << ' ' << b;
    }
  }
}

TEST(LayoutRecord, of_random_bytes_is_refused) {
  std::mt19937_64 engine(11);
  for (int i = 0; i < 100'000; ++i) {
    std::vector<std::uint8_t> bytes(engine() % 257);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(engine());
    if (bytes.size() > 22) {  // let the readers behind magic and schema see the noise
      const EncodedLayout good = encode(sample());
      std::copy_n(good.bytes.begin(), 5 + engine() % 17, bytes.begin());
    }
    ASSERT_FALSE(decode_layout(bytes).has_value());
  }
}

struct Mistake {
  TransferStatus status;
  std::function<void(Layout&)> make;
};

TEST(LayoutRecord, with_a_mistake_in_it_is_refused_and_the_mistake_named) {
  const std::vector<Mistake> mistakes = {
      {TransferStatus::PinCount, [](Layout& l) { l.pin_count = 0; }},
      {TransferStatus::Pin, [](Layout& l) { l.pins[1].column = -1; }},
      {TransferStatus::Pin, [](Layout& l) { l.pins[1].row = -1; }},
      {TransferStatus::Pin, [](Layout& l) { l.pins[1].length_10um = 0; }},
      {TransferStatus::DuplicateHole, [](Layout& l) { l.pins[1] = l.pins[0]; }},
      {TransferStatus::JawWithoutPins, [](Layout& l) { l.pin_count = 2; }},
      {TransferStatus::Separation, [](Layout& l) { l.separation_open_10um = 3170; }},
      {TransferStatus::Separation, [](Layout& l) { l.separation_open_10um = 20401; }},
      {TransferStatus::LightForce, [](Layout& l) { l.f_light_dn = 771; }},
      {TransferStatus::LightForce, [](Layout& l) { l.f_light_dn = 0; }},
      {TransferStatus::ForceWindow, [](Layout& l) { l.f_limit_dn = 770; }},
      {TransferStatus::ForceOverHardware, [](Layout& l) { l.f_limit_dn = 2501; }},
      {TransferStatus::Timing, [](Layout& l) { l.stable_ms = 0; }},
      {TransferStatus::Timing, [](Layout& l) { l.slip_tolerance_um = 0; }},
      {TransferStatus::PassiveFields, [](Layout& l) { l.passive = true; }},
      {TransferStatus::Peers, [](Layout& l) { l.peers[0].node = 0; }},
      {TransferStatus::Peers, [](Layout& l) { l.peers[0].node = 15; }},
      {TransferStatus::Peers, [](Layout& l) { l.peers[0].node = l.peers[1].node; }},
  };
  for (const Mistake& mistake : mistakes) {
    Layout layout = sample();
    mistake.make(layout);
    EXPECT_EQ(decoded(layout), mistake.status) << to_string(mistake.status);
  }
}

TEST(LayoutRecord, of_a_passive_station_has_one_jaw_and_no_force) {
  EXPECT_EQ(decoded(passive()), TransferStatus::Ok);
  Layout layout = passive();
  layout.f_required_dn = 1;
  EXPECT_EQ(decoded(layout), TransferStatus::PassiveFields);
  layout = passive();
  layout.pins[0].jaw = Jaw::Right;
  EXPECT_EQ(decoded(layout), TransferStatus::PassiveFields);
}

/// Puts `value` at `offset` and makes both checksums right again.
std::vector<std::uint8_t> patched(std::size_t offset, std::uint8_t value) {
  const EncodedLayout good = encode(sample());
  std::vector<std::uint8_t> bytes(good.span().begin(), good.span().end());
  bytes[offset] = value;
  const std::size_t body = 21 + 4 * 6 + 17;
  const auto seal = [&bytes](std::size_t begin, std::size_t end) {
    ByteWriter(std::span(bytes).subspan(end, 4))
        .put(crc_of<Crc32>(std::span(bytes).subspan(begin, end - begin)), 4);
  };
  seal(0, body);
  seal(body + 4, bytes.size() - 4);
  return bytes;
}

TEST(LayoutRecord, of_another_format_is_refused) {
  EXPECT_EQ(decode_layout(patched(0, 'X')).error(), TransferStatus::Magic);
  EXPECT_EQ(decode_layout(patched(4, 2)).error(), TransferStatus::Schema);
  EXPECT_EQ(decode_layout(patched(5, 0)).error(), TransferStatus::NodeClass);
  EXPECT_EQ(decode_layout(patched(5, 3)).error(), TransferStatus::NodeClass);
  EXPECT_EQ(decode_layout(patched(20, 17)).error(), TransferStatus::PinCount);
  EXPECT_EQ(decode_layout(patched(21, 2)).error(), TransferStatus::Pin) << "jaw";
  EXPECT_EQ(decode_layout(patched(24, 1)).error(), TransferStatus::Pin) << "kind";
  EXPECT_EQ(decode_layout(patched(61, 2)).error(), TransferStatus::PassiveFields);
  EXPECT_EQ(decode_layout(patched(66, 5)).error(), TransferStatus::Peers);
}

TEST(LayoutRecord, is_admitted_by_the_controller_it_was_made_for) {
  EXPECT_EQ(admissible(sample(), target()), TransferStatus::Ok);
}

TEST(LayoutRecord, for_another_controller_is_refused) {
  LayoutTarget other = target();
  other.kit_id = 1;
  EXPECT_EQ(admissible(sample(), other), TransferStatus::Kit);
  other = target();
  other.node_class = NodeClass::Passive;
  EXPECT_EQ(admissible(sample(), other), TransferStatus::NodeClass);
  other = target();
  other.node = 1;
  EXPECT_EQ(admissible(sample(), other), TransferStatus::Peers) << "it names itself";
  other.node = 4;
  EXPECT_EQ(admissible(sample(), other), TransferStatus::PairChecksum);
}

TEST(LayoutRecord, is_refused_where_force_would_exceed_a_limit) {
  LayoutTarget weak = target();
  weak.f_hardware_dn = 1399;
  EXPECT_EQ(admissible(sample(), weak), TransferStatus::ForceOverHardware);
  LayoutTarget vague = target();
  vague.f_uncertainty_dn = 314;
  EXPECT_EQ(admissible(sample(), vague), TransferStatus::Ok) << "771 + 2 x 314 = 1399";
  vague.f_uncertainty_dn = 315;
  EXPECT_EQ(admissible(sample(), vague), TransferStatus::ForceWindow);
  EXPECT_TRUE(is_force_refusal(TransferStatus::ForceWindow));
  EXPECT_FALSE(is_force_refusal(TransferStatus::Kit));
}

TEST(LayoutRecord, names_its_peers_without_changing_its_own_checksum) {
  Layout layout = sample();
  const std::uint32_t crc = layout_crc_of(layout);
  layout.peers[0].layout_crc = 1;
  layout.peer_count = 1;
  EXPECT_EQ(layout_crc_of(layout), crc);
  layout.f_required_dn += 1;
  EXPECT_NE(layout_crc_of(layout), crc);
}

TEST(PairChecksum, is_the_same_from_both_sides_and_no_other) {
  const PairSide arm{1, 0x11};
  const PairSide pedestal{2, 0x22};
  EXPECT_EQ(pair_crc_of(7, arm, pedestal), pair_crc_of(7, pedestal, arm));
  EXPECT_NE(pair_crc_of(7, arm, pedestal), pair_crc_of(8, arm, pedestal));
  EXPECT_NE(pair_crc_of(7, arm, pedestal), pair_crc_of(7, {1, 0x22}, {2, 0x11}));
}

TEST(Ids, are_the_first_bits_of_the_sha256) {
  constexpr std::string_view kHash = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  EXPECT_EQ(part_id_of(kHash), 0xBA7816BFU);
  EXPECT_EQ(kit_id_of(kHash), 0xBA78);
  EXPECT_EQ(part_id_of(std::string_view("ba78")), 0U);
  EXPECT_EQ(kit_id_of(std::string_view("xyzw")), 0);
}

TEST(Forces, round_to_the_safe_side) {
  EXPECT_EQ(requirement_dn(77'100'000), 771);
  EXPECT_EQ(requirement_dn(77'100'001), 772);
  EXPECT_EQ(limit_dn(139'999'999), 1399);
  EXPECT_EQ(limit_dn(140'000'000), 1400);
  EXPECT_EQ(requirement_dn(-5), 0);
  EXPECT_EQ(requirement_dn(std::int64_t{1} << 60), 65535);
  EXPECT_EQ(layout_requirement_dn(100, 120), 240);
  EXPECT_EQ(layout_requirement_dn(771, 120), 771);
}

}  // namespace
}  // namespace pinjaw::wire

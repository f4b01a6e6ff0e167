#pragma once

#include <cstdint>
#include <string_view>

#include "protocol/wire/aes.hpp"
#include "protocol/wire/codec.hpp"
#include "protocol/wire/layout.hpp"
#include "protocol/wire/secured_link.hpp"
#include "protocol/wire/table.hpp"

/// What the compiler makes of the tables, checked by the compiler: tests/mutation/mutation.py has it read
/// this file by itself.
namespace pinjaw::wire::testing {

template <class Crc>
constexpr auto check_value_of(std::string_view text) {
  Crc crc;
  for (const char c : text) crc.add(static_cast<std::uint8_t>(c));
  return crc.value();
}

static_assert(check_value_of<Crc8>("123456789") == 0xDF);
static_assert(check_value_of<Crc16>("123456789") == 0xC2B7);
static_assert(check_value_of<Crc32>("123456789") == 0xCBF43926);

/// The checksum of each single byte, by long division.
template <class Crc, class Rest>
constexpr bool divides(Rest polynomial, Rest first, bool reflected) {
  constexpr unsigned kBits = sizeof(Rest) * 8;
  for (unsigned byte = 0; byte < 256; ++byte) {
    Rest rest =
        static_cast<Rest>(first ^ (reflected ? Rest(byte) : static_cast<Rest>(Rest(byte) << (kBits - 8))));
    for (int bit = 0; bit < 8; ++bit) {
      const bool out = reflected ? (rest & 1U) != 0 : (rest >> (kBits - 1)) != 0;
      rest = static_cast<Rest>(reflected ? rest >> 1 : rest << 1);
      if (out) rest = static_cast<Rest>(rest ^ polynomial);
    }
    Crc crc;
    crc.add(static_cast<std::uint8_t>(byte));
    if (crc.value() != static_cast<Rest>(~rest)) return false;
  }
  return true;
}
static_assert(divides<Crc8, std::uint8_t>(0x2F, 0xFF, false));
static_assert(divides<Crc16, std::uint16_t>(0x3D65, 0, false));
static_assert(divides<Crc32, std::uint32_t>(0xEDB88320, 0xFFFFFFFF, true));

/// FIPS 197, appendix C.1: the S-box that the compiler made.
constexpr Key kCounted{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
constexpr AesBlock kPlain{0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77,
                          0x88, 0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF};
static_assert(aes128(kCounted, kPlain) == AesBlock{0x69, 0xC4, 0xE0, 0xD8, 0x6A, 0x7B, 0x04, 0x30, 0xD8, 0xCD,
                                                   0xB7, 0x80, 0x70, 0xB4, 0xC5, 0x5A});

static_assert(detail::same_text("", "") && detail::same_text("ab", "ab"));
static_assert(!detail::same_text("ab", "abc") && !detail::same_text("abc", "ab"));
static_assert(!detail::same_text("ab", "ac") && !detail::same_text("ab", "bb") &&
              !detail::same_text("", "a"));

constexpr ValueName kThirtyOne[] = {{0, "NOUGHT"}, {31, "LAST"}};
constexpr ValueName kThirtyTwo[] = {{0, "NOUGHT"}, {32, "PAST"}};
static_assert(bits_of(kThirtyOne) == 0x80000001 && bits_of(kThirtyTwo) == 0 && bits_of({}) == 0);
static_assert(bits_of(kStateNames) == 0xFFFF && bits_of(kFactNames) == 0x803F);

/// The nodes that may say, or be told, a message: 1 to 14; anyone a GLOBAL_HOLD; the host alone its own.
constexpr bool nodes_are_those_of_the_catalogue() {
  for (const MessageSpec& spec : kMessages) {
    const bool any = spec.type == MessageType::GlobalHold;
    const bool host = spec.type == MessageType::HostHeartbeat || spec.type == MessageType::Time;
    for (std::uint8_t node = 0; node < 18; ++node) {
      const bool legal = any ? node <= 15 : host ? node == 0 : node >= 1 && node <= 14;
      if (node_is_legal(spec, node) != legal) return false;
      if (node < 16 && (detail::address_of(spec.type).legal_nodes >> node & 1U) != (legal ? 1U : 0U))
        return false;
    }
    if (detail::address_of(spec.type).base_id != spec.base_id) return false;
    if (detail::address_of(spec.type).protection != spec.protection) return false;
  }
  return true;
}
static_assert(nodes_are_those_of_the_catalogue());

constexpr FieldSpec kEmptyField{};
static_assert(kEmptyField.start == 0 && kEmptyField.length == 0 && !kEmptyField.all_ones_is_unknown);
static_assert(kEmptyField.raw_maximum == 0 && kEmptyField.presence == Presence::Always &&
              kEmptyField.selector == 0);
static_assert(kEmptyField.factor.numerator == 1 && kEmptyField.factor.denominator == 1 &&
              kEmptyField.value_bits == 0);
static_assert(ValueName{}.value == 0 && PairSide{}.node == 0 && PairSide{}.layout_crc == 0);
static_assert(MessageSpec{}.base_id == 0 && MessageSpec{}.per_node && MessageSpec{}.period_ms == 0);
static_assert(detail::Address{}.base_id == 0 && detail::Address{}.legal_nodes == 0);

static_assert(parse<Force>(pack(Force{.f_set_dn = 771}, {.node = 3}))->message == Force{.f_set_dn = 771});

static_assert(Synchronisation{}.source == 0 && Synchronisation{}.receiver == 15 &&
              Synchronisation{}.number == 0);
static_assert(ones(0) == 0 && ones(1) == 1 && ones(63) == ~std::uint64_t{0} >> 1 &&
              ones(64) == ~std::uint64_t{0});
static_assert(!HostHeartbeat{.permit = 0xFFFF}.permits(0));

constexpr FieldSpec kNibble{.name = "NIBBLE", .start = 4, .length = 4, .raw_maximum = 9};
constexpr FieldSpec kKnown{.name = "KNOWN", .start = 8, .length = 8};
constexpr FieldSpec kUnknown{.name = "UNKNOWN", .start = 8, .length = 8, .all_ones_is_unknown = true};
constexpr FieldSpec kNamed{.name = "NAMED", .start = 8, .length = 8, .values = kThirtyOne};
static_assert(kNibble.largest() == 9 && kKnown.largest() == 255 && kUnknown.largest() == 254);
static_assert(kNibble.mask() == 0xF0 && kKnown.mask() == 0xFF00);
static_assert(kNibble.admits(9) && !kNibble.admits(10) && !kNibble.admits(15));
static_assert(kKnown.admits(255) && kUnknown.admits(254) && kUnknown.admits(255) && !kUnknown.admits(256));
static_assert(!kKnown.admits(256));
static_assert(kNamed.admits(0) && kNamed.admits(31) && !kNamed.admits(1) && !kNamed.admits(32) &&
              !kNamed.admits(300));

}  // namespace pinjaw::wire::testing

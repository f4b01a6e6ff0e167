#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// AES-128 (FIPS 197), encryption alone: a CMAC needs no more. One table of 256 bytes, no state but the key:
/// the round keys are made as they are used.
///
/// On a microcontroller without a data cache every look-up takes the same time and there is no branch that
/// depends on the key, so nothing is told by how long it takes. On a computer with caches the look-ups can be
/// watched by a program that runs on the same machine; who runs one there can read the key file anyway.
namespace pinjaw::wire {

using Key = std::array<std::uint8_t, 16>;
using AesBlock = std::array<std::uint8_t, 16>;

namespace detail {

/// Twice `x` in GF(2^8).
constexpr std::uint8_t doubled(std::uint8_t x) {
  return static_cast<std::uint8_t>((x << 1) ^ ((x >> 7) * 0x1B));
}

/// The S-box (FIPS 197, 5.1.1): the inverse in GF(2^8), then the affine map. `p` runs through the powers of 3
/// and `q` through those of its inverse.
constexpr std::array<std::uint8_t, 256> aes_s_box() {
  std::array<std::uint8_t, 256> box{};
  const auto rotated = [](std::uint8_t x, int by) {
    return static_cast<std::uint8_t>((x << by) | (x >> (8 - by)));
  };
  std::uint8_t p = 1;
  std::uint8_t q = 1;
  do {
    p = static_cast<std::uint8_t>(p ^ doubled(p));
    q = static_cast<std::uint8_t>(q ^ (q << 1));
    q = static_cast<std::uint8_t>(q ^ (q << 2));
    q = static_cast<std::uint8_t>(q ^ (q << 4));
    if ((q & 0x80U) != 0) q ^= 0x09U;
    box[p] =
        static_cast<std::uint8_t>(q ^ rotated(q, 1) ^ rotated(q, 2) ^ rotated(q, 3) ^ rotated(q, 4) ^ 0x63);
  } while (p != 1);
  box[0] = 0x63;
  return box;
}

inline constexpr auto kSBox = aes_s_box();

/// The round key after `key`; `round` is its round constant.
constexpr void next_round_key(Key& key, std::uint8_t round) {
  for (std::size_t i = 0; i < 4; ++i) key[i] ^= kSBox[key[12 + (i + 1) % 4]];
  key[0] ^= round;
  for (std::size_t i = 4; i < key.size(); ++i) key[i] ^= key[i - 4];
}

constexpr void add_key(AesBlock& block, const Key& key) {
  for (std::size_t i = 0; i < block.size(); ++i) block[i] ^= key[i];
}

/// SubBytes and ShiftRows: row r of the four by four bytes, stored by columns, moves r places to the left.
constexpr AesBlock substituted_and_shifted(const AesBlock& block) {
  AesBlock out{};
  for (std::size_t i = 0; i < block.size(); ++i) out[i] = kSBox[block[(i + 4 * (i % 4)) % 16]];
  return out;
}

constexpr void mix_columns(AesBlock& block) {
  for (std::size_t column = 0; column < block.size(); column += 4) {
    const std::uint8_t first = block[column];
    const auto all =
        static_cast<std::uint8_t>(first ^ block[column + 1] ^ block[column + 2] ^ block[column + 3]);
    for (std::size_t row = 0; row < 4; ++row) {
      const std::uint8_t below = row == 3 ? first : block[column + row + 1];
      block[column + row] ^= static_cast<std::uint8_t>(all ^ doubled(block[column + row] ^ below));
    }
  }
}

}  // namespace detail

/// Encrypts `block` with `key`, in place.
constexpr void encrypt(Key key, AesBlock& block) {
  constexpr int kRounds = 10;
  std::uint8_t round_constant = 1;
  detail::add_key(block, key);
  for (int round = 1; round <= kRounds; ++round) {
    block = detail::substituted_and_shifted(block);
    if (round < kRounds) detail::mix_columns(block);
    detail::next_round_key(key, round_constant);
    round_constant = detail::doubled(round_constant);
    detail::add_key(block, key);
  }
}

/// `block` encrypted with `key`.
constexpr AesBlock aes128(const Key& key, AesBlock block) {
  encrypt(key, block);
  return block;
}

}  // namespace pinjaw::wire

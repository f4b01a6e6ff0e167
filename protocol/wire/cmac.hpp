#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/wire/aes.hpp"

namespace pinjaw::wire {

namespace detail {

/// A CMAC's subkey from L or from the one before (RFC 4493, 2.3): twice the block in GF(2^128).
constexpr void to_next_subkey(AesBlock& block) {
  const unsigned carried_out = block.front() >> 7;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const unsigned carry = i + 1 < block.size() ? block[i + 1] >> 7 : 0U;
    block[i] = static_cast<std::uint8_t>((unsigned{block[i]} << 1U) | carry);
  }
  block.back() ^= static_cast<std::uint8_t>(carried_out * 0x87);
}

}  // namespace detail

/// The AES-128 CMAC of `message` (RFC 4493), first byte first; a shorter one is its first bytes.
constexpr AesBlock cmac(const Key& key, std::span<const std::uint8_t> message) {
  AesBlock subkey{};
  encrypt(key, subkey);
  detail::to_next_subkey(subkey);
  AesBlock chain{};
  std::size_t at = 0;
  for (; message.size() - at > chain.size(); at += chain.size()) {
    for (std::size_t i = 0; i < chain.size(); ++i) chain[i] ^= message[at + i];
    encrypt(key, chain);
  }
  const std::size_t left = message.size() - at;
  for (std::size_t i = 0; i < left; ++i) chain[i] ^= message[at + i];
  if (left < chain.size()) {
    chain[left] ^= 0x80U;
    detail::to_next_subkey(subkey);
  }
  for (std::size_t i = 0; i < chain.size(); ++i) chain[i] ^= subkey[i];
  encrypt(key, chain);
  return chain;
}

/// What a MAC is of. Each kind of message begins with another byte, so that none is taken for another.
enum class MacOf : std::uint8_t {
  Frame = 0x10,  ///< or-ed with the upper three bits of its id
  Synchronisation = 0x18,
  Command = 0x20,
  Number = 0x21,
};

}  // namespace pinjaw::wire

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace pinjaw::wire {

using Payload = std::array<std::uint8_t, 8>;

/// All ones in the low `length` bits, length 0..64.
constexpr std::uint64_t ones(unsigned length) {
  return length >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << length) - 1;
}

/// The payload as one number, bit k of byte n being bit 8n + k (Intel order, as a DBC's `@1`).
constexpr std::uint64_t to_word(const Payload& payload) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < payload.size(); ++i) word |= std::uint64_t{payload[i]} << (8 * i);
  return word;
}

constexpr Payload to_payload(std::uint64_t word) {
  Payload payload{};
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::uint8_t>(word >> (8 * i));
  return payload;
}

/// Writes little-endian numbers one after the other; what does not fit is dropped and `overflowed` tells.
class ByteWriter {
 public:
  constexpr explicit ByteWriter(std::span<std::uint8_t> out) : out_(out) {}

  constexpr void put(std::uint64_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) {
      if (used_ < out_.size()) {
        out_[used_++] = static_cast<std::uint8_t>(value >> (8 * i));
      } else {
        overflowed_ = true;
      }
    }
  }
  [[nodiscard]] constexpr std::size_t used() const { return used_; }
  [[nodiscard]] constexpr bool overflowed() const { return overflowed_; }

 private:
  std::span<std::uint8_t> out_;
  std::size_t used_ = 0;
  bool overflowed_ = false;
};

/// Reads little-endian numbers one after the other; past the end it gives 0 and `truncated` tells.
class ByteReader {
 public:
  constexpr explicit ByteReader(std::span<const std::uint8_t> in) : in_(in) {}

  constexpr std::uint32_t take(unsigned bytes) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < bytes; ++i) {
      if (used_ < in_.size()) {
        value |= std::uint32_t{in_[used_++]} << (8 * i);
      } else {
        truncated_ = true;
      }
    }
    return truncated_ ? 0 : value;
  }
  [[nodiscard]] constexpr std::size_t used() const { return used_; }
  [[nodiscard]] constexpr std::size_t left() const { return in_.size() - used_; }
  [[nodiscard]] constexpr bool truncated() const { return truncated_; }

 private:
  std::span<const std::uint8_t> in_;
  std::size_t used_ = 0;
  bool truncated_ = false;
};

}  // namespace pinjaw::wire

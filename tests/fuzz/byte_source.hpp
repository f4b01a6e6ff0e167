#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "protocol/wire/bits.hpp"
#include "protocol/wire/frame.hpp"

namespace pinjaw::fuzz {

/// A fuzzer's bytes as choices, so that what it changes changes what happens and not whether a checksum is
/// right. Past their end every choice is 0.
class ByteSource {
 public:
  explicit ByteSource(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool empty() const { return at_ >= bytes_.size(); }

  std::uint8_t byte() { return empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(bytes_[at_++]); }

  /// A number under `limit`, 1 or more; two bytes of input where it needs them.
  std::uint32_t below(std::size_t limit) {
    std::uint32_t value = byte();
    if (limit > 0x100) value |= std::uint32_t{byte()} << 8;
    if (limit > 0x10000) value |= std::uint32_t{byte()} << 16;
    return static_cast<std::uint32_t>(value % limit);
  }

  wire::Payload payload() {
    wire::Payload data{};
    for (std::uint8_t& each : data) each = byte();
    return data;
  }

  /// Fills `out`; what is missing stays as it is.
  void fill(std::span<std::uint8_t> out) {
    for (std::uint8_t& each : out) {
      if (empty()) return;
      each = byte();
    }
  }

  /// A frame of any form: most are data frames of 8 bytes with their checksum made right.
  wire::Frame frame();

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace pinjaw::fuzz

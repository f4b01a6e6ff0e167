#pragma once

#include <array>
#include <cstdint>

namespace pinjaw::wire {

enum class FrameKind : std::uint8_t {
  Data,
  Remote,
  Error,  ///< the adapter's report of a bus error; `id` holds Linux's error class bits
  Fd,     ///< a CAN FD data frame of 12 bytes: `data`, then `tail`
};

inline constexpr std::uint8_t kFdLength = 12;

/// A CAN frame as it comes off a bus: nothing about it is checked. `parse` turns it into a message, a
/// SecuredLink an FD frame into a classic one.
struct Frame {
  std::uint32_t id = 0;
  FrameKind kind = FrameKind::Data;
  bool extended = false;
  std::uint8_t length = 8;
  std::array<std::uint8_t, 8> data{};
  std::array<std::uint8_t, 4> tail{};  ///< of an FD frame; else 0

  friend constexpr bool operator==(const Frame&, const Frame&) = default;
};

}  // namespace pinjaw::wire

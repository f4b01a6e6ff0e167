#pragma once

#include <cstdint>

/// The nodes of the cell that the tests talk to.
namespace pinjaw::jaw_client {

inline constexpr std::uint8_t kArm = 1;
inline constexpr std::uint8_t kPedestal = 2;
inline constexpr std::uint8_t kPallet = 3;

}  // namespace pinjaw::jaw_client

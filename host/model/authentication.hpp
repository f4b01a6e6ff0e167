#pragma once

#include <array>
#include <cstdint>

namespace pinjaw::model {

/// What hosts and controllers of a cell share so that nobody else can command (docs/authentication.md).
struct Authentication {
  std::array<std::uint8_t, 16> key{};  ///< never to be printed
  bool can_fd = false;                 ///< CAN FD, with a MAC in every frame
};

}  // namespace pinjaw::model

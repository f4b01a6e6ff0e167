#pragma once

#include <cstdint>
#include <span>

#include "firmware_sim/core/config.hpp"
#include "firmware_sim/core/io.hpp"
#include "protocol/wire/layout.hpp"

/// The controllers of the searched cell and what is committed at them.
namespace pinjaw::core::model {

inline constexpr std::uint8_t kArm = 1;
inline constexpr std::uint8_t kPedestal = 2;
inline constexpr std::uint8_t kPallet = 3;
inline constexpr std::uint8_t kMostNodes = 3;

inline constexpr std::uint16_t kOpen_10um = 5000;
inline constexpr std::uint16_t kContact_10um = 3000;
inline constexpr std::uint16_t kRequired_dn = 400;
inline constexpr std::uint16_t kSqueeze_dn = 520;  // F_req + u
inline constexpr std::uint16_t kPermit_dn = 1400;

/// A node's hardware; the pallet is passive. The force ramp takes no time: a slow one is a plant that is
/// late.
Config config_of(std::uint8_t node);

/// The node's layout, which names all other `nodes`. That of `misfit` has pins for another part, which nobody
/// told the others.
wire::Layout layout_of(std::uint8_t node, std::span<const std::uint8_t> nodes, std::uint8_t misfit = 0);

/// The same as non-volatile memory holds it.
LayoutBlob blob_of(const wire::Layout& layout);

}  // namespace pinjaw::core::model

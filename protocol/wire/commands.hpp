#pragma once

#include <cstdint>

#include "protocol/wire/messages.hpp"

/// The commands a host can say; `sequence` and, but for ARM, `session` are the sender's to fill in.
namespace pinjaw::wire {

struct SqueezeForces {
  std::uint16_t set_dn = 0;     ///< to be commanded: F_req + u
  std::uint16_t permit_dn = 0;  ///< never to be exceeded in this session
};

constexpr Command hold_command() {
  return {};
}

/// ARM for the committed layout. The session field carries the host's epoch, so that no two hosts say the
/// same.
constexpr Command arm_command(std::uint32_t layout_crc, std::uint16_t epoch) {
  return {.op = Op::Arm,
          .session = epoch,
          .a = static_cast<std::uint16_t>(layout_crc & 0xFFFU),
          .b = static_cast<std::uint16_t>((layout_crc >> 12) & 0xFFFU)};
}

/// The low 24 bits of the layout's CRC that an ARM names.
constexpr std::uint32_t armed_crc24(const Command& arm) {
  return std::uint32_t{arm.b} << 12 | arm.a;
}

constexpr std::uint32_t crc24(std::uint32_t layout_crc) {
  return layout_crc & 0xFFFFFFU;
}

constexpr Command squeeze_command(SqueezeForces forces) {
  return {.op = Op::Squeeze, .a = forces.set_dn, .b = forces.permit_dn};
}

constexpr SqueezeForces squeeze_forces(const Command& squeeze) {
  return {squeeze.a, squeeze.b};
}

/// OFFER names the receiver, ACCEPT the giver.
constexpr Command offer_command(std::uint8_t receiver) {
  return {.op = Op::Offer, .argument = receiver};
}
constexpr Command accept_command(std::uint8_t giver) {
  return {.op = Op::Accept, .argument = giver};
}

/// DISARM, CLOSE_LIGHT, ABORT, OPEN_EMPTY and CLEAR_FAULT have no arguments.
constexpr Command plain_command(Op op) {
  return {.op = op};
}

/// Step 1 asks for a challenge, which comes as FAULT.ARG of MANUAL_RELEASE with severity INFO.
constexpr Command manual_release_ask() {
  return {.op = Op::ManualRelease, .argument = 1};
}
constexpr Command manual_release_answer(std::uint16_t challenge) {
  return {.op = Op::ManualRelease, .argument = 2, .b = challenge};
}

}  // namespace pinjaw::wire

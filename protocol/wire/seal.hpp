#pragma once

#include <array>
#include <cstdint>

#include "protocol/wire/bits.hpp"
#include "protocol/wire/cmac.hpp"
#include "protocol/wire/messages.hpp"

/// Commands between a host and a controller that share a key (docs/authentication.md). The SESSION field of
/// a sealed command is a MAC over the command and what makes it fresh: the session's number, which a
/// controller never gives twice, and the epoch of the host that arms.
namespace pinjaw::wire {

/// What a command belongs to. An ARM carries the number of the session it will open.
struct Freshness {
  std::uint32_t number = 0;
  std::uint16_t epoch = 0;
  friend constexpr bool operator==(const Freshness&, const Freshness&) = default;
};

/// The first two bytes of the CMAC over everything a command says (its SESSION field excepted), the node and
/// the freshness.
constexpr std::uint16_t command_mac(const Key& key, std::uint8_t node, const Command& command,
                                    Freshness freshness) {
  std::array<std::uint8_t, 14> message{};
  ByteWriter out(message);
  out.put(static_cast<std::uint8_t>(MacOf::Command), 1);
  out.put(node, 1);
  out.put(command.sequence, 1);
  out.put(static_cast<unsigned>(command.op) | unsigned{command.argument} << 4, 1);
  out.put(command.a, 2);
  out.put(command.b, 2);
  out.put(freshness.number, 4);
  out.put(freshness.epoch, 2);
  const AesBlock mac = cmac(key, message);
  return static_cast<std::uint16_t>(mac[0] << 8 | mac[1]);
}

constexpr Command sealed(const Key& key, std::uint8_t node, Command command, Freshness freshness) {
  command.session = command_mac(key, node, command, freshness);
  return command;
}

constexpr bool seal_is_right(const Key& key, std::uint8_t node, const Command& command, Freshness freshness) {
  return command.session == command_mac(key, node, command, freshness);
}

/// What an ARM's ARG says. A controller with a key is asked for the number of its next session before: in two
/// halves, and for a proof that the answers are its own. Nothing else keeps a host from sealing commands for
/// a number that a forger told it and that is only to come.
enum class ArmStep : std::uint8_t { Open = 0, LowHalf = 1, HighHalf = 2, Proof = 3 };

/// Drawn anew by the host for each time it asks; the question carries it in SESSION, A and B.
struct Nonce {
  std::uint16_t session = 0;
  std::uint16_t a = 0;  ///< 12 bits
  std::uint16_t b = 0;  ///< 12 bits
  friend constexpr bool operator==(const Nonce&, const Nonce&) = default;
};

constexpr Command ask_number(ArmStep step, Nonce nonce) {
  return {.op = Op::Arm,
          .argument = static_cast<std::uint8_t>(step),
          .session = nonce.session,
          .a = nonce.a,
          .b = nonce.b};
}

constexpr Nonce nonce_of(const Command& question) {
  return {question.session, question.a, question.b};
}

/// What ACK.SESSION answers to a question; precondition: one of the three that ask.
constexpr std::uint16_t number_answer(const Key& key, std::uint8_t node, ArmStep step, std::uint32_t number,
                                      Nonce nonce) {
  if (step == ArmStep::LowHalf) return static_cast<std::uint16_t>(number & 0xFFFFU);
  if (step == ArmStep::HighHalf) return static_cast<std::uint16_t>(number >> 16);
  std::array<std::uint8_t, 12> message{};
  ByteWriter out(message);
  out.put(static_cast<std::uint8_t>(MacOf::Number), 1);
  out.put(node, 1);
  out.put(number, 4);
  out.put(nonce.session, 2);
  out.put(nonce.a, 2);
  out.put(nonce.b, 2);
  const AesBlock mac = cmac(key, message);
  return static_cast<std::uint16_t>(mac[0] << 8 | mac[1]);
}

}  // namespace pinjaw::wire

#pragma once

#include <cstdint>
#include <optional>

#include "protocol/wire/messages.hpp"
#include "protocol/wire/seal.hpp"
#include "protocol/wire/session.hpp"

namespace pinjaw::jaw_client {

enum class ChannelState : std::uint8_t {
  Idle,
  Waiting,
  Answered,
  Silent,     ///< no answer to the command and its repeats
  NoSession,  ///< the command needs a session and none is open, or its numbers are used up
  NoKey,      ///< we have a key, and the controller has none
  OtherKey,   ///< the controller could not prove that it knows our key
};

/// Commands to one controller and their answers: sessions, sequence numbers, repeats. One command at a time.
/// With a key, an ARM first asks for the number of the session it will open, and every command is sealed.
class CommandChannel {
 public:
  static constexpr std::int64_t kRepeat_us = 50'000;
  static constexpr int kTries = 8;

  /// What host and controllers share.
  struct Secret {
    wire::Key key{};
    std::uint64_t nonces = 1;  ///< where nonces begin: drawn anew by each start of a host
  };
  /// Before the first command to `node`.
  void share(std::uint8_t node, const Secret& secret);

  /// Numbers `command` and has it sent by the next due().
  void begin(wire::Command command);
  /// The command to send at `now_us`: new, or again after 50 ms without an answer, with the same number.
  std::optional<wire::Command> due(std::int64_t now_us);
  /// Takes an answer; one to another command is ignored.
  void take(const wire::Acknowledge& answer);

  [[nodiscard]] ChannelState state() const { return state_; }
  /// Precondition: state() is Answered.
  [[nodiscard]] const wire::Acknowledge& answer() const { return answer_; }
  [[nodiscard]] bool armed() const { return session_ != 0; }
  [[nodiscard]] bool has_secret() const { return secret_.has_value(); }
  void forget_session() { session_ = 0; }

 private:
  bool number(wire::Command& command);
  void say(const wire::Command& command);
  void ask(wire::ArmStep step);
  void take_number(const wire::Acknowledge& answer);

  ChannelState state_ = ChannelState::Idle;
  wire::Command command_;
  wire::Acknowledge answer_;
  wire::SequenceIssuer issuer_;
  std::uint16_t session_ = 0;
  std::uint8_t free_number_ = 0;  ///< of the next command that needs no session
  int tries_ = 0;
  std::int64_t sent_at_us_ = 0;

  std::optional<Secret> secret_;
  std::uint8_t node_ = 0;
  wire::ArmStep asking_ = wire::ArmStep::Open;
  int unproven_ = 0;           ///< times that a number came with a wrong proof
  wire::Command arm_;          ///< waits for its number
  wire::Nonce nonce_;          ///< of the questions
  std::uint32_t asked_ = 0;    ///< the number, as far as it was answered
  wire::Freshness freshness_;  ///< of the session
};

}  // namespace pinjaw::jaw_client

#pragma once

#include <cstdint>
#include <optional>

#include "protocol/wire/messages.hpp"
#include "protocol/wire/session.hpp"

namespace pinjaw::jaw_client {

enum class ChannelState : std::uint8_t {
  Idle,
  Waiting,
  Answered,
  Silent,     ///< no answer to the command and its repeats
  NoSession,  ///< the command needs a session and none is open, or its numbers are used up
};

/// Commands to one controller and their answers: sessions, sequence numbers, repeats. One command at a time.
class CommandChannel {
 public:
  static constexpr std::int64_t kRepeat_us = 50'000;
  static constexpr int kTries = 8;

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
  void forget_session() { session_ = 0; }

 private:
  bool number(wire::Command& command);

  ChannelState state_ = ChannelState::Idle;
  wire::Command command_;
  wire::Acknowledge answer_;
  wire::SequenceIssuer issuer_;
  std::uint16_t session_ = 0;
  std::uint8_t free_number_ = 0;  ///< of the next command that needs no session
  int tries_ = 0;
  std::int64_t sent_at_us_ = 0;
};

}  // namespace pinjaw::jaw_client

#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "protocol/wire/messages.hpp"

/// Who may command: sessions and sequence numbers. A sequence rises strictly within a session and never
/// wraps.
namespace pinjaw::wire {

inline constexpr std::uint16_t kSequenceEnd = 256;

/// The host's side: numbers for the commands of one session.
class SequenceIssuer {
 public:
  /// Begins with `next`, the NEXT_SEQ of ARM's answer.
  constexpr void begin(std::uint8_t next) { next_ = next; }
  /// Nothing when 255 was used: ARM again.
  constexpr std::optional<std::uint8_t> take() {
    if (next_ >= kSequenceEnd) return std::nullopt;
    return static_cast<std::uint8_t>(next_++);
  }

 private:
  std::uint16_t next_ = 0;
};

/// What a controller makes of a command before it looks at the operation.
enum class Admission : std::uint8_t {
  New,
  Repeated,  ///< the same bytes as the last one: answer the same, do nothing
  NotArmed,
  WrongSession,
  OldSequence,
  UsedUp,  ///< 255 was used: ARM again
};

/// The controller's side. HOLD needs no session and is always new; ARM needs none and opens one.
class CommandGate {
 public:
  [[nodiscard]] constexpr Admission admit(const Command& command) const {
    if (command.op == Op::Hold) return Admission::New;
    if (last_ && *last_ == command) return Admission::Repeated;
    if (command.op == Op::Arm) return Admission::New;
    if (session_ == 0) return Admission::NotArmed;
    if (command.session != session_) return Admission::WrongSession;
    if (next_ >= kSequenceEnd) return Admission::UsedUp;
    if (command.sequence < next_) return Admission::OldSequence;
    return Admission::New;
  }

  /// Keeps a new command and its answer; a repeat of it gets the same answer.
  /// Refused ones of a foreign session must not be kept.
  constexpr void remember(const Command& command, const Acknowledge& answer) {
    last_ = command;
    answer_ = answer;
    next_ = static_cast<std::uint16_t>(command.sequence + 1U);
  }

  /// Opens a session, 1..65535, and with it forgets every older one.
  constexpr void open(std::uint16_t session) { session_ = session; }
  constexpr void close() {
    session_ = 0;
    if (last_ && last_->op == Op::Arm) last_.reset();
  }

  [[nodiscard]] constexpr bool armed() const { return session_ != 0; }
  [[nodiscard]] constexpr std::uint16_t session() const { return session_; }
  [[nodiscard]] constexpr const Acknowledge& last_answer() const { return answer_; }
  /// For ACK.NEXT_SEQ; 255 also when nothing is left.
  [[nodiscard]] constexpr std::uint8_t next_sequence() const {
    return static_cast<std::uint8_t>(std::min<unsigned>(next_, kSequenceEnd - 1));
  }
  friend constexpr bool operator==(const CommandGate&, const CommandGate&) = default;

 private:
  std::uint16_t session_ = 0;
  std::uint16_t next_ = 0;
  std::optional<Command> last_;
  Acknowledge answer_;
};

}  // namespace pinjaw::wire

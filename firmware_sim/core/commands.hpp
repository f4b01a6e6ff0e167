#pragma once

#include "firmware_sim/core/state.hpp"

/// What hosts ask for. Every command is answered; one that is refused changes no output and says why.
namespace pinjaw::core {

inline constexpr std::uint16_t kSessionBlock = 16;  // chosen: one store for so many sessions

struct Answer {
  wire::CommandResult result = wire::CommandResult::Ok;
  wire::Reason reason = wire::Reason::None;
  friend bool operator==(const Answer&, const Answer&) = default;
};

/// What a command would do: the event it raises, unless its answer is other than Ok.
struct Decision {
  Answer answer;
  Event event = Event::CmdHold;
};

/// Judges a command whose session and sequence are right. Changes nothing.
Decision decide(const State& state, const wire::Command& command);

/// How `command` is answered; nothing was done.
wire::Acknowledge acknowledgement(const State& state, const wire::Command& command, const Answer& answer);

/// Judges and carries out a command, and gives its acknowledgement; a repeat of the last command gets the
/// same one and does nothing. With a key, a command without the right MAC goes no further than that.
wire::Acknowledge obey(State& state, const wire::Command& said);

}  // namespace pinjaw::core

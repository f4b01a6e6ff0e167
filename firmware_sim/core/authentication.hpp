#pragma once

#include <cstdint>
#include <optional>

#include "protocol/wire/messages.hpp"
#include "protocol/wire/timing.hpp"

/// Whether whoever commands knows the key (docs/authentication.md). Without a key in the configuration every
/// command passes as it is.
namespace pinjaw::core {

struct Answer;
struct NvmRecord;
struct State;

/// Counts commands with a wrong MAC. At the third, each within a minute of the one before, nothing is judged
/// any more until a minute has passed: whoever guesses has three guesses a minute, each right with 2^-16,
/// however fast he sends. A right command in between forgives nothing, else a host that works would buy him
/// guesses.
class LockOut {
 public:
  static constexpr std::uint8_t kMisses = 3;
  static constexpr std::uint16_t kForgiven_ms = 60000;  // chosen: 65536 guesses take 15 days

  void miss() {
    if (locked()) return;
    ++misses_;
    forgiven_.start(kForgiven_ms);
  }
  void advance(std::uint16_t elapsed_ms) {
    forgiven_.advance(elapsed_ms);
    if (!forgiven_.running()) misses_ = 0;
  }
  [[nodiscard]] bool locked() const { return misses_ >= kMisses; }

 private:
  std::uint8_t misses_ = 0;
  wire::Countdown forgiven_;  ///< since the last miss
};

/// The number of the session that the next ARM opens; its low half, which is never 0, goes on the wire.
std::uint32_t next_session_number(const State& state);

/// Numbers are left to give out. They never begin anew where there is a key.
bool numbers_are_left(const State& state);

/// The answer to an ARM that asks for what a MAC covers; nothing where `said` does not ask. It opens nothing.
std::optional<wire::Acknowledge> answer_question(const State& state, const wire::Command& said);

/// Makes of a command with the right MAC what a host without a key would have said; else tells why it is
/// turned away. Of a wrong MAC one is counted, and the last that may be wrong ends the session.
std::optional<Answer> unseal(State& state, wire::Command& command);

/// Begins the link of a controller on CAN FD with a block of frame numbers that no earlier start was given.
void start_link(State& state, NvmRecord& record);

/// Lets the link hear hosts and the layout's peers, and has the next block of frame numbers stored in time.
void keep_link(State& state);

/// Lets time pass: a lock-out ends.
void advance_lock_out(State& state, std::uint16_t elapsed_ms);

}  // namespace pinjaw::core

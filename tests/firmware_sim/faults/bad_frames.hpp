#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tests/firmware_sim/faults/moments.hpp"

/// Frames that a controller must not act on, made of those that mean something to it, and the oracle of I4:
/// two runs, one of which hears one of them.
namespace pinjaw::core::test {

enum class Badness : std::uint8_t {
  Corrupted,     ///< one to three bits flipped
  Garbled,       ///< random bytes, the checksum wrong
  Misaddressed,  ///< a good frame's bytes under another message's or node's id
  Length,
  Remote,
  Extended,
  Reserved,        ///< a right checksum over a bit or number that means nothing, or another version
  Replayed,        ///< heard before, with a CTR that is not next
  OldCommand,      ///< a command heard before in this or another session
  ForeignSession,  ///< a command of a session that is not this one
  ForeignNode,     ///< facts of a node that no layout names
  ForeignCommand,  ///< another node's command
  ForeignToken,    ///< custody of another token, out of order
};
constexpr int kBadnesses = 13;

/// A number under `limit`; where it comes from (a seed, a fuzzer) is its giver's matter.
using Choose = std::function<std::uint32_t(std::uint32_t limit)>;

struct BadFrame {
  wire::Frame frame;
  int ms = 0;  ///< when it comes
};

constexpr int kLatestBad_ms = 40;

/// One for `scene` of that kind; nothing where what was chosen is none after all (flips that undo each
/// other).
std::optional<BadFrame> bad_frame(const Scene& scene, Badness kind, const Choose& choose);

/// I4: nothing, or a sentence on how the two runs differ.
std::optional<std::string> two_runs_differ(const Scene& scene, const BadFrame& bad);

}  // namespace pinjaw::core::test

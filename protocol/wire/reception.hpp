#pragma once

#include <cstdint>

#include "protocol/wire/timing.hpp"

/// What a receiver keeps of each (message, node) to notice loss, repetition and silence.
namespace pinjaw::wire {

inline constexpr std::uint8_t kCounterModulus = 15;

/// The CTR that follows `counter`.
constexpr std::uint8_t next_counter(std::uint8_t counter) {
  return static_cast<std::uint8_t>((counter + 1U) % kCounterModulus);
}

enum class CounterVerdict : std::uint8_t {
  Qualifying,  ///< in order, but not yet three in a row: do not use
  Qualified,
  Discarded,  ///< repeated or too far ahead: do not use
};

/// Accepts counters that rise by 1 to 3 (two losses); after anything else, and at the start, three in a row
/// are needed. The very first frame counts as the first of three: nothing contradicts it. A single frame out
/// of order does not move the row: what goes on from before it is in order, so that the row is whole again
/// with the third frame. Only where a second one goes on from it does it begin a new row.
class CounterCheck {
 public:
  static constexpr std::uint8_t kLargestStep = 3;
  static constexpr std::uint8_t kInARow = 3;

  /// Precondition: counter 0..14.
  constexpr CounterVerdict accept(std::uint8_t counter) {
    const bool in_order = !heard_ || follows(counter, last_);
    if (!in_order && !(in_a_row_ == 0 && follows(counter, stray_))) {
      in_a_row_ = 0;
      stray_ = counter;
      return CounterVerdict::Discarded;
    }
    heard_ = true;
    stray_ = 0;
    last_ = counter;
    if (in_a_row_ < kInARow) ++in_a_row_;
    return qualified() ? CounterVerdict::Qualified : CounterVerdict::Qualifying;
  }
  [[nodiscard]] constexpr bool qualified() const { return in_a_row_ == kInARow; }
  [[nodiscard]] constexpr bool heard() const { return heard_; }
  friend constexpr bool operator==(const CounterCheck&, const CounterCheck&) = default;

 private:
  static constexpr bool follows(std::uint8_t counter, std::uint8_t last) {
    const unsigned step = (kCounterModulus + unsigned{counter} - last) % kCounterModulus;
    return step >= 1 && step <= kLargestStep;
  }

  std::uint8_t last_ = 0;
  std::uint8_t stray_ = 0;     ///< the last frame's counter where it was out of order
  std::uint8_t in_a_row_ = 0;  ///< 0 after a frame out of order
  bool heard_ = false;
};

}  // namespace pinjaw::wire

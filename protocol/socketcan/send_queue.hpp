#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "protocol/wire/frame.hpp"

namespace pinjaw::socketcan {

/// What a driver did with a frame.
enum class WriteResult : std::uint8_t {
  Taken,
  Full,    ///< ENOBUFS or EAGAIN: the kernel's queue has no room now
  Failed,  ///< it will not take this or any frame
};

/// Frames that the kernel had no room for: few, the most urgent first, and none sent so late that it
/// misleads.
class SendQueue {
 public:
  static constexpr std::size_t kMostFrames = 128;
  static constexpr std::int64_t kStale_us =
      100'000;  ///< twice the slowest heartbeat: older ones say nothing true

  using Writer = std::function<WriteResult(const wire::Frame&)>;

  /// False where too many wait already.
  bool push(const wire::Frame& frame, std::int64_t now_us);
  /// Writes what waits, lowest id first and frames of one id in their order, until the writer is full.
  /// Gives Full while something still waits, and Failed as soon as the writer does.
  WriteResult flush(std::int64_t now_us, const Writer& write);

  /// Drops all that wait.
  void clear();

  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  /// Frames dropped because they had become stale, or by clear().
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct Waiting {
    wire::Frame frame;
    std::int64_t since_us = 0;
  };
  void drop_stale(std::int64_t now_us);

  std::vector<Waiting> waiting_;  ///< by id, then by age
  std::uint64_t dropped_ = 0;
};

}  // namespace pinjaw::socketcan

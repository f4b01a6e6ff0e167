#pragma once

#include <cstdint>

namespace pinjaw::jaw_app {

/// How many steps of 1 ms are due at a time: all that were missed, so that simulated time keeps up with the
/// clock, but after a pause of more than kMost_ms the rest is given up and counted.
class Pace {
 public:
  explicit Pace(std::int64_t start_ns) : next_ns_(start_ns) {}

  /// Steps to do now; the next is due at `next_ns`.
  int due(std::int64_t now_ns);

  [[nodiscard]] std::int64_t next_ns() const { return next_ns_; }
  [[nodiscard]] std::int64_t given_up_ms() const { return given_up_ms_; }

  static constexpr std::int64_t kStep_ns = 1'000'000;
  static constexpr std::int64_t kMost_ms =
      1000;  // chosen: a stopped process comes back, a sleeping laptop does not

 private:
  std::int64_t next_ns_;
  std::int64_t given_up_ms_ = 0;
};

}  // namespace pinjaw::jaw_app

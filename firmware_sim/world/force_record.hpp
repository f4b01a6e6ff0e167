#pragma once

#include <array>
#include <cstddef>

namespace pinjaw::world {

/// What was seen of one station's true squeeze.
class ForceRecord {
 public:
  /// One millisecond, in which the squeeze was between `least_n` and `most_n`.
  void observe(double least_n, double most_n, double limit_n);
  void clear() { *this = ForceRecord(); }

  [[nodiscard]] double max_n() const { return max_n_; }
  /// Largest squeeze that lasted longer than kSteady_ms.
  [[nodiscard]] double max_steady_n() const { return max_steady_n_; }
  [[nodiscard]] double over_limit_s() const { return over_limit_s_; }

  static constexpr std::size_t kSteady_ms = 20;  // invariant I1: 1.05 of the limit for at most 20 ms

 private:
  double max_n_ = 0;
  double max_steady_n_ = 0;
  double over_limit_s_ = 0;
  std::array<double, kSteady_ms + 1> window_n_{};
  std::size_t next_ = 0;
};

}  // namespace pinjaw::world

#pragma once

#include <cstdint>

namespace pinjaw::base {

/// Seeded random numbers by a fixed algorithm (xoshiro256++, seeded by splitmix64; Blackman and Vigna 2019),
/// so that a seed gives the same sample on every machine and library.
class Random {
 public:
  static constexpr const char* kAlgorithm = "xoshiro256++/splitmix64";

  explicit Random(std::uint64_t seed);

  std::uint64_t bits();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Uniform in [lo, hi).
  double uniform(double lo, double hi);
  /// Standard normal, by Box and Muller.
  double normal();

 private:
  std::uint64_t state_[4];
};

}  // namespace pinjaw::base

#pragma once

#include <cstdint>

namespace pinjaw::plant {

/// Seeded noise by a fixed algorithm (splitmix64, Steele et al. 2014), so that a seed gives the same run
/// everywhere. The plant includes nothing else of the project, so it has its own.
struct Noise {
  std::uint64_t state = 0;

  std::uint64_t bits();
  /// Uniform in [-1, 1).
  double symmetric();
  /// About standard normal: the sum of twelve uniforms less six, never beyond 6.
  double normal();
};

}  // namespace pinjaw::plant

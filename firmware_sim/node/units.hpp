#pragma once

#include <cmath>
#include <cstdint>

/// Between the plant's SI units and the whole numbers that controllers count in.
namespace pinjaw::node {

inline constexpr double kPa_per_mbar = 100.0;

inline std::int32_t whole(double value) {
  return static_cast<std::int32_t>(std::lround(value));
}

}  // namespace pinjaw::node

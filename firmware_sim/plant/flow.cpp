#include "firmware_sim/plant/flow.hpp"

#include <cmath>

namespace pinjaw::plant {
namespace {

constexpr double kLinearRatio = 0.999;  // study: keeps the Euler step stable

/// The elliptic law's factor, 1 when choked.
double shape(double ratio, double critical_ratio) {
  if (ratio <= critical_ratio) return 1.0;
  const double share = (ratio - critical_ratio) / (1.0 - critical_ratio);
  return std::sqrt(1.0 - share * share);
}

}  // namespace

double mass_flow(const Restriction& line, double from_pa, double to_pa) {
  if (from_pa < to_pa) return -mass_flow(line, to_pa, from_pa);
  if (from_pa <= 0.0) return 0.0;
  const double ratio = to_pa / from_pa;
  const double choked = line.conductance_m3_s_pa * kReferenceDensity * from_pa;
  if (ratio <= kLinearRatio) return choked * shape(ratio, line.critical_ratio);
  return choked * shape(kLinearRatio, line.critical_ratio) * (1.0 - ratio) / (1.0 - kLinearRatio);
}

}  // namespace pinjaw::plant

#include "firmware_sim/plant/parameters.hpp"

namespace pinjaw::plant {
namespace {
constexpr double kOpenAreaShare = 0.85;  // study: the rod takes the rest
constexpr double kReliefShare = 1.07;    // the same: 150 N for 140 N
}  // namespace

Parameters parameters_for(const Sizing& sizing) {
  Parameters parameters;
  parameters.air.close_area_m2 = sizing.max_squeeze_n / kSizingPressure_Pa;
  parameters.air.open_area_m2 = kOpenAreaShare * parameters.air.close_area_m2;
  parameters.air.relief_pa = kReliefShare * kSizingPressure_Pa;
  parameters.jaw.max_separation_m = sizing.max_separation_m;
  parameters.jaw.stroke_m = (sizing.max_separation_m - sizing.min_separation_m) / 2;
  return parameters;
}

}  // namespace pinjaw::plant

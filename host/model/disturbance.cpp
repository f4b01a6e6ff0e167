#include "host/model/disturbance.hpp"

#include <numbers>

namespace pinjaw::model {

double jet_force_n(const Nozzle& nozzle) {
  const double radius_m = nozzle.nozzle_mm / 2000;
  const double area_m2 = std::numbers::pi * radius_m * radius_m;
  const double flow_m3_s = nozzle.flow_l_s / 1000;
  return 2 * nozzle.density_kg_m3 * flow_m3_s * flow_m3_s / area_m2;
}

}  // namespace pinjaw::model

#include "host/planner/loading/covered.hpp"

#include <numeric>

namespace pinjaw::planner {

using geometry::Vector2d;

double sign_of_outwards(model::JawSide jaw) {
  return jaw == model::JawSide::Left ? -1 : 1;
}

geometry::Rectangle covered(const model::JawBody& solid, const ClosedJaw& jaw,
                            const geometry::Interval& opening_mm, double grown_mm) {
  const double inner_mm = jaw.separation_mm / 2 + opening_mm.lo + solid.x_mm.lo;
  const double outer_mm = jaw.separation_mm / 2 + opening_mm.hi + solid.x_mm.hi;
  const geometry::Pose2 X_PG = jaw.part_pose.inverse();
  return {.center_mm = X_PG * Vector2d(sign_of_outwards(jaw.side) * (inner_mm + outer_mm) / 2,
                                       std::midpoint(solid.y_mm.lo, solid.y_mm.hi)),
          .direction = X_PG.turned(Vector2d::UnitX()),
          .half_mm = {(outer_mm - inner_mm) / 2 + grown_mm, solid.y_mm.length() / 2 + grown_mm}};
}

geometry::Slab heights_of(const model::JawBody& solid, double plate_top_mm) {
  constexpr double kResting_mm = 1e-6;
  return {plate_top_mm + solid.z_mm.lo, plate_top_mm + solid.z_mm.hi - kResting_mm};
}

}  // namespace pinjaw::planner

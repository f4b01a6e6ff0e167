#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/model/disturbance.hpp"
#include "host/model/task.hpp"
#include "host/planner/robust/closing.hpp"

/// The squeeze and the place of a design over the ranges of friction, pins, part and air.
namespace pinjaw::planner {

/// What the designs of one plan share.
struct RobustCase {
  const model::Kit& kit;
  const std::vector<model::Feature>& features;  ///< of the turned part, as phase 1 gives them
  geometry::Vector2d centroid_P_mm;             ///< of the turned part
  model::Ranges ranges;
  double friction = 0;  ///< nominal
  model::FrictionModel model = model::FrictionModel::Pyramid;
  std::span<const model::Disturbance> disturbances;
  std::span<const model::Wrench> wrenches;  ///< of the disturbances, turned by the task's side
};

/// One point of the ranges, and what the design needs there.
struct RobustPoint {
  std::optional<double> required_n;  ///< nothing where it fails
  std::string failure;
  std::size_t critical = 0;  ///< disturbance
};

/// The design at one friction and one set of errors: closed anew, then phase 5 on the contacts it then has.
/// Fails where a contact jams or a jaw wedges at the greatest friction of the ranges, where some load cannot
/// be resisted at `friction`, where a foot leaves its feature, and where the pins do not close.
RobustPoint robust_at(const RobustCase& of, const model::Design& design, double friction,
                      const model::PinErrors& errors);

/// How far the part lies off, at the worst corner of the ranges: each closed anew.
struct LocationError {
  double moved_mm = 0;  ///< its centroid, in plan
  double turned_deg = 0;
};
LocationError location_error(const RobustCase& of, const model::Design& design);

/// The worst over the ranges. Friction: exact, at its low end, since a wider cone never needs more squeeze;
/// jams and wedges at its high end. Errors of pins and part: all corners of their ranges and a local search
/// (NLopt's BOBYQA) from the worst of them, so worst_required_n is sampled: something worse may hide between.
/// Never under the nominal squeeze. Location: each corner closed anew (sampled), and a bound.
model::Robust robust_of(const RobustCase& of, const model::Design& design);

}  // namespace pinjaw::planner

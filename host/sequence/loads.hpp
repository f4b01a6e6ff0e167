#pragma once

#include <string>
#include <vector>

#include "host/base/expected.hpp"
#include "host/model/sequence.hpp"
#include "host/planner/plan/scene.hpp"

/// What a run does to the part, as loads over time, and the squeeze that each holder needs against them.
namespace pinjaw::sequence {

/// A wrench on the part (part frame, about its origin) that acts for a while.
struct Load {
  std::string name;
  model::Wrench wrench = model::Wrench::Zero();
  double seconds = 0;
};

/// The part as its loads see it.
struct Carried {
  double mass_kg = 0;
  model::Vector3d centroid_mm = model::Vector3d::Zero();  ///< part frame
  model::Vector3d down = -model::Vector3d::UnitZ();       ///< where gravity pulls, unit, in the part frame
};

/// The weight of the part alone.
model::Wrench weight(const Carried& carried);

/// A linear move along `along` (part frame): it speeds up with the peak, goes, and slows down.
std::vector<Load> loads_of(const model::MoveStep& move, const Carried& carried, const model::Vector3d& along);

/// A turn about the part frame's direction `axis`: the peak acceleration at both stops, either way along the
/// part's z (BB 4.1), and between them gravity as it turns with the station. Ends with gravity turned by the
/// step's angle.
std::vector<Load> loads_of(const model::RotateStep& rotate, const Carried& carried,
                           const model::Vector3d& axis);

/// A jet that wanders over the part: hits drawn with the step's seed, one every 50 ms. Fails where no ray
/// finds the part.
base::Expected<std::vector<Load>> loads_of(const model::SprayStep& spray, const Carried& carried,
                                           const planner::Scene& scene);

/// `down` after the station has turned by `angle_rad` about `axis`, both in the part frame.
model::Vector3d turned_down(const model::Vector3d& down, const model::Vector3d& axis, double angle_rad);

}  // namespace pinjaw::sequence

#pragma once

#include <string>
#include <vector>

#include "host/base/random.hpp"
#include "host/model/disturbance.hpp"
#include "host/planner/force/grasp.hpp"

/// One collection of grasps and loads, run against every solver.
namespace pinjaw::planner::zoo {

enum class Family {
  FormClosed,         ///< two points a pin, strictly planar form-closed: what the planner meets
  Mixed,              ///< form-closed, one or two points a pin
  NotFormClosed,      ///< any four pins: many loads cannot be resisted
  OnePointAPin,       ///< n = 4
  TwoContacts,        ///< rank 5
  NoFriction,         ///< mu = 0: rank 5 at most, most loads infeasible
  LittleFriction,     ///< mu = 1e-4
  HardlyAnyFriction,  ///< mu = 1e-6
  SymmetricBox,       ///< axis loads on a box: ties everywhere
  Doubled,            ///< every contact twice
  Steep,              ///< a normal nearly across the closing axis: negative costs, sometimes unbounded
  NearCoincident,     ///< points of a pin 1e-9 to 1e-6 mm apart
  FarFromOrigin,      ///< the part 2 m from its file's origin
};

std::vector<Family> all_families();
std::string name_of(Family family);

Grasp random_grasp(Family family, base::Random& random);
model::Wrench random_wrench(Family family, const Grasp& grasp, base::Random& random);

}  // namespace pinjaw::planner::zoo

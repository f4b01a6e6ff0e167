#pragma once

#include <string>
#include <vector>

#include "host/geometry/plane.hpp"
#include "host/model/feature.hpp"

namespace pinjaw::model {

struct ProfileEdge {
  geometry::Curve curve;  ///< a segment runs along the loop; an arc is stored counter-clockwise
  bool reversed = false;  ///< the loop runs along the arc clockwise
  bool graspable = true;
};

/// A part without CAD: closed loops extruded along z; outer loop counter-clockwise, holes clockwise, so the
/// material is always on the left of travel.
struct Profile {
  std::string name;
  double thickness_mm = 0;
  std::vector<std::vector<ProfileEdge>> loops;  ///< [0] is the outer loop
};

/// One feature per graspable edge, ids in file order, each reachable over its whole length.
std::vector<Feature> features_of(const Profile& profile);

}  // namespace pinjaw::model

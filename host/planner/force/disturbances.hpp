#pragma once

#include <vector>

#include "host/base/expected.hpp"
#include "host/geometry/surface.hpp"
#include "host/model/task.hpp"

namespace pinjaw::planner {

/// What disturbances act on, in the part frame (before `side` turns it).
struct Body {
  double mass_kg = 0;  ///< above 0 where gravity or an acceleration is named
  geometry::Vector3d centroid_mm = geometry::Vector3d::Zero();
  const geometry::Surface* surface = nullptr;  ///< for spray rays; may be null where no spray is named
};

/// The wrenches of a task, in the part frame about its origin, the sum of `always` added to each.
///
/// Names: the source's name, or its kind; sources that stand for several loads add `[17]` or `[+z]`; equal
/// names are told apart by a number. A spray's sample depends on its seed and the body alone, so stations
/// that name the same spray get the same sample (DESIGN 3.1, 10). With `always` alone, the one disturbance is
/// called `always`. Fails where `always` holds a source of several loads, where a weight is asked of a body
/// without mass, or a spray whose rays do not find the part.
base::Expected<std::vector<model::Disturbance>> disturbances_of(const model::Task& task, const Body& body);

/// One load of a source and the suffix of its name.
struct SprayHit {
  geometry::Vector3d p_mm = geometry::Vector3d::Zero();
  geometry::Vector3d force_n = geometry::Vector3d::Zero();
};

/// Sampled jets: directions uniform on the sphere (or within the cone about `from`), origins uniform over the
/// bounding box's shadow along them, the force into the surface at the first hit along the facet's normal;
/// rays that miss are drawn again (BB 4.1, DESIGN 3.1, 10). Fails where too few rays hit.
base::Expected<std::vector<SprayHit>> spray_hits(const model::Spray& spray, const geometry::Surface& surface);

/// A wrench turned as `side` turns the part: above by pi about y, diag(-1, 1, -1) on force and torque.
model::Wrench turned(const model::Wrench& wrench, model::Side side);

/// The wrenches of a list, each turned: what evaluate() takes.
std::vector<model::Wrench> turned_wrenches(const std::vector<model::Disturbance>& disturbances,
                                           model::Side side);

}  // namespace pinjaw::planner

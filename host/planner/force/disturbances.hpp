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

/// The wrenches of a task, in the part frame about its origin, what acts `always` added to each: where that
/// has several states (gravity in several poses), each of them in turn.
///
/// Names: the source's name, or its kind; sources that stand for several loads add `[17]` or `[+z]`; equal
/// names are told apart by a number; loads that act together are told as `drill[thrust] with gravity[+z]`. A
/// spray's sample depends on its seed and the body alone, so stations that name the same spray get the same
/// sample (DESIGN 3.1, 10). With `always` alone, its states are the disturbances, a single one called
/// `always`. Fails where a weight is asked of a body without mass, a spray's rays do not find the part, or
/// the loads are more than a million.
base::Expected<std::vector<model::Disturbance>> disturbances_of(const model::Task& task, const Body& body);

/// A spray of a task, and everything that may act together with it: one of `with` at a time, its wrench about
/// the part frame's origin, unnamed where it is the only one.
struct Jet {
  std::string name;  ///< as its loads are named, before the bracket
  model::Spray spray;
  std::vector<model::Disturbance> with;
};

/// The sprays of a task, in its order. Fails as disturbances_of() does.
base::Expected<std::vector<Jet>> jets_of(const model::Task& task, const Body& body);

/// Where a jet hits, its force, and where it comes from (unit).
struct SprayHit {
  geometry::Vector3d p_mm = geometry::Vector3d::Zero();
  geometry::Vector3d force_n = geometry::Vector3d::Zero();
  geometry::Vector3d from = geometry::Vector3d::UnitZ();
  int triangle = 0;
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

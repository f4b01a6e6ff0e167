#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/base/expected.hpp"
#include "host/model/disturbance.hpp"
#include "host/planner/force/disturbances.hpp"

/// One source of disturbances as the loads it stands for.
namespace pinjaw::planner {

/// One load of a source: which of them it is (empty where the source has one only), and its wrench about the
/// part frame's origin.
struct SourceLoad {
  std::string label;
  model::Wrench wrench = model::Wrench::Zero();
};

/// The name a source is told by: its own, or its kind.
std::string name_of(const model::SingleSource& source);

/// `name[label]`, or the name alone.
std::string full_name(const std::string& name, const std::string& label);

/// The wrench of a force at a point, about the origin.
model::Wrench force_at(const geometry::Vector3d& p_mm, const geometry::Vector3d& force_n);

/// All loads of a source. Where it stands for a range of loads (a torque up to its peak, a force any way
/// across an axis, a tool anywhere along a straight run), they are the corners of a polyhedron of wrenches
/// around that range: F_sq is convex, so nothing in the range needs more than the worst corner. Fails where a
/// weight is asked of a body without mass, or a spray whose rays do not find the part.
base::Expected<std::vector<SourceLoad>> loads_of(const model::SingleSource& source, const Body& body);

/// How many loads that will be.
std::size_t count_of(const model::SingleSource& source);

}  // namespace pinjaw::planner

#pragma once

#include <vector>

#include "host/base/expected.hpp"
#include "host/geometry/surface.hpp"
#include "host/model/task.hpp"
#include "host/part/exact.hpp"
#include "host/part/part.hpp"

namespace pinjaw::planner {

/// A task's part and what is around it, as the files say it.
struct Scene {
  part::Part part;                           ///< part frame
  part::Part turned;                         ///< as its gripper sees it
  std::vector<geometry::Surface> attached;   ///< turned; solids beside the base part
  std::vector<geometry::Surface> obstacles;  ///< turned
  /// What all these were made of: the part, then what is attached, then the obstacles. Poses turned, too.
  std::vector<part::ExactBody> bodies{};
};

/// All that the pins must keep clear of beside the part: attached solids, then obstacles.
std::vector<geometry::Surface> others_of(const Scene& scene);

/// Reads the part, what is attached to it and the obstacles of a task. Attached solids that do not stand with
/// the part must be given in the part's own file axes.
base::Expected<Scene> read_scene(const model::Task& task);

}  // namespace pinjaw::planner

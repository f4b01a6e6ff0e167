#pragma once

#include <string>

#include "host/model/task.hpp"
#include "host/planner/plan/scene.hpp"

namespace pinjaw::bench {

/// A task of configs/tasks/ with what its files say. Throws where they cannot be read.
struct Shipped {
  explicit Shipped(const std::string& task_name);

  model::Task task;
  planner::Scene scene;
};

}  // namespace pinjaw::bench

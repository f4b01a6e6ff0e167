#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "host/config/read.hpp"
#include "host/planner/plan/plan.hpp"
#include "tests/support/places.hpp"

/// Plans of shipped tasks, made once a program.
namespace pinjaw::planner {

struct Planned {
  model::Task task;
  Scene scene;
  Plan plan;
};

inline Planned plan_of(const std::string& name, const PlanOptions& options) {
  const auto task = config::read_task(test::source_dir("configs/tasks/" + name + ".yaml"));
  if (!task) throw std::runtime_error(base::render(task.error(), "no task"));
  auto scene = read_scene(*task);
  if (!scene) throw std::runtime_error(scene.error().message);
  auto plan = make_plan(*task, *scene, options);
  if (!plan) throw std::runtime_error(plan.error().message);
  return {*task, std::move(*scene), std::move(*plan)};
}

inline const Planned& valve_pedestal() {
  static const Planned kPlanned = plan_of("valve-pedestal", {.top = 0});
  return kPlanned;
}

inline const Planned& cam() {
  static const Planned kPlanned = plan_of("cam", {.top = 0});
  return kPlanned;
}

}  // namespace pinjaw::planner

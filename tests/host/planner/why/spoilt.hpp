#pragma once

#include <functional>
#include <stdexcept>

#include "host/config/read.hpp"
#include "host/planner/why/suggest.hpp"
#include "tests/support/places.hpp"

/// The shipped L-plate's job with something wrong, planned.
namespace pinjaw::planner {

struct Spoilt {
  model::Task task;
  Scene scene;
  PlanOptions options;
  Plan plan;

  [[nodiscard]] std::vector<NearMiss> misses() const { return nearest_misses(task, scene, plan, options); }
};

inline Plan plan_or_throw(const model::Task& task, const Scene& scene, const PlanOptions& options = {}) {
  auto plan = make_plan(task, scene, options);
  if (!plan) throw std::runtime_error(plan.error().message);
  return std::move(*plan);
}

inline Spoilt spoilt(const std::function<void(model::Task&)>& spoil) {
  auto task = config::read_task(test::source_dir("configs/tasks/l-plate.yaml"));
  if (!task) throw std::runtime_error(base::render(task.error(), "no task"));
  spoil(*task);
  auto scene = read_scene(*task);
  if (!scene) throw std::runtime_error(scene.error().message);
  Spoilt result{std::move(*task), std::move(*scene), {}, {}};
  result.plan = plan_or_throw(result.task, result.scene);
  return result;
}

/// One column a jaw, so that the separation is what the fixture makes it, and jaws that do not open far
/// enough.
inline void shorten_travel(model::Task& task) {
  task.kit.grid.columns = 1;
  task.kit.jaws.separation_mm = {0, 2};
}

/// A ring 9 mm about the plate, from 5 mm over its underside.
inline void stand_a_ring_about_it(model::Task& task) {
  task.obstacles.push_back({test::source_dir("tests/host/planner/why/ring.yaml"), {}, 5});
}

}  // namespace pinjaw::planner

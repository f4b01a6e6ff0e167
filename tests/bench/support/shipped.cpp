#include "tests/bench/support/shipped.hpp"

#include <stdexcept>
#include <utility>

#include "host/config/read.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::bench {
namespace {

model::Task task_called(const std::string& name) {
  auto task = config::read_task(test::source_dir("configs/tasks/" + name + ".yaml"));
  if (!task) throw std::runtime_error(base::render(task.error(), "no task"));
  return std::move(*task);
}

planner::Scene scene_of(const model::Task& task) {
  auto scene = planner::read_scene(task);
  if (!scene) throw std::runtime_error(scene.error().message);
  return std::move(*scene);
}

}  // namespace

Shipped::Shipped(const std::string& task_name) : task(task_called(task_name)), scene(scene_of(task)) {}

}  // namespace pinjaw::bench

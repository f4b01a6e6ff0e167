#include "host/planner/plan/plan.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <optional>

#include "host/base/random.hpp"
#include "host/planner/force/force.hpp"
#include "host/planner/plan/candidates.hpp"
#include "host/planner/plan/design_names.hpp"

namespace pinjaw::planner {

namespace {

struct Loads {
  std::vector<model::Disturbance> disturbances;
  std::vector<model::Wrench> wrenches;  ///< turned
};

base::Expected<Loads> loads_of(const model::Task& task, const Scene& scene) {
  const Body body{scene.part.mass_kg, scene.part.centroid_mm, &scene.part.surface};
  auto disturbances = disturbances_of(task, body);
  if (!disturbances) return tl::unexpected(disturbances.error());
  Loads loads{std::move(*disturbances), {}};
  loads.wrenches = turned_wrenches(loads.disturbances, task.side);
  return loads;
}

/// Sorts the verdicts into the plan: the designs that hold, and the counts of those that do not.
void judge(std::vector<model::Design> designs, const std::vector<ForceVerdict>& verdicts, Plan& plan) {
  auto& losses = plan.losses["force"];
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const ForceVerdict& verdict = verdicts[i];
    if (std::holds_alternative<Jams>(verdict)) {
      ++losses["jams"];
      continue;
    }
    if (std::holds_alternative<Wedges>(verdict)) {
      ++losses["wedges"];
      continue;
    }
    ++plan.funnel.not_wedging;
    if (std::holds_alternative<NotResistable>(verdict)) {
      ++losses["no squeeze resists every disturbance"];
      continue;
    }
    ++plan.funnel.resistable;
    if (std::holds_alternative<TooStrong>(verdict)) {
      ++losses["needs more than the usable force"];
      continue;
    }
    ++plan.funnel.strong;
    const auto& holds = std::get<Holds>(verdict);
    const double usable_n = plan.kit.actuator.usable_squeeze_n();
    designs[i].squeeze = {holds.required_n, usable_n, plan.kit.actuator.max_squeeze_n,
                          usable_n - holds.required_n,
                          plan.disturbances.empty() ? "none" : plan.disturbances[holds.critical].name};
    plan.designs.push_back(std::move(designs[i]));
  }
}

}  // namespace

model::Task task_of(const Plan& plan) {
  model::Task task;
  task.name = plan.task;
  task.part.file = plan.part.file;
  task.part.up = plan.part.up;
  task.part.mass_kg = plan.part.mass_kg;
  task.kit = plan.kit;
  task.side = plan.side;
  task.friction = plan.friction;
  task.obstacles = plan.obstacles;
  task.attached = plan.attached;
  return task;
}

base::Expected<Plan> make_plan(const model::Task& task, const Scene& scene, const PlanOptions& options,
                               const ProgressSink& progress) {
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  }
  auto loads = loads_of(task, scene);
  if (!loads) return tl::unexpected(loads.error());
  auto candidates = find_candidates(task, scene, options, progress);
  if (!candidates) return tl::unexpected(candidates.error());

  Plan plan;
  plan.task = task.name;
  plan.part = {task.part.file.string(), scene.part.sha256, task.part.up, scene.part.mass_kg,
               scene.part.centroid_mm};
  plan.kit = task.kit;
  plan.side = task.side;
  plan.obstacles = task.obstacles;
  plan.attached = task.attached;
  plan.friction = task.friction;
  plan.loading_2d = options.loading_2d;
  plan.friction_model = options.friction;
  plan.random_algorithm = base::Random::kAlgorithm;
  plan.disturbances = std::move(loads->disturbances);
  plan.funnel = candidates->funnel;
  plan.losses = std::move(candidates->losses);

  name_designs(candidates->designs, "gripper");
  std::vector<Grasp> grasps;
  grasps.reserve(candidates->designs.size());
  for (const model::Design& design : candidates->designs) grasps.push_back(grasp_of(design, task.friction));
  if (progress) progress({"force", 0, static_cast<std::int64_t>(grasps.size())});
  const ForceOptions force{options.friction, task.kit.actuator.usable_squeeze_n(), {}};
  judge(std::move(candidates->designs), evaluate_all(grasps, loads->wrenches, force, options.threads), plan);

  std::ranges::sort(plan.designs, [](const model::Design& a, const model::Design& b) {
    return std::tie(a.squeeze.required_n, a.id) < std::tie(b.squeeze.required_n, b.id);
  });
  if (options.top > 0 && plan.designs.size() > options.top) plan.designs.resize(options.top);
  return plan;
}

}  // namespace pinjaw::planner

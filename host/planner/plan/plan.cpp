#include "host/planner/plan/plan.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <tuple>

#include "host/base/random.hpp"
#include "host/planner/force/force.hpp"
#include "host/planner/plan/candidates.hpp"
#include "host/planner/plan/certify.hpp"
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

/// Smallest squeeze first; no two designs are equal.
bool before(const model::Design& a, const model::Design& b) {
  return std::tie(a.squeeze.required_n, a.id) < std::tie(b.squeeze.required_n, b.id);
}

/// Phase 5: takes designs as they come, counts them all, and keeps the best.
class Ranking {
 public:
  /// `top` as in PlanOptions; all references outlive it.
  Ranking(Plan& plan, std::span<const model::Wrench> wrenches, const PlanOptions& options)
      : plan_(plan),
        wrenches_(wrenches),
        options_(options),
        force_{options.friction, plan.kit.actuator.usable_squeeze_n(), {}},
        losses_(plan.losses["force"]),
        names_("gripper") {}

  void take(std::vector<model::Design> designs) {
    std::vector<Grasp> grasps;
    grasps.reserve(designs.size());
    for (const model::Design& design : designs) grasps.push_back(grasp_of(design, plan_.friction));
    const auto verdicts = evaluate_all(grasps, wrenches_, force_, options_.threads);
    for (std::size_t i = 0; i < designs.size(); ++i) judge(std::move(designs[i]), verdicts[i]);
    if (options_.top > 0 && plan_.designs.size() >= 2 * options_.top + kSpare) cut();
  }

  /// Sorts what was kept.
  void finish() {
    cut();
    std::ranges::sort(plan_.designs, before);
  }

 private:
  static constexpr std::size_t kSpare = 1000;  ///< chosen: cut seldom

  void judge(model::Design design, const ForceVerdict& verdict) {
    if (std::holds_alternative<Jams>(verdict)) {
      ++losses_["jams"];
      return;
    }
    if (std::holds_alternative<Wedges>(verdict)) {
      ++losses_["wedges"];
      return;
    }
    ++plan_.funnel.not_wedging;
    if (std::holds_alternative<NotResistable>(verdict)) {
      ++losses_["no squeeze resists every disturbance"];
      return;
    }
    ++plan_.funnel.resistable;
    if (std::holds_alternative<TooStrong>(verdict)) {
      ++losses_["needs more than the usable force"];
      return;
    }
    ++plan_.funnel.strong;
    const auto& holds = std::get<Holds>(verdict);
    design.id = names_.next(design);
    design.squeeze = {holds.required_n, force_.usable_n, plan_.kit.actuator.max_squeeze_n,
                      force_.usable_n - holds.required_n,
                      plan_.disturbances.empty() ? "none" : plan_.disturbances[holds.critical].name};
    plan_.designs.push_back(std::move(design));
  }

  void cut() {
    auto& kept = plan_.designs;
    if (options_.top == 0 || kept.size() <= options_.top) return;
    std::ranges::nth_element(kept, kept.begin() + static_cast<std::ptrdiff_t>(options_.top), before);
    kept.resize(options_.top);
  }

  Plan& plan_;
  std::span<const model::Wrench> wrenches_;
  const PlanOptions& options_;
  ForceOptions force_;
  std::map<std::string, std::int64_t>& losses_;
  DesignNames names_;
};

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

  Ranking ranking(plan, loads->wrenches, options);
  auto counts = find_candidates(task, scene, options, progress,
                                [&](std::vector<model::Design> some) { ranking.take(std::move(some)); });
  if (!counts) return tl::unexpected(counts.error());
  ranking.finish();
  plan.funnel.features = counts->funnel.features;
  plan.funnel.planar = counts->funnel.planar;
  plan.funnel.heights = counts->funnel.heights;
  plan.funnel.loadable = counts->funnel.loadable;
  plan.losses.merge(counts->losses);
  if (options.certify > 0) {
    const auto done = certify(task, scene, options.certify, options.stop, progress, plan);
    if (!done) return tl::unexpected(done.error());
  }
  return plan;
}

}  // namespace pinjaw::planner

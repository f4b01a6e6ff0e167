#include "host/planner/plan/certify.hpp"

#include <algorithm>

namespace pinjaw::planner {
WorstSpray worst_spray_of(const Plan& plan, const Scene& scene) {
  return WorstSpray({&scene.part.surface, scene.part.mesh_deflection_mm}, plan.jets);
}

std::optional<model::Certified> certified(const Plan& plan, WorstSpray& search, const model::Design& design) {
  return search.of(grasp_of(design, plan.friction), plan.side, plan.friction_model);
}

base::Expected<void> certify(const model::Task& task, const Scene& scene, std::size_t count,
                             std::stop_token stop, const ProgressSink& progress, Plan& plan) {
  auto jets = jets_of(task, {scene.part.mass_kg, scene.part.centroid_mm, &scene.part.surface});
  if (!jets) return tl::unexpected(jets.error());
  if (jets->empty()) return base::failure("--certify finds the worst spray, and the task names no spray");
  plan.jets = std::move(*jets);
  WorstSpray search = worst_spray_of(plan, scene);
  const std::size_t designs = std::min(count, plan.designs.size());
  for (std::size_t i = 0; i < designs; ++i) {
    if (stop.stop_requested()) return base::failure("interrupted");
    if (progress) progress({"certify", static_cast<std::int64_t>(i), static_cast<std::int64_t>(designs)});
    plan.designs[i].certified = certified(plan, search, plan.designs[i]);
  }
  return {};
}

}  // namespace pinjaw::planner

#include "host/planner/why/near_miss.hpp"

#include <iterator>

#include "host/planner/why/miss_search.hpp"

namespace pinjaw::planner {

std::vector<NearMiss> nearest_misses(const model::Task& task, const Scene& scene, const Plan& plan,
                                     const PlanOptions& options, const ProgressSink& progress) {
  std::vector<NearMiss> misses = feature_misses(task, scene, plan, options.stop);
  const auto add = [&misses](std::vector<NearMiss> of_phase) {
    misses.insert(misses.end(), std::make_move_iterator(of_phase.begin()),
                  std::make_move_iterator(of_phase.end()));
  };
  if (plan.funnel.features > 0 && plan.funnel.planar == 0) add(planar_misses(task, scene, options));
  if (plan.funnel.planar == 0) return misses;

  const Sorted sorted = sorted_fixtures(task, scene, options, progress);
  add(standing_misses(task, scene, sorted.not_standing));
  add(loading_misses(task, scene, sorted.not_loading, options));
  add(force_misses(task, plan, sorted.loading, options));
  return misses;
}

}  // namespace pinjaw::planner

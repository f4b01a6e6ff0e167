#include <algorithm>
#include <cmath>

#include "host/planner/features/features.hpp"
#include "host/planner/planar/column_shifts.hpp"
#include "host/planner/why/levers.hpp"
#include "host/planner/why/miss_search.hpp"

namespace pinjaw::planner {
namespace {

NearMiss nearest_separation(const Features& features, model::Kit kit, const Scene& scene,
                            const PlanOptions& options) {
  NearMiss miss{.phase = "planar", .reason = "no four pins in form closure", .quantity = "jaw separation"};
  const geometry::Interval range = kit.jaws.separation_mm;
  kit.jaws.separation_mm = {0, std::max(range.hi, widest_grip_mm(scene.turned.surface, kit))};
  for (const PlanarFixture& fixture : planar_fixtures(features.features, kit, scene, options)) {
    for (const ColumnShift& shift : column_shifts(kit, fixture)) {
      const double s_mm = shift.jaw_separation_mm;
      const double end_mm = s_mm > range.hi ? range.hi : range.lo;
      if (miss.gap && std::abs(s_mm - end_mm) >= std::abs(miss.gap->needs - miss.gap->has)) continue;
      miss.gap = NearMiss::Gap{end_mm, s_mm};
    }
  }
  return miss;
}

}  // namespace

std::vector<NearMiss> planar_misses(const model::Task& task, const Scene& scene, const PlanOptions& options) {
  const Features features = find_features(scene.turned, task.kit.pins);
  if (features.counts.reachable == 0) return {};
  std::vector<NearMiss> misses{nearest_separation(features, task.kit, scene, options)};
  const double asked_mm = task.kit.pins.min_foot_margin_mm;
  if (asked_mm <= 0) return misses;

  model::Kit kit = task.kit;
  kit.pins.min_foot_margin_mm = 0;
  NearMiss miss{
      .phase = "planar", .reason = "feet too near the ends of their features", .quantity = "foot margin"};
  double widest_mm = -1;
  for (const PlanarFixture& fixture : planar_fixtures(features.features, kit, scene, options)) {
    ++miss.count;
    const auto& nearest = *std::ranges::min_element(fixture.pins, {}, &PlanarPin::foot_margin_mm);
    widest_mm = std::max(widest_mm, nearest.foot_margin_mm);
  }
  if (miss.count > 0) miss.gap = NearMiss::Gap{widest_mm, asked_mm};
  misses.push_back(std::move(miss));
  return misses;
}

}  // namespace pinjaw::planner

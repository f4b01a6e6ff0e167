#include <map>

#include "host/planner/planar/column_shifts.hpp"
#include "host/planner/why/least.hpp"
#include "host/planner/why/miss_search.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kStep_mm = 1e-3;  // chosen: overlaps are told to a thousandth of a millimetre

/// All that decides whether one lost fixture loads once its pins or its plates are lower.
struct Lowering {
  const model::Kit& kit;
  const Scene& scene;
  const Around& around;
  LoadingOptions options;

  [[nodiscard]] bool pins_load(const LostLoading& lost, double lower_mm) const {
    auto pins = lost.pins;
    for (PinToLoad& pin : pins) pin.top_mm -= lower_mm;
    const Surroundings surroundings{&scene.turned.surface, around.others, around.plate_top_mm};
    return load(lost.fixture, pins, kit, surroundings, options).has_value();
  }
  [[nodiscard]] bool plates_load(const LostLoading& lost, double lower_mm) const {
    const Surroundings surroundings{&scene.turned.surface, around.others, around.plate_top_mm - lower_mm};
    return load(lost.fixture, lost.pins, kit, surroundings, options).has_value();
  }
};

NearMiss overlap_miss(LoadingLoss reason, const std::vector<const LostLoading*>& lost,
                      const Lowering& lowering, const std::stop_token& stop) {
  const bool plate = reason == LoadingLoss::PlateMeetsObstacle;
  NearMiss miss{.phase = "loading",
                .reason = std::string(to_string(reason)),
                .count = static_cast<std::int64_t>(lost.size()),
                .quantity = plate ? "overlap in height of a plate on its way"
                                  : "overlap in height of a pin on its way"};
  const geometry::Interval z_mm = lowering.scene.turned.surface.z_range_mm();
  const double most_mm = z_mm.hi - lowering.around.plate_top_mm + lowering.kit.jaws.plate_thickness_mm;
  const auto least = least_over(lost.size(), most_mm, kStep_mm, stop, [&](std::size_t i, double lower_mm) {
    return plate ? lowering.plates_load(*lost[i], lower_mm) : lowering.pins_load(*lost[i], lower_mm);
  });
  if (!least) return miss;
  miss.gap = NearMiss::Gap{least->value, 0};
  miss.where = feet_of(lost[least->which]->fixture);
  return miss;
}

/// The most that a jaw of some fixture opens, against the least that counts as opening.
NearMiss opening_miss(const std::vector<const LostLoading*>& lost, const model::Kit& kit) {
  NearMiss miss{.phase = "loading",
                .reason = std::string(to_string(LoadingLoss::NoOpening)),
                .count = static_cast<std::int64_t>(lost.size()),
                .quantity = "opening of each jaw"};
  for (const LostLoading* of : lost) {
    for (const ColumnShift& shift : column_shifts(kit, of->fixture)) {
      const double s_mm = shift.jaw_separation_mm;
      const double opening_mm = (model::open_separation_mm(kit.jaws, s_mm) - s_mm) / 2;
      if (opening_mm >= kLeastOpening_mm || (miss.gap && opening_mm <= miss.gap->has)) continue;
      miss.gap = NearMiss::Gap{opening_mm, kLeastOpening_mm};
      miss.where = feet_of(of->fixture);
    }
  }
  return miss;
}

}  // namespace

std::vector<NearMiss> loading_misses(const model::Task& task, const Scene& scene,
                                     const std::vector<LostLoading>& lost, const PlanOptions& options) {
  std::map<LoadingLoss, std::vector<const LostLoading*>> by_reason;
  for (const LostLoading& of : lost) by_reason[of.reason].push_back(&of);
  const Around others = around(task.kit, scene);
  const Lowering lowering{task.kit, scene, others, loading_options(options)};
  std::vector<NearMiss> misses;
  for (const auto& [reason, fixtures] : by_reason) {
    switch (reason) {
      case LoadingLoss::NoShift:
        misses.push_back({.phase = "loading",
                          .reason = std::string(to_string(reason)),
                          .count = static_cast<std::int64_t>(fixtures.size()),
                          .quantity = "columns"});
        break;
      case LoadingLoss::NoOpening:
        misses.push_back(opening_miss(fixtures, task.kit));
        break;
      case LoadingLoss::PinSweep:
      case LoadingLoss::PinMeetsObstacle:
      case LoadingLoss::PlateMeetsObstacle:
        misses.push_back(overlap_miss(reason, fixtures, lowering, options.stop));
        break;
    }
  }
  return misses;
}

}  // namespace pinjaw::planner

#include "host/planner/plan/candidates.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>
#include <span>
#include <variant>

#include "host/planner/features/features.hpp"
#include "host/planner/heights/heights.hpp"
#include "host/planner/loading/loading.hpp"
#include "host/planner/planar/planar.hpp"

namespace pinjaw::planner {

namespace {

using Outcome = std::variant<model::Design, HeightLoss, LoadingLoss>;

/// Edges, walls and silhouettes that became no feature with room for a pin, by what became of them.
void count_features(const FeatureCounts& counts, const part::Part& part, Losses& losses) {
  for (const Fate fate : kFates) {
    if (fate == Fate::Kept) continue;
    losses["features"][std::string(meaning_of(fate))] =
        counts.edges[fate] + counts.walls[fate] + counts.silhouettes[fate] + counts.contours[fate];
  }
  if (!part.mesh_counts) return;
  losses["features"]["upright edge of a mesh"] = part.contour_counts.upright;
  losses["features"]["gentle fold of a mesh"] = part.contour_counts.gentle;
  losses["features"]["jagged silhouette of a mesh"] = part.contour_counts.jagged;
}

/// Fixtures that are held as designs at once: enough to keep all threads busy between two meetings.
constexpr std::size_t kBatch = 4096;

Outcome design_of(const PlanarFixture& fixture, const Heights& heights, const model::Kit& kit,
                  const Surroundings& surroundings, const LoadingOptions& options) {
  const auto standing = heights.of(fixture);
  if (!standing) return standing.error().reason;
  std::array<PinToLoad, 4> pins;
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const PinHeight& height = (*standing)[i];
    pins[i] = {i, height.length_mm, height.top_mm, height.contact_z_mm};
  }
  auto design = load(fixture, pins, kit, surroundings, options);
  if (!design) return design.error();
  return *design;
}

/// Phases 3 and 4 on some fixtures at a time.
class Stands {
 public:
  Stands(const model::Kit& kit, const Scene& scene, bool loading_2d)
      : kit_(kit),
        others_(others_of(scene)),
        plate_top_mm_(plate_top_mm(kit, scene.turned.surface, scene.attached)),
        surroundings_{&scene.turned.surface, others_, plate_top_mm_},
        loading_{loading_2d ? SweepHeights::Infinite : SweepHeights::Pins, JawMotion::Closes},
        heights_(scene.turned.surface, kit.pins, plate_top_mm_) {}

  [[nodiscard]] std::vector<Outcome> outcomes(std::span<const PlanarFixture> fixtures) const {
    std::vector<Outcome> outcomes(fixtures.size(), HeightLoss::NoEngagement);
    tbb::parallel_for(std::size_t{0}, fixtures.size(), [&](std::size_t i) {
      outcomes[i] = design_of(fixtures[i], heights_, kit_, surroundings_, loading_);
    });
    return outcomes;
  }

 private:
  const model::Kit& kit_;
  std::vector<geometry::Surface> others_;
  double plate_top_mm_;
  Surroundings surroundings_;
  LoadingOptions loading_;
  Heights heights_;
};

/// Counts the outcomes, and keeps those that load.
std::vector<model::Design> loadable(std::vector<Outcome> outcomes, CandidateCounts& counts) {
  std::vector<model::Design> designs;
  for (Outcome& outcome : outcomes) {
    if (const auto* height = std::get_if<HeightLoss>(&outcome)) {
      ++counts.losses["heights"][std::string(to_string(*height))];
      continue;
    }
    ++counts.funnel.heights;
    if (const auto* loading = std::get_if<LoadingLoss>(&outcome)) {
      ++counts.losses["loading"][std::string(to_string(*loading))];
      continue;
    }
    ++counts.funnel.loadable;
    designs.push_back(std::move(std::get<model::Design>(outcome)));
  }
  return designs;
}

}  // namespace

base::Expected<CandidateCounts> find_candidates(const model::Task& task, const Scene& scene,
                                                const PlanOptions& options, const ProgressSink& progress,
                                                const CandidateSink& take) {
  CandidateCounts counts;
  if (progress) progress({"features", 0, 0});
  const Features features = find_features(scene.turned, task.kit.pins);
  counts.funnel.features = static_cast<std::int64_t>(features.features.size());
  count_features(features.counts, scene.turned, counts.losses);

  constexpr std::int64_t kParts = 1000;
  PlanarOptions planar;
  planar.outline = scene.turned.profile ? &*scene.turned.profile : nullptr;
  planar.twins = Twins::Once;
  planar.threads = options.threads;
  planar.stop = options.stop;
  std::mutex mutex;
  if (progress) {
    planar.progress = [&](double share) {
      const std::scoped_lock lock(mutex);
      progress({"planar", static_cast<std::int64_t>(share * kParts), kParts});
    };
  }
  const PlanarResult found = plan_planar_fixtures(features.features, task.kit, planar);
  const std::span<const PlanarFixture> fixtures(found.fixtures);
  counts.funnel.planar = static_cast<std::int64_t>(fixtures.size());

  const Stands stands(task.kit, scene, options.loading_2d);
  for (std::size_t done = 0; done < fixtures.size() && !options.stop.stop_requested(); done += kBatch) {
    if (progress)
      progress({"designs", static_cast<std::int64_t>(done), static_cast<std::int64_t>(fixtures.size())});
    take(loadable(stands.outcomes(fixtures.subspan(done, std::min(kBatch, fixtures.size() - done))), counts));
  }
  if (options.stop.stop_requested()) return base::failure("the plan was stopped before its end");
  if (progress) progress({"designs", counts.funnel.planar, counts.funnel.planar});
  return counts;
}

}  // namespace pinjaw::planner

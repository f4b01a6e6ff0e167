#include "host/planner/plan/candidates.hpp"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <variant>

#include "host/planner/features/features.hpp"
#include "host/planner/heights/heights.hpp"
#include "host/planner/loading/loading.hpp"
#include "host/planner/planar/planar.hpp"

namespace pinjaw::planner {

namespace {

using Outcome = std::variant<model::Design, HeightLoss, LoadingLoss>;

void count_features(const FeatureCounts& counts, Losses& losses) {
  auto& of_phase = losses["features"];
  of_phase["upright edge"] = counts.left_out_upright;
  of_phase["tilted curve"] = counts.left_out_tilted;
  of_phase["freeform curve"] = counts.left_out_freeform;
  of_phase["gentle fold of a mesh"] = counts.left_out_gentle;
  of_phase["jagged silhouette of a mesh"] = counts.left_out_jagged;
  of_phase["no room for a pin"] = counts.features - counts.reachable;
}

/// Gives each count to the caller's sink from one thread at a time.
class Counter {
 public:
  Counter(const ProgressSink& sink, std::string phase, std::int64_t total)
      : sink_(sink), phase_(std::move(phase)), total_(total) {
    tell(0);
  }
  void add_one() {
    const std::int64_t done = ++done_;
    constexpr std::int64_t kEvery = 64;
    if (done % kEvery == 0 || done == total_) tell(done);
  }

 private:
  void tell(std::int64_t done) {
    if (!sink_) return;
    const std::scoped_lock lock(mutex_);
    sink_({phase_, done, total_});
  }

  const ProgressSink& sink_;
  std::string phase_;
  std::int64_t total_;
  std::atomic<std::int64_t> done_ = 0;
  std::mutex mutex_;
};

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

std::vector<Outcome> stand_and_load(const std::vector<PlanarFixture>& fixtures, const model::Kit& kit,
                                    const Scene& scene, const PlanOptions& options,
                                    const ProgressSink& progress) {
  std::vector<geometry::Surface> others = scene.attached;
  others.insert(others.end(), scene.obstacles.begin(), scene.obstacles.end());
  const double plate_top = plate_top_mm(kit, scene.turned.surface, scene.attached);
  const Surroundings surroundings{&scene.turned.surface, others, plate_top};
  const LoadingOptions loading{options.loading_2d ? SweepHeights::Infinite : SweepHeights::Pins,
                               JawMotion::Closes};
  const Heights heights(scene.turned.surface, kit.pins, plate_top);

  std::vector<Outcome> outcomes(fixtures.size(), HeightLoss::NoEngagement);
  Counter counter(progress, "heights", static_cast<std::int64_t>(fixtures.size()));
  tbb::parallel_for(std::size_t{0}, fixtures.size(), [&](std::size_t i) {
    if (options.stop.stop_requested()) return;
    outcomes[i] = design_of(fixtures[i], heights, kit, surroundings, loading);
    counter.add_one();
  });
  return outcomes;
}

}  // namespace

base::Expected<Candidates> find_candidates(const model::Task& task, const Scene& scene,
                                           const PlanOptions& options, const ProgressSink& progress) {
  Candidates candidates;
  if (progress) progress({"features", 0, 0});
  const Features features = find_features(scene.turned, task.kit.pins);
  candidates.funnel.features = static_cast<std::int64_t>(features.features.size());
  count_features(features.counts, candidates.losses);

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
  candidates.funnel.planar = static_cast<std::int64_t>(found.fixtures.size());

  for (Outcome& outcome : stand_and_load(found.fixtures, task.kit, scene, options, progress)) {
    if (const auto* height = std::get_if<HeightLoss>(&outcome)) {
      ++candidates.losses["heights"][std::string(to_string(*height))];
      continue;
    }
    ++candidates.funnel.heights;
    if (const auto* loading = std::get_if<LoadingLoss>(&outcome)) {
      ++candidates.losses["loading"][std::string(to_string(*loading))];
      continue;
    }
    ++candidates.funnel.loadable;
    candidates.designs.push_back(std::move(std::get<model::Design>(outcome)));
  }
  if (options.stop.stop_requested()) return base::failure("the plan was stopped before its end");
  return candidates;
}

}  // namespace pinjaw::planner

#include "host/planner/why/lost.hpp"

#include <fmt/format.h>

#include "host/planner/features/features.hpp"
#include "host/planner/plan/design_names.hpp"
#include "host/planner/planar/planar.hpp"

namespace pinjaw::planner {

Around around(const model::Kit& kit, const Scene& scene) {
  return {others_of(scene), plate_top_mm(kit, scene.turned.surface, scene.attached)};
}

LoadingOptions loading_options(const PlanOptions& options) {
  return {options.loading_2d ? SweepHeights::Infinite : SweepHeights::Pins, JawMotion::Closes};
}

namespace {

std::array<PinToLoad, 4> pins_to_load(const FixtureHeights& heights) {
  std::array<PinToLoad, 4> pins;
  for (std::size_t i = 0; i < pins.size(); ++i) {
    pins[i] = {i, heights[i].length_mm, heights[i].top_mm, heights[i].contact_z_mm};
  }
  return pins;
}

}  // namespace

std::string feet_of(const PlanarFixture& fixture) {
  std::string text = "pins on features";
  for (const PlanarPin& pin : fixture.pins) text += fmt::format(" {}", pin.feature);
  return text;
}

std::vector<PlanarFixture> planar_fixtures(const std::vector<model::Feature>& features, const model::Kit& kit,
                                           const Scene& scene, const PlanOptions& options) {
  PlanarOptions planar;
  planar.outline = scene.turned.profile ? &*scene.turned.profile : nullptr;
  planar.twins = Twins::Once;
  planar.threads = options.threads;
  planar.stop = options.stop;
  return plan_planar_fixtures(features, kit, planar).fixtures;
}

Sorted sorted_fixtures(const model::Task& task, const Scene& scene, const PlanOptions& options,
                       const ProgressSink& progress) {
  const Features features = find_features(scene.turned, task.kit.pins);
  const auto fixtures = planar_fixtures(features.features, task.kit, scene, options);
  const Around others = around(task.kit, scene);
  const Surroundings surroundings{&scene.turned.surface, others.others, others.plate_top_mm};
  const Heights heights(scene.turned.surface, task.kit.pins, others.plate_top_mm);
  Sorted sorted;
  std::int64_t done = 0;
  for (const PlanarFixture& fixture : fixtures) {
    if (options.stop.stop_requested()) break;
    if (progress) progress({"near misses", ++done, static_cast<std::int64_t>(fixtures.size())});
    const auto standing = heights.of(fixture);
    if (!standing) {
      sorted.not_standing.push_back({fixture, standing.error().reason});
      continue;
    }
    const auto pins = pins_to_load(*standing);
    auto design = load(fixture, pins, task.kit, surroundings, loading_options(options));
    if (!design) {
      sorted.not_loading.push_back({fixture, pins, design.error()});
      continue;
    }
    sorted.loading.push_back(*std::move(design));
  }
  name_designs(sorted.loading, "gripper");
  return sorted;
}

}  // namespace pinjaw::planner

#include "host/cell/pallet.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>
#include <variant>

#include "host/planner/features/features.hpp"
#include "host/planner/heights/heights.hpp"
#include "host/planner/loading/loading.hpp"
#include "host/planner/plan/design_names.hpp"
#include "host/planner/planar/planar.hpp"

namespace pinjaw::cell {
namespace {

using planner::HeightLoss;
using planner::LoadingLoss;
using planner::PlanarFixture;
using planner::PlanarPin;

using Outcome = std::variant<model::Design, HeightLoss, LoadingLoss>;

/// Pin axes in the part frame, rounded to 1e-4 mm and sorted: what a pallet is known by. Equal pins agree to
/// 1e-9 mm; the shift keeps round numbers away from where rounding changes.
using Axes = std::array<std::array<long long, 2>, 3>;

Axes axes_of(const PalletFixture& pallet, double pin_radius_mm) {
  constexpr double kSteps_per_mm = 1e4;
  constexpr double kShift = 0.3183;
  Axes axes{};
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarPin& pin = pallet.fixture.pins[pallet.pins[i]];
    const geometry::Vector2d axis_mm = pin.p_PFoot_mm - pin_radius_mm * pin.n_P;
    axes[i] = {std::llround(axis_mm.x() * kSteps_per_mm + kShift),
               std::llround(axis_mm.y() * kSteps_per_mm + kShift)};
  }
  std::sort(axes.begin(), axes.end());
  return axes;
}

Outcome design_of(const PalletFixture& pallet, const planner::Heights& heights, const model::Kit& kit,
                  const planner::Surroundings& surroundings, const planner::LoadingOptions& options) {
  std::array<planner::PinToLoad, 3> pins;
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const PlanarPin& pin = pallet.fixture.pins[pallet.pins[i]];
    const auto height = heights.at({pin.p_PFoot_mm, pin.n_P});
    if (!height) return height.error();
    pins[i] = {pallet.pins[i], height->length_mm, height->top_mm, height->contact_z_mm};
  }
  auto design = planner::load(pallet.fixture, pins, kit, surroundings, options);
  if (!design) return design.error();
  return *design;
}

void keep(std::vector<Outcome>& outcomes, planner::Plan& plan) {
  for (Outcome& outcome : outcomes) {
    if (const auto* height = std::get_if<HeightLoss>(&outcome)) {
      ++plan.losses["heights"][std::string(planner::to_string(*height))];
      continue;
    }
    ++plan.funnel.heights;
    if (const auto* loading = std::get_if<LoadingLoss>(&outcome)) {
      ++plan.losses["loading"][std::string(planner::to_string(*loading))];
      continue;
    }
    plan.designs.push_back(std::move(std::get<model::Design>(outcome)));
  }
  plan.funnel.loadable = static_cast<std::int64_t>(plan.designs.size());
  plan.funnel.not_wedging = plan.funnel.resistable = plan.funnel.strong = plan.funnel.loadable;
}

std::vector<Outcome> stand_and_load(const std::vector<PalletFixture>& pallets, const model::Kit& kit,
                                    const planner::Scene& scene, bool loading_2d) {
  const std::vector<geometry::Surface> others = planner::others_of(scene);
  const double plate_top_mm = planner::plate_top_mm(kit, scene.turned.surface, scene.attached);
  const planner::Surroundings surroundings{&scene.turned.surface, others, plate_top_mm};
  const planner::LoadingOptions options{
      loading_2d ? planner::SweepHeights::Infinite : planner::SweepHeights::Pins, planner::JawMotion::None};
  const planner::Heights heights(scene.turned.surface, kit.pins, plate_top_mm);
  std::vector<Outcome> outcomes(pallets.size(), HeightLoss::NoEngagement);
  tbb::parallel_for(std::size_t{0}, pallets.size(), [&](std::size_t i) {
    outcomes[i] = design_of(pallets[i], heights, kit, surroundings, options);
  });
  return outcomes;
}

planner::Plan empty_plan(const model::Task& task, const planner::Scene& scene, bool loading_2d) {
  planner::Plan plan;
  plan.task = task.name;
  plan.part = {task.part.file.string(), scene.part.sha256, task.part.up, scene.part.mass_kg,
               scene.part.centroid_mm};
  plan.kit = task.kit;
  plan.side = task.side;
  plan.obstacles = task.obstacles;
  plan.attached = task.attached;
  plan.friction = task.friction;
  plan.loading_2d = loading_2d;
  return plan;
}

}  // namespace

std::vector<PalletFixture> pallets_of(const std::vector<PlanarFixture>& fixtures, double pin_radius_mm) {
  std::set<Axes> known;
  std::vector<PalletFixture> pallets;
  for (const PlanarFixture& fixture : fixtures) {
    if (fixture.split == model::Split::TwoTwo) continue;
    const std::size_t from = fixture.split == model::Split::ThreeOne ? 0 : 1;
    const PalletFixture pallet{fixture, {from, from + 1, from + 2}};
    if (known.insert(axes_of(pallet, pin_radius_mm)).second) pallets.push_back(pallet);
  }
  return pallets;
}

base::Expected<planner::Plan> make_pallet_plan(const model::Task& task, const planner::Scene& scene,
                                               const planner::PlanOptions& options,
                                               const planner::ProgressSink& progress) {
  planner::Plan plan = empty_plan(task, scene, options.loading_2d);
  if (progress) progress({"features", 0, 0});
  const planner::Features features = planner::find_features(scene.turned, task.kit.pins);
  plan.funnel.features = static_cast<std::int64_t>(features.features.size());

  constexpr std::int64_t kParts = 1000;
  planner::PlanarOptions planar;
  planar.outline = scene.turned.profile ? &*scene.turned.profile : nullptr;
  planar.twins = planner::Twins::Once;
  planar.threads = options.threads;
  std::mutex mutex;
  if (progress) {
    planar.progress = [&](double share) {
      const std::scoped_lock lock(mutex);
      progress({"planar", static_cast<std::int64_t>(share * kParts), kParts});
    };
  }
  const auto found = planner::plan_planar_fixtures(features.features, task.kit, planar);
  const std::vector<PalletFixture> pallets = pallets_of(found.fixtures, task.kit.pins.radius_mm);
  plan.funnel.planar = static_cast<std::int64_t>(pallets.size());

  std::vector<Outcome> outcomes = stand_and_load(pallets, task.kit, scene, options.loading_2d);
  keep(outcomes, plan);
  planner::name_designs(plan.designs, "pallet");
  return plan;
}

}  // namespace pinjaw::cell

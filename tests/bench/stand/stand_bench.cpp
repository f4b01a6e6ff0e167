// Heights and loading of all planar fixtures of real parts, ours beside a scan of every triangle.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "host/model/tolerance.hpp"
#include "host/planner/features/features.hpp"
#include "host/planner/heights/heights.hpp"
#include "host/planner/loading/loading.hpp"
#include "host/planner/planar/planar.hpp"
#include "tests/bench/suites.hpp"
#include "tests/bench/support/cpu_time.hpp"
#include "tests/bench/support/shipped.hpp"
#include "tests/host/geometry/surface_referee.hpp"

namespace pinjaw::bench {
namespace {

using geometry::Slab;
using geometry::Sweep;
using planner::PlanarFixture;

constexpr std::size_t kScanned = 1;  // fixtures that the scan is asked of: it takes a second a pin

/// One part on its kit, with what phase 2 leaves to phases 3 and 4.
struct Stand {
  explicit Stand(const std::string& task_name) : shipped(task_name) {
    const planner::Scene& scene = shipped.scene;
    others = planner::others_of(scene);
    plate_top_mm = planner::plate_top_mm(shipped.task.kit, scene.turned.surface, scene.attached);
    planner::PlanarOptions options;
    options.twins = planner::Twins::Once;
    options.threads = 1;
    fixtures =
        planner::plan_planar_fixtures(planner::find_features(scene.turned, shipped.task.kit.pins).features,
                                      shipped.task.kit, options)
            .fixtures;
  }

  Shipped shipped;
  std::vector<geometry::Surface> others;
  double plate_top_mm = 0;
  std::vector<PlanarFixture> fixtures;
};

/// Fixtures that stand and load. Nothing is remembered from one call to the next.
std::size_t loadable(const Stand& stand) {
  const model::Kit& kit = stand.shipped.task.kit;
  const geometry::Surface& part = stand.shipped.scene.turned.surface;
  const planner::Heights heights(part, kit.pins, stand.plate_top_mm);
  const planner::Surroundings surroundings{&part, stand.others, stand.plate_top_mm};
  std::size_t count = 0;
  for (const PlanarFixture& fixture : stand.fixtures) {
    const auto standing = heights.of(fixture);
    if (!standing) continue;
    std::array<planner::PinToLoad, 4> pins;
    for (std::size_t i = 0; i < pins.size(); ++i)
      pins[i] = {i, (*standing)[i].length_mm, (*standing)[i].top_mm, (*standing)[i].contact_z_mm};
    count += planner::load(fixture, pins, kit, surroundings) ? 1 : 0;
  }
  return count;
}

/// What a pin's height asks (BB 3.3) and whether its way is clear, by cutting every triangle of the part.
double scanned(const Stand& stand, const PlanarFixture& fixture) {
  const geometry::TriangleMesh& mesh = stand.shipped.scene.turned.surface.mesh();
  const double radius_mm = stand.shipped.task.kit.pins.radius_mm;
  double sum_mm = 0;
  for (const planner::PlanarPin& pin : fixture.pins) {
    const geometry::Vector2d axis_mm = pin.p_PFoot_mm - radius_mm * pin.n_P;
    const Sweep large{axis_mm, axis_mm, radius_mm + model::kEps_mm};
    const Sweep small{axis_mm, axis_mm, radius_mm - model::kEps_mm};
    const Sweep way{axis_mm, axis_mm - planner::kLeastOpening_mm * pin.n_P, radius_mm - model::kEps_mm};
    sum_mm += geometry::testing::lowest_bracket_mm(mesh, large, {}).inner;
    const double most_mm = geometry::testing::lowest_bracket_mm(mesh, small, {}).inner;
    sum_mm += geometry::testing::highest_bracket_mm(mesh, large, Slab{.hi_mm = most_mm}).inner;
    sum_mm += geometry::testing::lowest_bracket_mm(mesh, way, {}).inner;
  }
  return sum_mm;
}

void measure(Report& report, const std::string& task_name) {
  const Stand stand(task_name);
  std::size_t loads = 0;
  double sink_mm = 0;
  const std::size_t asked = std::min(kScanned, stand.fixtures.size());
  const std::vector<Contestant> contestants{
      {"pinjaw", [&] { loads = loadable(stand); }},
      {"every triangle cut, in part the same questions", [&] {
         for (std::size_t i = 0; i < asked; ++i)
           sink_mm += scanned(stand, stand.fixtures[i * stand.fixtures.size() / asked]);
       }}};
  const std::vector<double> spent_s = median_cpu_s(contestants, 3);
  const auto per_pin_us = [](double seconds, std::size_t fixtures) {
    return 1e6 * seconds / (4.0 * static_cast<double>(std::max<std::size_t>(1, fixtures)));
  };
  Measurement measurement;
  measurement.thing = "heights and loading, " + task_name;
  measurement.unit = "us of CPU time a pin";
  measurement.ours = per_pin_us(spent_s[0], stand.fixtures.size());
  measurement.at_most = 10;
  measurement.peers = {{contestants[1].name, per_pin_us(spent_s[1], asked)}};
  measurement.note =
      fmt::format("{} of {} fixtures load, {} triangles{}", loads, stand.fixtures.size(),
                  stand.shipped.scene.turned.surface.mesh().triangles.size(), sink_mm > 0 ? "" : " ");
  report.add(measurement);
}

}  // namespace

void measure_stand(Report& report) {
  for (const char* task : {"glue-gun", "valve-pedestal", "hex-flange"}) measure(report, task);
}

}  // namespace pinjaw::bench

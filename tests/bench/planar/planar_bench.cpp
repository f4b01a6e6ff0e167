// All planar fixtures of star-like outlines, ours against the slow enumerator of the tests, and how the time
// grows with edges and with size over spacing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "host/base/random.hpp"
#include "host/planner/planar/planar.hpp"
#include "tests/bench/suites.hpp"
#include "tests/bench/support/cpu_time.hpp"
#include "tests/host/planner/planar/slow/search.hpp"

namespace pinjaw::bench {
namespace {

struct Kind {
  int edges = 0;
  double size_mm = 0;
};

/// A smooth star of five uneven arms told in so many edges, so that all kinds are the same part; corners
/// evenly around but for a quarter of a share.
model::Profile star(const Kind& kind) {
  base::Random random(5);
  std::vector<geometry::Vector2d> points;
  for (int i = 0; i < kind.edges; ++i) {
    const double angle_rad = 2 * std::numbers::pi * (i + random.uniform(-0.25, 0.25)) / kind.edges;
    const double share = 0.88 + 0.08 * std::sin(5 * angle_rad + 1) + 0.04 * std::sin(2 * angle_rad);
    points.push_back(kind.size_mm / 2 * share * geometry::direction(angle_rad));
  }
  model::Profile profile;
  profile.thickness_mm = 20;
  profile.loops.emplace_back();
  for (std::size_t i = 0; i < points.size(); ++i) {
    model::ProfileEdge edge;
    edge.curve = geometry::Segment{points[i], points[(i + 1) % points.size()]};
    profile.loops[0].push_back(edge);
  }
  return profile;
}

model::Kit kit_of(int columns, int rows) {
  model::Kit kit;
  kit.grid = {11, columns, rows, 5.5};
  kit.pins.radius_mm = 2.4;
  kit.jaws.separation_mm = {0, 80};
  return kit;
}

std::vector<planner::PlanarFixture> plan(const model::Profile& profile, const model::Kit& kit) {
  planner::PlanarOptions options;
  options.outline = &profile;
  options.threads = 1;
  return planner::plan_planar_fixtures(model::features_of(profile), kit, options).fixtures;
}

/// Measures every kind on one kit and tells the exponent of the time over one figure of the kind.
template <typename Figure>
void measure_growth(Report& report, const std::vector<Kind>& kinds, const char* figure, const Figure& of) {
  const model::Kit kit = kit_of(6, 16);
  std::vector<double> x;
  std::vector<double> y;
  for (const Kind& kind : kinds) {
    const model::Profile profile = star(kind);
    std::size_t fixtures = 0;
    const Contestant ours{"pinjaw", [&] { fixtures = plan(profile, kit).size(); }};
    const double spent_s = median_cpu_s({&ours, 1}, 3).front();
    x.push_back(of(kind));
    y.push_back(spent_s);
    Measurement measurement;
    measurement.thing = fmt::format("planar fixtures, {} edges, {:.0f} mm, 6 x 16", kind.edges, kind.size_mm);
    measurement.unit = "s of CPU time";
    measurement.ours = spent_s;
    if (kind.edges == 200 && kind.size_mm == 120) measurement.at_most = 2;
    measurement.note = fmt::format("{} fixtures, {:.1f} us each", fixtures,
                                   1e6 * spent_s / static_cast<double>(std::max<std::size_t>(1, fixtures)));
    report.add(measurement);
  }
  const PowerLaw law = fitted_power_law(x, y);
  std::cout << fmt::format("time grows as {} to the power {:.2f}\n", figure, law.exponent);
}

void measure_peer(Report& report) {
  const model::Kit kit = kit_of(2, 4);
  const model::Profile profile = star({8, 44});
  const planner::slow::Task task = planner::slow::task_of(model::features_of(profile), kit, &profile);
  std::size_t fixtures = 0;
  const std::vector<Contestant> contestants{
      {"pinjaw", [&] { fixtures = plan(profile, kit).size(); }},
      {"slow enumerator of the tests", [&] { planner::slow::search(task); }}};
  const std::vector<double> spent_s = median_cpu_s(contestants);
  Measurement measurement;
  measurement.thing = "planar fixtures, 8 edges, 44 mm, 2 x 4";
  measurement.unit = "s of CPU time";
  measurement.ours = spent_s[0];
  measurement.peers = {{contestants[1].name, spent_s[1]}};
  measurement.note = fmt::format("{} fixtures", fixtures);
  report.add(measurement);
}

}  // namespace

void measure_planar(Report& report) {
  measure_peer(report);
  measure_growth(report, {{20, 120}, {50, 120}, {100, 120}, {200, 120}, {400, 120}}, "edges (120 mm)",
                 [](const Kind& kind) { return 1.0 * kind.edges; });
  measure_growth(report, {{200, 52}, {200, 80}, {200, 120}, {200, 160}}, "size over spacing (200 edges)",
                 [](const Kind& kind) { return kind.size_mm / 11; });
}

}  // namespace pinjaw::bench

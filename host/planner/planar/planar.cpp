#include "host/planner/planar/planar.hpp"

#include <oneapi/tbb/task_arena.h>

#include "host/planner/planar/canonical.hpp"
#include "host/planner/planar/sweep.hpp"

namespace pinjaw::planner {
namespace {

/// Share of the whole that the pair tables and the 2+2 sweep take (measured on outlines of 20 to 200 edges).
constexpr double kAfterTables = 0.2;
constexpr double kAfterTwoAndTwo = 0.7;

planar::Watch watch_of(const PlanarOptions& options, geometry::Interval share) {
  planar::Watch watch;
  watch.stop = options.stop;
  if (options.progress) {
    watch.progress = [&options, share](double done) { options.progress(share.lo + done * share.length()); };
  }
  return watch;
}

PlanarResult search(const std::vector<model::Feature>& features, const model::Kit& kit,
                    const PlanarOptions& options) {
  using planar::Candidate;
  const auto curves = planar::contact_curves(features, kit.pins.radius_mm, options.outline);
  const planar::Judge judge(curves, features, kit);
  const auto pieces = planar::pair_pieces(curves, kit);
  if (options.progress) options.progress(kAfterTables);
  std::vector<PlanarFixture> fixtures;
  const auto add = [&](const std::vector<Candidate>& found) {
    for (const Candidate& candidate : found) {
      planar::add_with_twin(planar::fixture_of(candidate, curves, features, kit), options.twins,
                            kit.grid.spacing_mm, fixtures);
    }
  };
  add(planar::two_and_two(pieces, judge, kit, watch_of(options, {kAfterTables, kAfterTwoAndTwo})));
  add(planar::three_and_one(pieces, curves, judge, kit, watch_of(options, {kAfterTwoAndTwo, 1})));
  if (options.stop.stop_requested()) return {PlanarEnd::Stopped, {}};
  return {PlanarEnd::Complete, planar::listed_once(fixtures, options.twins, kit.grid.spacing_mm)};
}

}  // namespace

PlanarResult plan_planar_fixtures(const std::vector<model::Feature>& features, const model::Kit& kit,
                                  const PlanarOptions& options) {
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  PlanarResult result;
  arena.execute([&] { result = search(features, kit, options); });
  return result;
}

}  // namespace pinjaw::planner

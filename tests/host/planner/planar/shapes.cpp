#include "tests/host/planner/planar/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/host/planner/planar/read_case.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Arc;
using geometry::Segment;
using geometry::Vector2d;

constexpr double kPi = std::numbers::pi;

geometry::Curve moved(const geometry::Curve& curve, const geometry::Pose2& motion) {
  if (const auto* segment = std::get_if<Segment>(&curve))
    return Segment{motion * segment->a_mm, motion * segment->b_mm};
  Arc arc = std::get<Arc>(curve);
  arc.center_mm = motion * arc.center_mm;
  arc.from_rad += motion.theta_rad;
  return arc;
}

geometry::Curve mirrored(const geometry::Curve& curve) {
  const auto flip = [](const Vector2d& v) { return Vector2d(-v.x(), v.y()); };
  if (const auto* segment = std::get_if<Segment>(&curve))
    return Segment{flip(segment->b_mm), flip(segment->a_mm)};
  Arc arc = std::get<Arc>(curve);
  arc.center_mm = flip(arc.center_mm);
  arc.from_rad = kPi - arc.from_rad - arc.sweep_rad;
  return arc;
}

geometry::Curve scaled(const geometry::Curve& curve, double factor) {
  if (const auto* segment = std::get_if<Segment>(&curve))
    return Segment{factor * segment->a_mm, factor * segment->b_mm};
  Arc arc = std::get<Arc>(curve);
  arc.center_mm *= factor;
  arc.radius_mm *= factor;
  return arc;
}

template <typename Change>
model::Profile changed(model::Profile profile, const Change& change) {
  for (auto& loop : profile.loops) {
    for (model::ProfileEdge& edge : loop) edge.curve = change(edge.curve);
  }
  return profile;
}

bool alike(const PlanarFixture& a, const PlanarFixture& b, double turn_rad) {
  if (a.split != b.split || std::abs(a.span_mm - b.span_mm) > 1e-6) return false;
  for (std::size_t k = 0; k < 4; ++k) {
    if (a.pins[k].hole != b.pins[k].hole || a.pins[k].feature != b.pins[k].feature) return false;
  }
  return std::abs(std::remainder(b.theta_rad - a.theta_rad - turn_rad, 2 * kPi)) < 1e-7;
}

}  // namespace

model::Kit small_kit(int columns, int rows) {
  model::Kit kit;
  kit.grid = {11, columns, rows, 5.5};
  kit.pins.radius_mm = 2.4;
  kit.jaws.separation_mm = {0, 60};
  return kit;
}

model::Profile profile_of_loop(const std::vector<model::ProfileEdge>& loop) {
  model::Profile profile;
  profile.thickness_mm = 20;
  profile.loops.push_back(loop);
  return profile;
}

model::Profile polygon_profile(const std::vector<Vector2d>& points) {
  return profile_of_loop(polygon(points));
}

model::Profile rounded_part() {
  std::vector<model::ProfileEdge> loop(6);
  loop[0].curve = Segment{Vector2d(0, 0), Vector2d(30, 0)};
  loop[1].curve = Arc{Vector2d(30, 14), 14, -kPi / 2, kPi};
  loop[2].curve = Segment{Vector2d(30, 28), Vector2d(24, 28)};
  loop[3].curve = Arc{Vector2d(16, 28), 8, -kPi, kPi};
  loop[3].reversed = true;
  loop[4].curve = Segment{Vector2d(8, 28), Vector2d(-3, 22)};
  loop[5].curve = Segment{Vector2d(-3, 22), Vector2d(0, 0)};
  return profile_of_loop(loop);
}

model::Profile moved(const model::Profile& profile, const geometry::Pose2& motion) {
  return changed(profile, [&](const geometry::Curve& curve) { return moved(curve, motion); });
}

model::Profile mirrored(const model::Profile& profile) {
  model::Profile flipped = changed(profile, [](const geometry::Curve& curve) { return mirrored(curve); });
  for (auto& loop : flipped.loops) std::reverse(loop.begin(), loop.end());
  return flipped;
}

model::Profile scaled(const model::Profile& profile, double factor) {
  return changed(profile, [&](const geometry::Curve& curve) { return scaled(curve, factor); });
}

model::Kit scaled(const model::Kit& kit, double factor) {
  model::Kit larger = kit;
  larger.grid.spacing_mm *= factor;
  larger.grid.edge_offset_mm *= factor;
  larger.pins.radius_mm *= factor;
  larger.jaws.separation_mm = {kit.jaws.separation_mm.lo * factor, kit.jaws.separation_mm.hi * factor};
  return larger;
}

std::vector<PlanarFixture> all_fixtures(const model::Profile& profile, const model::Kit& kit, Twins twins,
                                        int threads) {
  PlanarOptions options;
  options.outline = &profile;
  options.twins = twins;
  options.threads = threads;
  return plan_planar_fixtures(model::features_of(profile), kit, options).fixtures;
}

bool same_lists(const std::vector<PlanarFixture>& one, const std::vector<PlanarFixture>& other,
                double turn_rad) {
  if (one.size() != other.size()) return false;
  std::vector<bool> used(other.size(), false);
  for (const PlanarFixture& fixture : one) {
    std::size_t i = 0;
    while (i < other.size() && (used[i] || !alike(fixture, other[i], turn_rad))) ++i;
    if (i == other.size()) return false;
    used[i] = true;
  }
  return true;
}

}  // namespace pinjaw::planner

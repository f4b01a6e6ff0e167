#include "tests/host/planner/planar/slow_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/random.hpp"
#include "tests/host/planner/planar/shapes.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Arc;
using geometry::Segment;
using geometry::Vector2d;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kSteps = 2500;
constexpr double kClearMargin = 1e-4;  // fixtures on the brink may be in one list only

/// A star-like outline; some edges bulge out or in as arcs, and sometimes there is a hole.
model::Profile random_profile(base::Random& random) {
  const int corners = 4 + static_cast<int>(random.uniform(0, 3));
  std::vector<Vector2d> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = kTurn * (i + random.uniform(-0.25, 0.25)) / corners;
    points.push_back(random.uniform(14, 24) * geometry::direction(angle));
  }
  std::vector<model::ProfileEdge> loop;
  for (int i = 0; i < corners; ++i) {
    const Vector2d a = points[static_cast<std::size_t>(i)];
    const Vector2d b = points[static_cast<std::size_t>((i + 1) % corners)];
    model::ProfileEdge edge;
    edge.curve = Segment{a, b};
    const double kind = random.uniform();
    if (kind > 0.4) {
      const double half = (b - a).norm() / 2;
      const double rise = half * random.uniform(0.5, 2);  // centre from the chord
      const double radius = std::hypot(half, rise);
      const Vector2d right = Vector2d((b - a).y(), -(b - a).x()).normalized();
      edge.reversed = kind > 0.8;
      const Vector2d center = (a + b) / 2 + (edge.reversed ? rise : -rise) * right;
      const Vector2d first = (edge.reversed ? b : a) - center;
      edge.curve = Arc{center, radius, std::atan2(first.y(), first.x()), 2 * std::asin(half / radius)};
    }
    loop.push_back(edge);
  }
  model::Profile profile = profile_of_loop(loop);
  if (random.uniform() < 0.3) {
    model::ProfileEdge bore;
    bore.curve = Arc{Vector2d(1, 0.5), random.uniform(4, 6), 0, kTurn};
    bore.reversed = true;
    profile.loops.push_back({bore});
  }
  return profile;
}

bool same(const PlanarFixture& ours, const SlowFixture& theirs) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (ours.pins[k].hole != theirs.pins[k].hole || ours.pins[k].feature != theirs.pins[k].feature)
      return false;
  }
  return std::abs(std::remainder(ours.theta_rad - theirs.theta_rad, kTurn)) < 1e-6 &&
         std::abs(ours.span_mm - theirs.span_mm) < 1e-5;
}

double least_foot_margin_mm(const PlanarFixture& fixture) {
  return std::ranges::min(fixture.pins, {}, &PlanarPin::foot_margin_mm).foot_margin_mm;
}

TEST(PlanarSlowSearch, agrees_on_random_profiles_of_lines_arcs_and_holes) {
  base::Random random(7);
  const model::Kit kit = small_kit(2, 3);
  std::size_t compared = 0;
  for (int round = 0; round < 60; ++round) {
    const model::Profile profile = random_profile(random);
    const auto fast = all_fixtures(profile, kit);
    const auto slow = slow_search(profile, kit, {0, kTurn, kSteps});
    for (const SlowFixture& theirs : slow) {
      if (theirs.closure_margin < kClearMargin) continue;
      const bool known =
          std::ranges::any_of(fast, [&](const PlanarFixture& ours) { return same(ours, theirs); });
      EXPECT_TRUE(known) << "round " << round << ": the slow search alone has theta " << theirs.theta_rad
                         << " span " << theirs.span_mm << " margin " << theirs.closure_margin;
    }
    for (const PlanarFixture& ours : fast) {
      if (ours.closure_margin < 1e-2 || least_foot_margin_mm(ours) < 0.2) continue;
      const auto is_ours = [&](const SlowFixture& theirs) { return same(ours, theirs); };
      bool known = std::ranges::any_of(slow, is_ours);
      for (const double turn_rad :
           {0.0, kTurn / 2}) {  // held for less than a step: look closer, at the twin as well
        if (known) break;
        constexpr double kAround_rad = 0.004;
        const double middle_rad = ours.theta_rad + turn_rad;
        const ThetaSteps closer{middle_rad - kAround_rad, middle_rad + kAround_rad, 400};
        known = std::ranges::any_of(slow_search(profile, kit, closer), is_ours);
      }
      EXPECT_TRUE(known) << "round " << round << ": the fast search alone has theta " << ours.theta_rad
                         << " span " << ours.span_mm << " margin " << ours.closure_margin;
      ++compared;
    }
  }
  EXPECT_GT(compared, 800U);
}

}  // namespace
}  // namespace pinjaw::planner

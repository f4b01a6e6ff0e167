#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "host/planner/planar/column_shifts.hpp"
#include "host/planner/planar/planar.hpp"
#include "tests/host/planner/planar/read_case.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kAngle_rad = 1e-8;
constexpr double kSpan_mm = 1e-7;

/// The lists' figures have nine digits after the point.
bool same(const PlanarFixture& ours, const KnownFixture& known, const std::vector<model::Feature>& features) {
  if (to_string(ours.split) != known.split) return false;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& feature = features[static_cast<std::size_t>(ours.pins[k].feature)];
    if (KnownPin{ours.pins[k].hole, feature.loop, feature.edge} != known.pins[k]) return false;
  }
  return std::abs(std::remainder(ours.theta_rad - known.theta_rad, 2 * std::numbers::pi)) < kAngle_rad &&
         std::abs(ours.span_mm - known.span_mm) < kSpan_mm;
}

class KnownCases : public testing::TestWithParam<const char*> {};

TEST_P(KnownCases, are_listed_exactly) {
  const KnownCase known = read_case(GetParam());
  const auto features = model::features_of(known.profile);
  PlanarOptions options;
  options.outline = &known.profile;
  const PlanarResult result = plan_planar_fixtures(features, known.kit, options);
  EXPECT_EQ(result.end, PlanarEnd::Complete);
  EXPECT_EQ(result.fixtures.size(), known.fixtures.size());
  std::vector<bool> used(result.fixtures.size(), false);
  for (const KnownFixture& expected : known.fixtures) {
    bool found = false;
    for (std::size_t i = 0; i < result.fixtures.size() && !found; ++i) {
      found = !used[i] && same(result.fixtures[i], expected, features);
      if (found) used[i] = true;
    }
    EXPECT_TRUE(found || expected.borderline)
        << expected.split << " theta " << expected.theta_rad << " span " << expected.span_mm;
  }
}

TEST_P(KnownCases, can_be_placed_on_their_plates) {
  const KnownCase known = read_case(GetParam());
  const auto features = model::features_of(known.profile);
  PlanarOptions options;
  options.outline = &known.profile;
  for (const PlanarFixture& fixture : plan_planar_fixtures(features, known.kit, options).fixtures) {
    ASSERT_FALSE(column_shifts(known.kit, fixture).empty());
    const PlacedFixture placed = placed_least(known.kit, fixture);
    EXPECT_TRUE(known.kit.jaws.separation_mm.contains(placed.jaw_separation_mm));
    for (std::size_t k = 0; k < 4; ++k) {
      const auto p_GHole_mm = model::p_GHole_mm(known.kit.grid, placed.holes[k], placed.jaw_separation_mm);
      const auto p_GFoot_mm = placed.part_pose * fixture.pins[k].p_PFoot_mm;
      const geometry::Vector2d n_G = placed.part_pose.turned(fixture.pins[k].n_P);
      EXPECT_LT((p_GHole_mm + known.kit.pins.radius_mm * n_G - p_GFoot_mm).norm(), 1e-8);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Planar, KnownCases,
                         testing::Values("triangle", "lshape", "pentagon", "star12", "arcs"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace pinjaw::planner

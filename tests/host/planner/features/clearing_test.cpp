#include "host/planner/features/clearing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/base/random.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Interval;
using geometry::Vector2d;

Path line_path() {
  return {.along = Vector2d(0.8, 0.6)};
}

Path round_path(double radius_mm) {
  return {.round = true, .origin_mm = {3, 1}, .radius_mm = radius_mm, .from_rad = 0.4, .mm_per_rad = 6};
}

double distance_mm(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double t = ab.squaredNorm() > 0 ? std::clamp(ab.dot(p - a) / ab.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

/// Distance to the filled triangle, by its definition.
double distance_mm(const Vector2d& p, const ConvexPolygon& triangle) {
  const auto& [a, b, c, unused] = triangle.corners_mm;
  const auto side = [&](const Vector2d& from, const Vector2d& to) {
    return (to - from).x() * (p - from).y() - (to - from).y() * (p - from).x() > 0;
  };
  if (side(a, b) == side(b, c) && side(b, c) == side(c, a)) return 0;
  return std::min({distance_mm(p, a, b), distance_mm(p, b, c), distance_mm(p, c, a)});
}

void expect_the_same_as_sampling(const Path& path, base::Random& random) {
  constexpr double kReachMm = 1.2;
  const Interval within_mm{0, 20};
  for (int round = 0; round < 300; ++round) {
    ConvexPolygon triangle;
    triangle.size = 3;
    const double size_mm = round % 3 == 0 ? 0.05 : 6;
    const Vector2d middle_mm(random.uniform(-10, 18), random.uniform(-10, 14));
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.corners_mm[i] =
          middle_mm + Vector2d(random.uniform(-size_mm, size_mm), random.uniform(-size_mm, size_mm));
    }
    std::vector<Interval> stretches;
    add_near_stretches(path, triangle, kReachMm, within_mm, stretches);
    for (int sample = 0; sample < 100; ++sample) {
      const double s_mm = random.uniform(0, 20);
      const double gap_mm = distance_mm(path.point_at(s_mm), triangle) - kReachMm;
      if (std::abs(gap_mm) < 1e-9) continue;
      const bool inside = std::ranges::any_of(stretches, [&](const Interval& i) { return i.contains(s_mm); });
      EXPECT_EQ(inside, gap_mm < 0) << "round " << round << " s " << s_mm << " gap " << gap_mm;
    }
  }
}

TEST(Clearing, of_a_straight_path_agrees_with_the_distance_at_every_sample) {
  base::Random random(11);
  expect_the_same_as_sampling(line_path(), random);
}

TEST(Clearing, of_a_path_round_a_boss_agrees_with_the_distance_at_every_sample) {
  base::Random random(12);
  expect_the_same_as_sampling(round_path(8), random);
}

TEST(Clearing, of_a_path_that_has_passed_the_centre_agrees_with_the_distance_at_every_sample) {
  base::Random random(13);
  expect_the_same_as_sampling(round_path(-2.5), random);
}

TEST(Clearing, of_a_path_that_stands_still_is_all_or_nothing) {
  ConvexPolygon triangle{.corners_mm = {Vector2d(2, 0), Vector2d(4, 0), Vector2d(3, 2)}, .size = 3};
  std::vector<Interval> stretches;
  add_near_stretches(round_path(0), triangle, 1, {0, 5}, stretches);
  ASSERT_EQ(stretches.size(), 1U);
  EXPECT_EQ(stretches[0], (Interval{0, 5}));
}

TEST(Clearing, touching_is_no_nearness) {
  const ConvexPolygon point{.corners_mm = {Vector2d(0.8 * 5 - 0.6, 0.6 * 5 + 0.8)}, .size = 1};
  std::vector<Interval> stretches;
  add_near_stretches(line_path(), point, 1 - 1e-12, {0, 10}, stretches);
  EXPECT_TRUE(stretches.empty());
}

}  // namespace
}  // namespace pinjaw::planner

#include "host/geometry/convex.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/base/random.hpp"

namespace pinjaw::geometry {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

SweptCylinder pin(const Vector2d& from, const Vector2d& to, double radius_mm, Interval z_mm) {
  return {{from, to, radius_mm}, z_mm};
}

TEST(Overlap, concentric_and_equal_solids_overlap) {
  const Solid a = pin({1, 2}, {1, 2}, 2, {0, 10});
  EXPECT_EQ(overlap(a, a), Overlap::Overlapping);
  EXPECT_EQ(overlap(a, pin({1, 2}, {1, 2}, 1, {4, 5})), Overlap::Overlapping);
}

TEST(Overlap, solids_one_above_the_other_are_apart) {
  EXPECT_EQ(overlap(pin({0, 0}, {5, 0}, 2, {0, 10}), pin({0, 0}, {5, 0}, 2, {10.001, 20})), Overlap::Apart);
  EXPECT_EQ(overlap(pin({0, 0}, {5, 0}, 2, {0, 10}), pin({0, 0}, {5, 0}, 2, {9.99, 20})),
            Overlap::Overlapping);
}

TEST(Overlap, an_infinite_end_reaches_every_height) {
  const Solid column = pin({0, 0}, {0, 0}, 2, {-kEndless, 5});
  EXPECT_EQ(overlap(column, pin({3, 0}, {9, 0}, 1.01, {-1000, -900})), Overlap::Overlapping);
  EXPECT_EQ(overlap(column, pin({3, 0}, {9, 0}, 0.99, {-1000, -900})), Overlap::Apart);
  EXPECT_EQ(overlap(column, pin({1, 0}, {9, 0}, 1, {4, kEndless})), Overlap::Overlapping);
  EXPECT_EQ(overlap(column, pin({1, 0}, {9, 0}, 1, {6, kEndless})), Overlap::Apart);
  EXPECT_EQ(overlap(column, pin({1, 0}, {9, 0}, 1, {-kEndless, kEndless})), Overlap::Overlapping);
}

TEST(Overlap, a_pin_beside_a_turned_block_is_apart_until_it_reaches_the_corner) {
  const Vector2d diagonal = Vector2d(1, 1).normalized();
  const Solid block = Block{{{0, 0}, diagonal, {10, 10}}, {0, 5}};
  const double corner_mm = 10 * std::sqrt(2.0);
  EXPECT_EQ(overlap(block, pin({corner_mm + 2.001, 0}, {30, 0}, 2, {1, 9})), Overlap::Apart);
  EXPECT_EQ(overlap(block, pin({corner_mm + 1.999, 0}, {30, 0}, 2, {1, 9})), Overlap::Overlapping);
}

TEST(PlanDistance, crossing_paths_are_not_apart) {
  EXPECT_EQ(plan_distance_mm(Sweep{{-5, 0}, {5, 0}, 0}, Sweep{{0, -5}, {0, 5}, 0}), 0);
  EXPECT_NEAR(plan_distance_mm(Sweep{{-5, 0}, {5, 0}, 1}, Sweep{{0, 4}, {0, 9}, 1}), 2, 1e-12);
  EXPECT_NEAR(plan_distance_mm(Sweep{{-5, 0}, {5, 0}, 1}, Sweep{{8, 4}, {9, 9}, 1}), 3, 1e-12);
  EXPECT_NEAR(plan_distance_mm(Sweep{{-5, 0}, {5, 0}, 1}, Sweep{{-9, 3}, {9, 3}, 1}), 1, 1e-12);
}

TEST(PlanDistance, a_path_inside_or_across_a_rectangle_is_not_apart) {
  const Rectangle r{{0, 0}, Vector2d::UnitY(), {5, 2}};  // 4 wide along x, 10 along y
  EXPECT_EQ(plan_distance_mm(Sweep{{0, 0}, {1, 1}, 0}, r), 0);
  EXPECT_EQ(plan_distance_mm(Sweep{{-9, 0}, {9, 0}, 0}, r), 0);
  EXPECT_NEAR(plan_distance_mm(Sweep{{-9, 0}, {-4, 0}, 0.5}, r), 1.5, 1e-12);
  EXPECT_NEAR(plan_distance_mm(Sweep{{5, 9}, {5, 12}, 1}, r), 4, 1e-12);
}

SweptCylinder random_pin(base::Random& random) {
  const Vector2d from{random.uniform(-10, 10), random.uniform(-10, 10)};
  const bool still = random.uniform() < 0.4;
  const Vector2d to = still ? from : Vector2d(random.uniform(-10, 10), from.y());
  const double z_mm = random.uniform(-5, 5);
  return {{from, to, random.uniform(0.5, 4)}, {z_mm, z_mm + random.uniform(0.1, 20)}};
}

Block random_block(base::Random& random) {
  const double z_mm = random.uniform(-5, 5);
  return {{{random.uniform(-10, 10), random.uniform(-10, 10)},
           direction(random.uniform(0, 6)),
           {random.uniform(0.5, 20), random.uniform(0.5, 20)}},
          {z_mm, z_mm + random.uniform(0.1, 20)}};
}

double z_gap_mm(const Interval& a, const Interval& b) {
  return std::max(a.lo - b.hi, b.lo - a.hi);
}

/// Upright solids overlap exactly where their plans and their z ranges do: an answer that needs no iteration.
template <class Other>
void expect_the_closed_form(const SweptCylinder& a, const Other& b, int* undecided) {
  constexpr double kMargin_mm = 1e-5;
  const double plan_mm = plan_distance_mm(a.plan, b.plan);
  auto thinner = a.plan;
  thinner.radius_mm -= kMargin_mm;
  const double z_mm = z_gap_mm(a.z_mm, b.z_mm);
  const Overlap found = overlap(a, b);
  EXPECT_EQ(found, overlap(b, a));
  if (found == Overlap::Undecided) ++*undecided;
  if (plan_mm > kMargin_mm || z_mm > kMargin_mm) {
    EXPECT_NE(found, Overlap::Overlapping);
  }
  if (plan_distance_mm(thinner, b.plan) == 0 && z_mm < -kMargin_mm) {
    EXPECT_NE(found, Overlap::Apart);
  }
}

TEST(Overlap, the_iteration_agrees_with_the_closed_form_on_random_solids) {
  base::Random random(11);
  int undecided = 0;
  for (int i = 0; i < 20000; ++i) {
    expect_the_closed_form(random_pin(random), random_pin(random), &undecided);
    expect_the_closed_form(random_pin(random), random_block(random), &undecided);
  }
  EXPECT_LE(undecided, 4);
}

TEST(Overlap, solids_a_hair_apart_or_into_each_other_are_told_apart) {
  base::Random random(12);
  int undecided = 0;
  for (int i = 0; i < 5000; ++i) {
    const SweptCylinder a = random_pin(random);
    SweptCylinder b = random_pin(random);
    b.z_mm = a.z_mm;
    const double gap_mm = plan_distance_mm(a.plan, b.plan);
    if (gap_mm == 0) continue;
    b.plan.radius_mm += gap_mm + (i % 2 == 0 ? 1e-4 : -1e-4);
    expect_the_closed_form(a, b, &undecided);
  }
  EXPECT_LE(undecided, 4);
}

}  // namespace
}  // namespace pinjaw::geometry

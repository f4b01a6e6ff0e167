#include "host/geometry/surface.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "host/base/random.hpp"
#include "tests/host/geometry/solids.hpp"
#include "tests/host/geometry/surface_referee.hpp"

namespace pinjaw::geometry {
namespace {

using testing::block;
using testing::blocks;
using testing::prism;

constexpr double kNowhere_mm = std::numeric_limits<double>::infinity();

Sweep disc(const Vector2d& center_mm, double radius_mm) {
  return {center_mm, center_mm, radius_mm};
}

TriangleMesh triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return {{a, b, c}, {{0, 1, 2}}, {7}};
}

/// z = 3 + x/2 over a large square.
TriangleMesh ramp() {
  TriangleMesh mesh{
      {{-100, -100, -47}, {100, -100, 53}, {100, 100, 53}, {-100, 100, -47}}, {{0, 1, 2}, {0, 2, 3}}, {0, 0}};
  return mesh;
}

TEST(Surface, an_empty_mesh_has_nothing_anywhere) {
  const Surface surface{TriangleMesh{}};
  EXPECT_EQ(surface.lowest_z_mm(disc({0, 0}, 1)), kNowhere_mm);
  EXPECT_EQ(surface.highest_z_mm(disc({0, 0}, 1)), -kNowhere_mm);
  EXPECT_FALSE(surface.first_hit({}));
  EXPECT_FALSE(surface.lowest_above({0, 0}));
  EXPECT_FALSE(surface.meets(disc({0, 0}, 1), {}));
}

TEST(Surface, a_facet_without_area_still_counts_as_the_piece_it_is) {
  const Surface needle{triangle({0, 0, 1}, {4, 0, 5}, {2, 0, 3})};
  EXPECT_NEAR(needle.lowest_z_mm(disc({2, 0}, 1)), 2, 1e-8);
  EXPECT_NEAR(needle.highest_z_mm(disc({2, 0}, 1)), 4, 1e-8);
  const Surface point{triangle({1, 1, 2}, {1, 1, 2}, {1, 1, 2})};
  EXPECT_EQ(point.lowest_z_mm(disc({1, 1}, 0)), 2);
  EXPECT_EQ(point.lowest_z_mm(disc({1, 2}, 0.5)), kNowhere_mm);
  EXPECT_FALSE(point.first_hit({{1, 1, 0}, Vector3d::UnitZ()}));
}

TEST(Surface, an_upright_facet_answers_along_its_trace) {
  // A wall along x = 0 whose lower edge rises from z = 0 at y = 0 to z = 10 at y = 10.
  const Surface wall{triangle({0, 0, 0}, {0, 10, 10}, {0, 0, 20})};
  EXPECT_NEAR(wall.lowest_z_mm(disc({3, 5}, 5)), 1, 1e-8);  // the chord is y in [1, 9]
  EXPECT_NEAR(wall.highest_z_mm(disc({3, 5}, 5)), 19, 1e-8);
  EXPECT_EQ(wall.lowest_z_mm(disc({3, 5}, 2.9)), kNowhere_mm);
}

TEST(Surface, the_lowest_point_of_a_slope_lies_on_the_rim_of_the_disc) {
  const Surface surface{ramp()};
  EXPECT_NEAR(surface.lowest_z_mm(disc({4, 7}, 2)), 3 + (4 - 2) / 2.0, 1e-8);
  EXPECT_NEAR(surface.highest_z_mm(disc({4, 7}, 2)), 3 + (4 + 2) / 2.0, 1e-8);
  const Sweep swept{{4, 7}, {10, -1}, 2};
  EXPECT_NEAR(surface.lowest_z_mm(swept), 3 + (4 - 2) / 2.0, 1e-8);
  EXPECT_NEAR(surface.highest_z_mm(swept), 3 + (10 + 2) / 2.0, 1e-8);
}

TEST(Surface, a_slab_cuts_facets_rather_than_leaving_them_out) {
  const Surface surface{ramp()};
  EXPECT_NEAR(surface.lowest_z_mm(disc({4, 7}, 2), {4.5, 5}), 4.5, 1e-8);
  EXPECT_NEAR(surface.highest_z_mm(disc({4, 7}, 2), {4.5, 5}), 5, 1e-8);
  EXPECT_EQ(surface.lowest_z_mm(disc({4, 7}, 2), {6.1, 9}), kNowhere_mm);
  EXPECT_EQ(surface.highest_z_mm(disc({4, 7}, 2), {1, 3.9}), -kNowhere_mm);
  EXPECT_TRUE(surface.meets(disc({4, 7}, 2), {4.5, 5}));
  EXPECT_FALSE(surface.meets(disc({4, 7}, 2), {6.1, 9}));
}

TEST(Surface, a_slab_finds_the_wall_between_two_floors) {
  const Surface surface{block({{0, 0, 0}, {10, 10, 10}})};
  EXPECT_EQ(surface.lowest_z_mm(disc({0, 5}, 1), {3, 7}), 3);
  EXPECT_EQ(surface.highest_z_mm(disc({0, 5}, 1), {3, 7}), 7);
  EXPECT_EQ(surface.lowest_z_mm(disc({5, 5}, 1), {3, 7}), kNowhere_mm)
      << "inside the block there is no surface";
}

TEST(Surface, a_touch_counts_and_a_gap_of_a_millionth_does_not) {
  const Surface surface{block({{0, 0, 2}, {10, 10, 10}})};
  EXPECT_EQ(surface.lowest_z_mm(disc({-3, 5}, 3)), 2);
  EXPECT_EQ(surface.lowest_z_mm(disc({-3 - 1e-6, 5}, 3)), kNowhere_mm);
  EXPECT_EQ(surface.lowest_z_mm({{-3, -20}, {-3, 20}, 3}), 2) << "sliding along a wall";
  EXPECT_EQ(surface.lowest_z_mm({{-3 - 1e-6, -20}, {-3 - 1e-6, 20}, 3}), kNowhere_mm);
  EXPECT_EQ(surface.lowest_z_mm(disc({-3, -4}, 5)), 2) << "a corner";
}

TEST(Surface, a_long_thin_sweep_at_an_angle_misses_what_its_bounding_box_holds) {
  const Surface surface{blocks({{{0, 0, 0}, {1, 1, 1}}, {{9, 9, 0}, {10, 10, 1}}, {{4, 4, 5}, {6, 6, 6}}})};
  EXPECT_EQ(surface.lowest_z_mm({{-2, 12}, {12, -2}, 1}), 5);
  EXPECT_EQ(surface.lowest_z_mm({{-2, -2}, {12, 12}, 1}), 0);
}

TEST(Surface, a_rectangle_meets_what_it_covers_and_no_more) {
  const Surface surface{block({{0, 0, 0}, {10, 10, 10}})};
  const Rectangle beside{{-3, 5}, Vector2d::UnitX(), {2.9, 1}};
  EXPECT_FALSE(surface.meets(beside, {}));
  EXPECT_TRUE(surface.meets(Rectangle{{-3, 5}, Vector2d::UnitX(), {3, 1}}, {}));
  const Vector2d diagonal = Vector2d(1, 1).normalized();
  EXPECT_FALSE(surface.meets(Rectangle{{-3, -3}, diagonal, {4.2, 20}}, {}));
  EXPECT_TRUE(surface.meets(Rectangle{{-3, -3}, diagonal, {4.25, 20}}, {}));
  EXPECT_TRUE(surface.meets(Rectangle{{5, 5}, diagonal, {1, 1}}, {-5, 0}))
      << "under a face larger than itself";
  EXPECT_FALSE(surface.meets(Rectangle{{5, 5}, diagonal, {1, 1}}, {1, 9}));
}

TEST(Surface, the_lowest_surface_above_a_point_names_its_face) {
  const Surface surface{blocks({{{0, 0, 5}, {10, 10, 6}}, {{2, 2, 1}, {4, 4, 3}}})};
  const auto under = surface.lowest_above({3, 3});
  ASSERT_TRUE(under);
  EXPECT_EQ(under->point_mm, Vector3d(3, 3, 1));
  EXPECT_EQ(under->normal, -Vector3d::UnitZ());
  EXPECT_EQ(under->face, 10) << "the second block's bottom";
  EXPECT_EQ(surface.lowest_above({8, 8})->point_mm.z(), 5);
  EXPECT_FALSE(surface.lowest_above({12, 3}));
}

TEST(Surface, a_ray_hits_from_either_side_and_not_at_its_origin) {
  const Surface surface{block({{0, 0, 0}, {10, 10, 10}})};
  EXPECT_NEAR(surface.first_hit({{5, 5, -4}, Vector3d::UnitZ()})->distance_mm, 4, 1e-12);
  EXPECT_NEAR(surface.first_hit({{5, 4, 5}, Vector3d::UnitZ()})->distance_mm, 5, 1e-12);
  EXPECT_NEAR(surface.first_hit({{5, 4, 0}, Vector3d::UnitZ()})->distance_mm, 10, 1e-12);
  EXPECT_EQ(surface.first_hit({{5, 4, -1}, Vector3d::UnitZ()})->normal, -Vector3d::UnitZ());
  EXPECT_FALSE(surface.first_hit({{5, 4, -1}, -Vector3d::UnitZ()}));
}

TEST(Surface, no_ray_slips_between_two_facets) {
  const Surface surface{testing::cylinder({{0.1, 0.2}, 3, 0, 0}, {0, 1}, 17)};
  const Vector2d center_mm{0.1, 0.2};
  for (int i = 0; i < 17; ++i) {
    const Vector2d corner = surface.mesh().vertices_mm[static_cast<std::size_t>(i)].head<2>();
    for (const double share : {0.1, 0.25, 0.5, 0.77, 0.9}) {
      const Vector2d on_fan = surface.mesh().vertices_mm[0].head<2>() * (1 - share) + corner * share;
      if (i > 1 && i < 16) {
        EXPECT_TRUE(surface.first_hit({{on_fan.x(), on_fan.y(), -3}, Vector3d::UnitZ()}))
            << i << " " << share;
      }
    }
    const Vector2d out = center_mm - corner;
    const Ray through_upright_edge{{corner.x() - out.x(), corner.y() - out.y(), 0.4},
                                   Vector3d(out.x(), out.y(), 0).normalized()};
    EXPECT_TRUE(surface.first_hit(through_upright_edge)) << i;
  }
}

TEST(Surface, answers_are_the_same_from_many_threads) {
  const Surface surface{testing::cylinder({{0, 0}, 30, 0, 0}, {2, 9}, 600)};
  const auto work = [&surface](double* sum) {
    base::Random random(5);
    for (int i = 0; i < 2000; ++i) {
      const Vector2d at{random.uniform(-31, 31), random.uniform(-31, 31)};
      if (surface.meets(disc(at, 2), {3, 4})) *sum += surface.lowest_z_mm({at, {0, 0}, 1}, {3, 4}) + at.x();
    }
  };
  std::array<double, 3> sums{};
  {
    const std::jthread a(work, &sums[0]);
    const std::jthread b(work, &sums[1]);
    work(&sums[2]);
  }
  EXPECT_NE(sums[2], 0);
  EXPECT_EQ(sums[0], sums[2]);
  EXPECT_EQ(sums[1], sums[2]);
}

TEST(Surface, ten_thousand_equal_facets_do_not_break_the_index) {
  TriangleMesh mesh;
  for (int i = 0; i < 10000; ++i) testing::append(mesh, triangle({0, 0, 1}, {1, 0, 1}, {0, 1, 1}));
  const Surface surface{mesh};
  EXPECT_EQ(surface.lowest_z_mm(disc({0.2, 0.2}, 0.1)), 1);
  EXPECT_EQ(surface.lowest_above({0.2, 0.2})->triangle, 0) << "the first of equals";
}

}  // namespace
}  // namespace pinjaw::geometry

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "host/planner/features/features.hpp"
#include "host/planner/heights/heights.hpp"
#include "tests/host/planner/features/feature_lists.hpp"
#include "tests/host/planner/features/made_shapes.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kPi = std::numbers::pi;

model::PinStock stock(double engagement_mm = 1) {
  model::PinStock pins;
  pins.radius_mm = 2;
  pins.min_engagement_mm = engagement_mm;
  return pins;
}

Features found_on(const part::Shape& shape) {
  return find_features(part_of(shape), stock());
}

void expect_fates_add_up(const FeatureCounts& counts) {
  for (const FateCounts* of_kind : {&counts.edges, &counts.walls, &counts.silhouettes}) {
    int sum = 0;
    for (const Fate fate : kFates) sum += (*of_kind)[fate];
    EXPECT_EQ(sum, of_kind->total);
  }
}

TEST(Silhouettes, of_a_ball_are_its_equator_once) {
  for (const Vector3d& up : {Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(1, 2, 3)}) {
    const part::Part part = part_of(ball({0, 0, 0}, 10), part::upright_rotation(up));
    const Features found = find_features(part, stock());
    ASSERT_EQ(found.features.size(), 1U) << up.transpose();
    const auto& arc = std::get<geometry::Arc>(found.features[0].curve);
    EXPECT_LT(arc.center_mm.norm(), 1e-8);
    EXPECT_NEAR(arc.radius_mm, 10, 1e-8);
    EXPECT_NEAR(arc.sweep_rad, 2 * kPi, 1e-9);
    EXPECT_EQ(found.features[0].bulge, model::Bulge::Convex);
    EXPECT_FALSE(model::is_approximate(found.features[0]));
    EXPECT_EQ(found.counts.silhouettes[Fate::Kept], 1);
    expect_fates_add_up(found.counts);
  }
}

TEST(Silhouettes, lie_on_the_exact_surface) {
  const Vector3d axis = Vector3d(3, 1, 2).normalized();
  const part::Part part = part_of(ring({1, 2, 3}, axis, 20, 5));
  ASSERT_FALSE(part.surface.mesh().silhouettes.empty());
  int points = 0;
  double off_mm = 0;
  double lean_mm = 0;
  for (const auto& line : part.surface.mesh().silhouettes) {
    for (const Vector3d& p : line.points_mm) {
      // A torus is what lies at tube distance from its circle; its normal points away from the circle's
      // nearest point.
      const Vector3d spoke = p - Vector3d(1, 2, 3);
      const Vector3d in_plane = spoke - spoke.dot(axis) * axis;
      const Vector3d normal = spoke - 20 * in_plane.normalized();
      off_mm = std::max(off_mm, std::abs(normal.norm() - 5));
      lean_mm = std::max(lean_mm, std::abs(normal.z()));
      ++points;
    }
  }
  EXPECT_GT(points, 100);
  EXPECT_LT(off_mm, 1e-9);
  EXPECT_LT(lean_mm, 1e-9);
}

class LyingRod : public testing::TestWithParam<double> {};

TEST_P(LyingRod, has_its_two_sides_and_two_ends_wherever_its_seam_is) {
  const Features found = found_on(rod({-30, 0, 0}, Vector3d::UnitX(), 8, 60, GetParam()));
  ASSERT_EQ(found.features.size(), 4U);
  EXPECT_NEAR(total_length_mm(found.features), 2 * 60 + 2 * 16, 0.01);  // the mesh is a little narrower
  for (const model::Feature& feature : found.features) {
    EXPECT_FALSE(model::is_approximate(feature));
    const auto& segment = std::get<geometry::Segment>(feature.curve);
    const double y_mm = std::abs(segment.a_mm.y());
    const bool is_side = std::abs(segment.a_mm.y() - segment.b_mm.y()) < 1e-8;
    EXPECT_NEAR(is_side ? y_mm : std::abs(segment.a_mm.x()), is_side ? 8 : 30, 1e-8);
  }
  expect_fates_add_up(found.counts);
}

INSTANTIATE_TEST_SUITE_P(Seams, LyingRod, testing::Values(0.0, 0.3, kPi / 2, kPi, 2.0));

TEST(Silhouettes, of_a_tilted_rod_run_beside_its_axis) {
  const double tilt_rad = 0.4;
  const Vector3d axis(std::cos(tilt_rad), 0, std::sin(tilt_rad));
  const Features found = found_on(rod({0, 0, 0}, axis, 5, 40));
  const auto sides = std::ranges::count_if(found.features, [&](const model::Feature& feature) {
    const auto* segment = std::get_if<geometry::Segment>(&feature.curve);
    return segment != nullptr && std::abs(std::abs(segment->a_mm.y()) - 5) < 1e-8 &&
           std::abs(geometry::length_mm(feature.curve) - 40 * std::cos(tilt_rad)) < 1e-6;
  });
  EXPECT_EQ(sides, 2);
}

TEST(Silhouettes, of_a_cone_on_its_side_touch_both_end_circles) {
  // The axis lies in plan, so the generators with a horizontal normal are those at y = +r and y = -r.
  const Features found = found_on(cone({0, 0, 0}, Vector3d::UnitX(), 10, 5, 40));
  int sides = 0;
  for (const model::Feature& feature : found.features) {
    const auto* segment = std::get_if<geometry::Segment>(&feature.curve);
    ASSERT_NE(segment, nullptr);
    EXPECT_FALSE(model::is_approximate(feature));
    if (std::abs(segment->a_mm.x() - segment->b_mm.x()) < 1) continue;
    ++sides;
    const double at_0_mm = segment->a_mm.x() < 1 ? segment->a_mm.y() : segment->b_mm.y();
    const double at_40_mm = segment->a_mm.x() < 1 ? segment->b_mm.y() : segment->a_mm.y();
    EXPECT_NEAR(std::abs(at_0_mm), 10, 1e-6);
    EXPECT_NEAR(std::abs(at_40_mm), 5, 1e-6);
  }
  EXPECT_EQ(sides, 2);
}

TEST(Silhouettes, of_a_flat_ring_are_two_circles) {
  const Features found = found_on(ring({3, 4, 0}, Vector3d::UnitZ(), 20, 5));
  ASSERT_EQ(found.features.size(), 2U);
  std::vector<double> radii_mm;
  for (const model::Feature& feature : found.features) {
    const auto& arc = std::get<geometry::Arc>(feature.curve);
    EXPECT_LT((arc.center_mm - Vector2d(3, 4)).norm(), 1e-8);
    EXPECT_EQ(feature.bulge, arc.radius_mm > 20 ? model::Bulge::Convex : model::Bulge::Concave);
    EXPECT_FALSE(model::is_approximate(feature));
    radii_mm.push_back(arc.radius_mm);
  }
  std::ranges::sort(radii_mm);
  EXPECT_NEAR(radii_mm[0], 15, 1e-8);
  EXPECT_NEAR(radii_mm[1], 25, 1e-8);
}

TEST(Silhouettes, of_a_standing_ring_are_its_outline_and_not_its_inside) {
  // Seen along its plane a torus looks like a rounded bar, 50 long and 10 wide with half circles of radius 5
  // at its ends.
  const Features found = found_on(ring({0, 0, 0}, Vector3d::UnitY(), 20, 5));
  double reached_mm = 0;
  for (const model::Feature& feature : found.features) {
    for (const double share : {0.1, 0.5, 0.9}) {
      const Vector2d p_mm = geometry::point_at(feature.curve, share * geometry::length_mm(feature.curve));
      const double out_mm = std::max(std::abs(p_mm.x()) - 20, 0.0);
      // Where two silhouettes run together, within eps of each other, the surface jumps along both.
      EXPECT_NEAR(std::hypot(out_mm, p_mm.y()), 5, 2 * model::kEps_mm) << p_mm.transpose();
    }
    for (const auto& stretch : feature.reach_mm) reached_mm += stretch.length();
  }
  EXPECT_NEAR(reached_mm, 2 * 40 + 10 * kPi, 1);
}

/// Every feature of a part without hidden parts lies on its outline and together they close it.
TEST(Silhouettes, of_a_lofted_body_follow_it_within_the_error_that_they_state) {
  const part::Part part = part_of(lofted());
  const Features found = find_features(part, stock());
  double length_mm = 0;
  int approximate = 0;
  for (const model::Feature& feature : found.features) {
    length_mm += geometry::length_mm(feature.curve);
    approximate += model::is_approximate(feature) ? 1 : 0;
    EXPECT_LE(feature.error_mm, model::kEps_mm / 4);
    for (double share = 0.05; share < 1; share += 0.1) {
      const double along_mm = share * geometry::length_mm(feature.curve);
      const Vector2d p_mm = geometry::point_at(feature.curve, along_mm);
      const Vector2d out = model::outward_normal_at(feature, along_mm);
      const double beside_mm = feature.error_mm + 0.006;  // and the mesh's chords
      EXPECT_TRUE(part.surface.lowest_above(p_mm - beside_mm * out)) << p_mm.transpose();
      EXPECT_FALSE(part.surface.lowest_above(p_mm + beside_mm * out)) << p_mm.transpose();
    }
  }
  EXPECT_GT(approximate, 4);
  EXPECT_GT(length_mm, 2 * 60 + 16 + 14);  // two waves and two flat ends
  expect_fates_add_up(found.counts);
}

TEST(Silhouettes, hidden_by_what_lies_below_are_no_features) {
  const Features found = found_on(fused(boxes({{{-20, -20, -20}, {20, 20, -12}}}), ball({0, 0, 0}, 10)));
  for (const model::Feature& feature : found.features)
    EXPECT_TRUE(std::holds_alternative<geometry::Segment>(feature.curve));
  const Features apart = found_on(fused(boxes({{{-4, -4, -20}, {4, 4, -5}}}), ball({0, 0, 0}, 10)));
  EXPECT_EQ(apart.features.size(),
            5U);  // the box's sides end on the ball under its equator, 4 mm and more higher
}

TEST(Silhouettes, of_a_bullnosed_plate_are_its_edge) {
  // Two quarter rounds meet in a smooth edge at half height; neither face turns over inside itself.
  part::Shape plate = boxes({{{0, 0, 0}, {60, 30, 6}}});
  plate = fused(plate, rod({0, 0, 3}, Vector3d::UnitX(), 3, 60, 0));
  plate = fused(plate, rod({0, 0, 3}, Vector3d::UnitX(), 3, 60, kPi / 2));
  const part::Part part = part_of(plate);
  const auto nose =
      std::ranges::count_if(find_features(part, stock()).features, [](const model::Feature& feature) {
        const auto* segment = std::get_if<geometry::Segment>(&feature.curve);
        return segment != nullptr && std::abs(segment->a_mm.y() + 3) < 1e-6 &&
               std::abs(segment->b_mm.y() + 3) < 1e-6;
      });
  EXPECT_EQ(nose, 1);
}

TEST(SilhouetteContact, is_one_point_at_the_silhouette_whatever_the_engagement) {
  for (const double radius_mm : {3.0, 8.0}) {
    const part::Part part = part_of(ball({0, 0, radius_mm}, radius_mm));
    for (const double engagement_mm : {0.3, 1.0, 2.5}) {
      model::PinStock pins = stock(engagement_mm);
      pins.protrusion_mm = engagement_mm;
      const Foot foot{{-radius_mm, 0}, Vector2d::UnitX()};
      const auto pin = pin_height(part.surface, pins, -2, foot);
      ASSERT_TRUE(pin) << radius_mm;
      EXPECT_NEAR(pin->z_edge_mm, radius_mm, 1e-6);
      EXPECT_NEAR(pin->contact_z_mm.lo, radius_mm, 1e-6);
      EXPECT_EQ(pin->contact_z_mm.lo, pin->contact_z_mm.hi);
      EXPECT_GE(pin->top_mm, radius_mm + engagement_mm);
    }
  }
}

TEST(SilhouetteContact, asks_for_a_pin_that_reaches_the_engagement_beyond_the_silhouette) {
  // What lies eps inside the foot is 0.57 mm lower than the equator; a stock pin that has its engagement over
  // that only does not hold the ball.
  const part::Part part = part_of(ball({0, 0, 8}, 8));
  model::PinStock pins = stock(0.5);
  const Foot foot{{-8, 0}, Vector2d::UnitX()};
  pins.protrusion_mm = 1;
  pins.lengths_mm = {8 + 2 + 0.1};
  const auto too_short = pin_height(part.surface, pins, -2, foot);
  ASSERT_FALSE(too_short);
  EXPECT_EQ(too_short.error(), HeightLoss::StockTooShort);
  pins.lengths_mm = {8 + 2 + 0.6};
  EXPECT_TRUE(pin_height(part.surface, pins, -2, foot));
}

TEST(SilhouetteContact, keeps_the_wall_that_stands_under_the_bulge) {
  // A keyhole section: a wall from 0 to 10 flush with a lying rod at 20 above a narrower neck.
  part::Shape shape = boxes({{{0, -5, 0}, {60, 5, 10}}, {{0, -2, 9}, {60, 2, 20}}});
  shape = fused(shape, rod({0, 0, 20}, Vector3d::UnitX(), 5, 60));
  const part::Part part = part_of(shape);
  const auto pin = pin_height(part.surface, stock(), -2, {{30, -5}, Vector2d::UnitY()});
  ASSERT_TRUE(pin);
  EXPECT_NEAR(pin->z_edge_mm, 0, 1e-9);
  EXPECT_NEAR(pin->contact_z_mm.lo, 0, 1e-9);
  EXPECT_NEAR(pin->contact_z_mm.hi, 20, 1e-6);
}

TEST(SilhouetteReach, ends_where_a_ceiling_leaves_less_than_the_engagement_above_the_silhouette) {
  const part::Shape under_plate = [](double gap_mm) {
    return fused(rod({0, 0, 8}, Vector3d::UnitX(), 8, 60), boxes({{{0, -30, 8 + gap_mm}, {60, 30, 24}}}));
  }(1.5);
  const auto sides = [](const Features& found) {
    return std::ranges::count_if(found.features, [](const model::Feature& feature) {
      const auto* segment = std::get_if<geometry::Segment>(&feature.curve);
      return segment != nullptr && std::abs(std::abs(segment->a_mm.y()) - 8) < 1e-6 &&
             std::abs(segment->a_mm.y() - segment->b_mm.y()) < 1e-6 && !feature.reach_mm.empty();
    });
  };
  EXPECT_EQ(sides(find_features(part_of(under_plate), stock(1))), 2);
  EXPECT_EQ(sides(find_features(part_of(under_plate), stock(2))), 0);
}

}  // namespace
}  // namespace pinjaw::planner

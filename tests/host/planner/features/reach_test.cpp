#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/random.hpp"
#include "host/planner/features/features.hpp"
#include "tests/host/planner/features/brep_part.hpp"

namespace pinjaw::planner {
namespace {

model::PinStock pins_of(double radius_mm) {
  model::PinStock pins;
  pins.radius_mm = radius_mm;
  pins.min_engagement_mm = 1;
  return pins;
}

double reach_mm(const Features& found) {
  double sum_mm = 0;
  for (const auto& feature : found.features) {
    for (const auto& stretch : feature.reach_mm) sum_mm += stretch.length();
  }
  return sum_mm;
}

/// By its definition (DESIGN 3.1 no. 4): the room over a closed pin's disc, in mm above what it needs.
double room_mm(const part::Part& part, const model::Feature& feature, double along_mm,
               const model::PinStock& pins) {
  const Vector2d foot_mm = geometry::point_at(feature.curve, along_mm);
  const Vector2d normal = model::outward_normal_at(feature, along_mm);
  const auto edge = part.surface.lowest_above(foot_mm - model::kEps_mm * normal);
  if (!edge) return -1;
  const Vector2d center_mm = foot_mm + pins.radius_mm * normal;
  const geometry::Sweep disc{center_mm, center_mm, pins.radius_mm - model::kEps_mm};
  return part.surface.lowest_z_mm(disc) - edge->point_mm.z() - pins.min_engagement_mm;
}

class Reach : public testing::TestWithParam<const char*> {};

TEST_P(Reach, is_where_the_disc_of_a_closed_pin_has_room_at_random_places) {
  const part::Part whole = part_of(shipped_shape(GetParam()));
  base::Random random(5);
  for (const model::Side side : {model::Side::Below, model::Side::Above}) {
    const part::Part part = part::turned(whole, side);
    const model::PinStock pins = pins_of(2.38125);
    int differ = 0;
    int places = 0;
    for (const model::Feature& feature : find_features(part, pins).features) {
      const double length_mm = geometry::length_mm(feature.curve);
      for (int i = 0; i < 12; ++i) {
        const double along_mm = random.uniform(0, length_mm);
        const bool at_an_end = std::ranges::any_of(feature.reach_mm, [&](const auto& stretch) {
          return std::min(std::abs(stretch.lo - along_mm), std::abs(stretch.hi - along_mm)) < 1e-4;
        });
        if (at_an_end) continue;
        const bool reached = std::ranges::any_of(
            feature.reach_mm, [&](const auto& stretch) { return stretch.contains(along_mm); });
        ++places;
        if (reached != (room_mm(part, feature, along_mm, pins) >= -1e-6)) ++differ;
      }
    }
    EXPECT_GT(places, 100);
    EXPECT_LE(differ, places / 200) << "of " << places;
  }
}

INSTANTIATE_TEST_SUITE_P(Parts, Reach,
                         testing::Values("valve_housing", "hex_flange", "thin_tray", "cassette_chassis"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(ReachOfABlock, is_all_of_its_outline) {
  const part::Part part = part_of(boxes({{{0, 0, 0}, {30, 20, 10}}}));
  const Features found = find_features(part, pins_of(2));
  EXPECT_EQ(found.counts.reachable, 4);
  EXPECT_NEAR(reach_mm(found), 100, 1e-9);
}

/// A slot of the given width, open below, along x through a block.
part::Part slotted(double width_mm) {
  return part_of(boxes({{{0, 0, 0}, {30, 10, 10}},
                        {{0, 10 + width_mm, 0}, {30, 20 + width_mm, 10}},
                        {{0, 0, 8}, {30, 20 + width_mm, 10}}}));
}

TEST(ReachInASlot, needs_the_pin_to_fit_but_for_eps) {
  const auto in_slot = [](double width_mm) {
    const Features found = find_features(slotted(width_mm), pins_of(2));
    double sum_mm = 0;
    for (const auto& feature : found.features) {
      const double y_mm = geometry::point_at(feature.curve, 1).y();
      if (y_mm < 5 || y_mm > 15 + width_mm) continue;
      for (const auto& stretch : feature.reach_mm) sum_mm += stretch.length();
    }
    return sum_mm;
  };
  EXPECT_NEAR(in_slot(4.1), 60, 1e-6);
  EXPECT_NEAR(in_slot(4.0), 60, 1e-6);
  EXPECT_LT(in_slot(3.9), 4);  // only where the pin sticks out of the slot's ends
}

TEST(ReachBesideAPost, ends_where_the_pin_would_touch_it) {
  // The post stands 3 mm before the block's face and reaches lower than it.
  const part::Part part =
      part_of(boxes({{{0, 0, 0}, {40, 10, 10}}, {{15, -5, -5}, {17, -3, 10}}, {{15, -5, 8}, {17, 0, 10}}}));
  const Features found = find_features(part, pins_of(2));
  const auto face = std::ranges::find_if(found.features, [](const model::Feature& feature) {
    return geometry::length_mm(feature.curve) > 30 && geometry::point_at(feature.curve, 1).y() == 0;
  });
  ASSERT_NE(face, found.features.end());
  ASSERT_EQ(face->reach_mm.size(), 2U);
  // centre at y = -2, disc 1.98, nearest post corners at y = -3
  const double aside_mm = std::sqrt(1.98 * 1.98 - 1);
  EXPECT_NEAR(face->reach_mm[0].length() + face->reach_mm[1].length(), 40 - 2 - 2 * aside_mm, 1e-9);
}

TEST(ReachBetweenPosts, finds_a_gap_of_a_hundredth_of_a_millimetre) {
  const double gap_mm = 2 * 1.98 + 0.01;
  const part::Part part = part_of(boxes({{{0, 0, 0}, {40, 10, 10}},
                                         {{5, -4, -5}, {15, 0, 10}},
                                         {{15 + gap_mm, -4, -5}, {25 + gap_mm, 0, 10}}}));
  const Features found = find_features(part, pins_of(2));
  const auto between = std::ranges::find_if(found.features, [&](const model::Feature& feature) {
    return std::abs(geometry::length_mm(feature.curve) - gap_mm) < 1e-6 &&
           geometry::point_at(feature.curve, 1).y() == 0;
  });
  ASSERT_NE(between, found.features.end());
  ASSERT_EQ(between->reach_mm.size(), 1U);
  EXPECT_NEAR(between->reach_mm[0].length(), 0.01, 1e-6);
}

TEST(ReachOfABore, needs_a_bore_wider_than_the_pin) {
  const part::Shape block = boxes({{{0, 0, 0}, {40, 40, 10}}});
  const auto bore_mm = [&](double radius_mm) {
    const Features found = find_features(part_of(drilled(block, {20, 20}, radius_mm, {-1, 11})), pins_of(2));
    const auto bore = std::ranges::find(found.features, model::Bulge::Concave, &model::Feature::bulge);
    return bore == found.features.end() || bore->reach_mm.empty() ? 0.0 : bore->reach_mm[0].length();
  };
  EXPECT_NEAR(bore_mm(5), 10 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(bore_mm(2.01), 2 * std::numbers::pi * 2.01, 1e-6);
  EXPECT_EQ(bore_mm(1.9), 0);
}

TEST(ReachUnderAnOverhang, needs_the_engagement) {
  const auto reachable = [](double ceiling_mm) {
    const part::Part part = part_of(boxes({{{10, 10, 0}, {20, 20, 10}}, {{0, 0, ceiling_mm}, {30, 30, 10}}}));
    return find_features(part, pins_of(2)).counts;
  };
  EXPECT_EQ(reachable(1.0).reachable, 8);
  EXPECT_EQ(reachable(0.9).features, 4);  // the inner block's edges do not even jump enough
}

}  // namespace
}  // namespace pinjaw::planner

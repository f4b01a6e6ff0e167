#include <gtest/gtest.h>

#include <set>

#include "host/planner/features/features.hpp"
#include "tests/host/planner/features/brep_part.hpp"
#include "tests/host/planner/features/feature_lists.hpp"

namespace pinjaw::planner {
namespace {

model::PinStock shipped_stock() {
  model::PinStock pins;
  pins.radius_mm = 2.38125;
  pins.min_engagement_mm = 1;
  return pins;
}

TEST(ValveHousing, has_its_features_from_below_counted) {
  const part::Part part = part_of(shipped_shape("valve_housing"));
  const Features found = find_features(part, shipped_stock());
  EXPECT_EQ(found.counts.edges.total, 408);
  EXPECT_EQ(found.counts.edges[Fate::Seam], 31);
  EXPECT_EQ(found.counts.edges[Fate::Upright], 87);
  EXPECT_EQ(found.counts.features, 66);
  EXPECT_EQ(found.counts.reachable, 51);
  EXPECT_NEAR(total_length_mm(found.features), 408.906 + 10.602, 0.01);
}

TEST(ValveHousing, has_other_features_from_above) {
  const part::Part part = part::turned(part_of(shipped_shape("valve_housing")), model::Side::Above);
  const Features found = find_features(part, shipped_stock());
  EXPECT_EQ(found.counts.features, 74);
  EXPECT_EQ(found.counts.reachable, 49);
}

/// No two features of one kind share their ends and free side.
void expect_each_once(const std::vector<model::Feature>& features) {
  for (const model::Feature& a : features) {
    for (const model::Feature& b : features) {
      if (a.id >= b.id || a.curve.index() != b.curve.index()) continue;
      const double difference_mm = difference(trace_of(a), trace_of(b));
      EXPECT_GT(difference_mm, 1e-3) << a.id << " and " << b.id;
    }
  }
}

TEST(ShippedParts, have_each_feature_once_with_reach_inside_it) {
  for (const char* name : {"valve_housing", "cassette_chassis", "glue_gun_housing", "gear", "thin_tray"}) {
    const Features found = find_features(part_of(shipped_shape(name)), shipped_stock());
    expect_each_once(found.features);
    int id = 0;
    for (const model::Feature& feature : found.features) {
      EXPECT_EQ(feature.id, id++);
      EXPECT_GT(feature.edge, 0);
      double end_mm = 0;
      for (const auto& stretch : feature.reach_mm) {
        EXPECT_GE(stretch.lo, end_mm) << name;
        EXPECT_GT(stretch.hi, stretch.lo) << name;
        end_mm = stretch.hi;
      }
      EXPECT_LE(end_mm, geometry::length_mm(feature.curve) + 1e-9) << name;
    }
  }
}

TEST(GlueGun, has_the_smooth_edge_above_its_fillet_as_outline) {
  const part::Part part = part_of(shipped_shape("glue_gun_housing"));
  bool outline_found = false;
  for (const model::Feature& feature : find_features(part, shipped_stock()).features) {
    const double middle_mm = geometry::length_mm(feature.curve) / 2;
    const geometry::Vector2d point_mm = geometry::point_at(feature.curve, middle_mm);
    const geometry::Vector2d normal = model::outward_normal_at(feature, middle_mm);
    const auto edge = part.surface.lowest_above(point_mm - model::kEps_mm * normal);
    ASSERT_TRUE(edge);
    const bool outermost = !part.surface.lowest_above(point_mm + model::kEps_mm * normal);
    if (outermost && edge->point_mm.z() > 4 && edge->point_mm.z() < 5) outline_found = true;
  }
  EXPECT_TRUE(outline_found);
}

}  // namespace
}  // namespace pinjaw::planner

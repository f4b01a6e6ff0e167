#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "tests/host/part/shipped_parts.hpp"

namespace pinjaw::part {
namespace {

constexpr double kPi = std::numbers::pi;

/// A rounded plate with a clockwise round hole in two half arcs: one straight end at x = 0, one half round at
/// x = 30.
model::Profile rounded_plate() {
  using geometry::Arc;
  using geometry::Segment;
  model::Profile profile{.name = "plate", .thickness_mm = 5, .loops = {}};
  profile.loops.push_back({{.curve = Segment{{0, 0}, {30, 0}}},
                           {.curve = Arc{{30, 10}, 10, -kPi / 2, kPi}},
                           {.curve = Segment{{30, 20}, {0, 20}}},
                           {.curve = Segment{{0, 20}, {0, 0}}, .graspable = false}});
  profile.loops.push_back({{.curve = Arc{{12, 10}, 4, 0, kPi}, .reversed = true},
                           {.curve = Arc{{12, 10}, 4, kPi, kPi}, .reversed = true}});
  return profile;
}

model::PartSource source_with(const model::Profile& profile) {
  model::PartSource source;
  source.file = std::filesystem::path(testing::TempDir()) / (profile.name + ".yaml");
  std::ofstream(source.file) << "profile: " << profile.name << "\n";
  source.density_g_cm3 = 1;
  source.profile = profile;
  return source;
}

TEST(ProfilePart, has_the_volume_of_its_loops_times_its_thickness) {
  const auto part = read_part(source_with(rounded_plate()));
  ASSERT_TRUE(part) << part.error().message;
  const double area_mm2 = 30 * 20 + 50 * kPi - 16 * kPi;
  EXPECT_NEAR(part->volume_mm3, 5 * area_mm2, 1e-9 * area_mm2);
  EXPECT_NEAR(part->centroid_mm.y(), 10, 1e-9);
  EXPECT_NEAR(part->centroid_mm.z(), 2.5, 1e-9);
  EXPECT_NEAR(enclosed_mm3(part->surface.mesh()), part->volume_mm3, 1e-3 * part->volume_mm3);
  EXPECT_EQ(part->name, "plate");
  EXPECT_EQ(part->sha256.size(), 64U);
  EXPECT_EQ(part->surface.z_range_mm().lo, 0);
  EXPECT_EQ(part->surface.z_range_mm().hi, 5);
}

TEST(ProfilePart, may_have_a_hole_of_one_full_arc) {
  model::Profile profile = rounded_plate();
  profile.loops[1] = {{.curve = geometry::Arc{{12, 10}, 4, 0.5, 2 * kPi}, .reversed = true}};
  const auto part = read_part(source_with(profile));
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_NEAR(part->volume_mm3, 5 * (600 + 34 * kPi), 1e-6);
}

TEST(ProfilePart, joins_ends_that_differ_by_the_rounding_of_a_file) {
  model::Profile profile = rounded_plate();
  std::get<geometry::Segment>(profile.loops[0][0].curve).b_mm.x() += 3e-5;
  EXPECT_TRUE(read_part(source_with(profile)));
}

TEST(ProfilePart, says_when_its_loops_cross) {
  model::Profile profile = rounded_plate();
  profile.loops[0] = {{.curve = geometry::Segment{{0, 0}, {10, 10}}},
                      {.curve = geometry::Segment{{10, 10}, {10, 0}}},
                      {.curve = geometry::Segment{{10, 0}, {0, 10}}},
                      {.curve = geometry::Segment{{0, 10}, {0, 0}}}};
  profile.loops.resize(1);
  const auto part = read_part(source_with(profile));
  ASSERT_FALSE(part);
  EXPECT_THAT(part.error().message, testing::HasSubstr("profile plate: "));
}

TEST(ProfilePart, says_when_it_has_no_loop) {
  model::Profile profile = rounded_plate();
  profile.loops.clear();
  const auto part = read_part(source_with(profile));
  ASSERT_FALSE(part);
  EXPECT_THAT(part.error().message, testing::HasSubstr("profile plate: no outer loop"));
}

void expect_material_on_the_left(const Part& part) {
  ASSERT_TRUE(part.profile);
  for (const model::Feature& feature : model::features_of(*part.profile)) {
    const double middle_mm = geometry::length_mm(feature.curve) / 2;
    const Vector2d foot_mm = geometry::point_at(feature.curve, middle_mm);
    const Vector2d normal = model::outward_normal_at(feature, middle_mm);
    EXPECT_TRUE(part.surface.lowest_above(foot_mm - 0.1 * normal)) << feature.loop << "." << feature.edge;
    EXPECT_FALSE(part.surface.lowest_above(foot_mm + 0.1 * normal)) << feature.loop << "." << feature.edge;
  }
}

TEST(ProfilePart, keeps_loop_and_edge_numbers_and_its_material_on_the_left_however_it_lies) {
  for (const Vector3d& up : {Vector3d(0, 0, 1), Vector3d(0, 0, -1)}) {
    model::PartSource source = source_with(rounded_plate());
    source.up = up;
    const auto part = read_part(source);
    ASSERT_TRUE(part) << part.error().message;
    for (const model::Side side : {model::Side::Below, model::Side::Above}) {
      const Part seen = turned(*part, side);
      expect_material_on_the_left(seen);
      const auto features = model::features_of(*seen.profile);
      ASSERT_EQ(features.size(), 5U);
      EXPECT_EQ(features[4].loop, 1);
      EXPECT_EQ(features[4].edge, 1);
      EXPECT_EQ(features[3].bulge, model::Bulge::Concave);
    }
  }
}

TEST(ProfilePart, is_a_plain_solid_once_it_stands_on_its_side) {
  model::PartSource source = source_with(rounded_plate());
  source.up = {0, 1, 0};
  const auto part = read_part(source);
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_FALSE(part->profile);
  EXPECT_NEAR(part->surface.z_range_mm().length(), 20, 1e-3);
  EXPECT_NEAR(part->surface.y_range_mm().length(), 5, 1e-9);
}

TEST(ProfilePart, must_have_been_read_before) {
  model::PartSource source = source_with(rounded_plate());
  source.profile.reset();
  const auto part = read_part(source);
  ASSERT_FALSE(part);
  EXPECT_THAT(part.error().message, testing::HasSubstr("plate.yaml: not a part file"));
}

}  // namespace
}  // namespace pinjaw::part

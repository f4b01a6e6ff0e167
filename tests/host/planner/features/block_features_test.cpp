#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "host/planner/features/features.hpp"
#include "tests/host/planner/features/brep_part.hpp"
#include "tests/host/planner/features/feature_lists.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kPi = std::numbers::pi;

model::PinStock stock() {
  model::PinStock pins;
  pins.radius_mm = 2;
  pins.min_engagement_mm = 1;
  return pins;
}

Features found_on(const part::Shape& shape) {
  return find_features(part_of(shape), stock());
}

int arcs_in(const Features& found) {
  return static_cast<int>(std::ranges::count_if(found.features, [](const model::Feature& feature) {
    return std::holds_alternative<geometry::Arc>(feature.curve);
  }));
}

const Box3 kBlock{{0, 0, 0}, {30, 20, 10}};

TEST(BlockFeatures, are_its_four_sides_once_with_the_material_on_the_left) {
  const Features found = found_on(boxes({kBlock}));
  ASSERT_EQ(found.features.size(), 4U);
  EXPECT_NEAR(total_length_mm(found.features), 100, 1e-9);
  for (const model::Feature& feature : found.features) {
    const Trace trace = trace_of(feature);
    const Vector2d to_middle = Vector2d(15, 10) - trace.middle_mm;
    EXPECT_LT(trace.normal.dot(to_middle), 0) << feature.id;
  }
  EXPECT_EQ(found.counts.edges.total, 12);
  EXPECT_EQ(found.counts.edges[Fate::Upright], 4);
  EXPECT_EQ(found.counts.edges[Fate::Kept], 4);
  EXPECT_EQ(found.counts.edges[Fate::Coincident], 4);  // those of the top
  EXPECT_EQ(found.counts.walls.total, 4);
  EXPECT_EQ(found.counts.silhouettes.total, 0);
  EXPECT_EQ(found.counts.edgelets, 4);
  EXPECT_EQ(found.counts.visible, 4);
}

TEST(BlockFeatures, lie_on_the_block_exactly) {
  for (const model::Feature& feature : found_on(boxes({kBlock})).features) {
    const auto& segment = std::get<geometry::Segment>(feature.curve);
    for (const Vector2d& p : {segment.a_mm, segment.b_mm}) {
      EXPECT_TRUE((p.x() == 0 || p.x() == 30) && (p.y() == 0 || p.y() == 20)) << p.transpose();
    }
    EXPECT_FALSE(model::is_approximate(feature));
  }
}

TEST(BlockFeatures, have_an_arc_for_each_hole_that_is_deep_enough) {
  part::Shape shape = drilled(boxes({kBlock}), {8, 10}, 3, {-1, 11});
  shape = drilled(shape, {22, 10}, 4, {-1, 5});
  shape = drilled(shape, {15, 16}, 1.5, {-1, 0.9});  // shallower than the engagement
  shape = drilled(shape, {15, 4}, 1.5, {5, 11});     // open above only
  const Features found = found_on(shape);
  EXPECT_EQ(found.features.size(), 6U);
  ASSERT_EQ(arcs_in(found), 2);
  for (const model::Feature& feature : found.features) {
    const auto* arc = std::get_if<geometry::Arc>(&feature.curve);
    if (arc == nullptr) continue;
    EXPECT_EQ(feature.bulge, model::Bulge::Concave);
    EXPECT_NEAR(arc->sweep_rad, 2 * kPi, 1e-12);
    EXPECT_NEAR(arc->radius_mm, arc->center_mm.x() < 15 ? 3 : 4, 1e-12);
  }
}

TEST(BlockFeatures, of_a_hole_cut_by_a_side_end_where_the_side_is) {
  const Features found = found_on(drilled(boxes({kBlock}), {0, 10}, 4, {-1, 11}));
  EXPECT_EQ(found.features.size(), 6U);
  ASSERT_EQ(arcs_in(found), 1);
  EXPECT_NEAR(total_length_mm(found.features), 100 - 8 + 4 * kPi, 1e-9);
}

TEST(BlockFeatures, of_a_boss_below_is_a_convex_arc) {
  const part::Shape with_ring =
      drilled(drilled(boxes({{{-20, -20, 0}, {20, 20, 10}}}), {0, 0}, 15, {-1, 5}), {40, 0}, 1, {0, 1});
  const Features found = found_on(with_ring);
  ASSERT_EQ(arcs_in(found), 1);
  EXPECT_EQ(std::ranges::count(found.features, model::Bulge::Concave, &model::Feature::bulge), 1);
}

TEST(BlockFeatures, join_over_the_corners_of_what_stands_above) {
  // A rib on top ends in the middle of the block's long sides.
  const Features found = found_on(boxes({kBlock, {{10, 0, 10}, {12, 20, 15}}}));
  EXPECT_EQ(found.features.size(), 4U);
  EXPECT_NEAR(total_length_mm(found.features), 100, 1e-9);
}

TEST(BlockFeatures, run_on_through_several_heights) {
  // Two blocks side by side with one common front, the second 3 mm higher: one feature, as it jumps all
  // along.
  const Features found = found_on(boxes({{{0, 0, 0}, {10, 20, 10}}, {{10, 0, 3}, {30, 20, 10}}}));
  const auto front = std::ranges::find_if(
      found.features, [](const model::Feature& feature) { return trace_of(feature).middle_mm.y() == 0; });
  ASSERT_NE(front, found.features.end());
  EXPECT_NEAR(geometry::length_mm(front->curve), 30, 1e-9);
  EXPECT_EQ(found.features.size(), 5U);  // and the step between them
}

TEST(BlockFeatures, end_where_a_lower_flange_begins) {
  const Features found = found_on(boxes({{{0, 0, 5}, {30, 20, 10}}, {{10, -5, 0}, {20, 25, 5}}}));
  const auto fronts = std::ranges::count_if(found.features, [](const model::Feature& feature) {
    return std::abs(trace_of(feature).middle_mm.y()) < 1e-9;
  });
  EXPECT_EQ(fronts, 2);  // what lies over the flange does not jump
}

TEST(BlockFeatures, of_a_chamfer_are_its_outer_edges_only) {
  const Features found = found_on(chamfered_box(kBlock, 0.5));
  EXPECT_EQ(found.features.size(), 4U);
  EXPECT_NEAR(total_length_mm(found.features), 100, 1e-6);
}

TEST(BlockFeatures, of_a_fillet_are_its_outer_edges_only) {
  const Features found = found_on(filleted_box({{0, 0, 0}, {60, 40, 20}}, 5));
  EXPECT_EQ(found.features.size(), 4U);
  EXPECT_NEAR(total_length_mm(found.features), 200, 1e-6);
}

TEST(BlockFeatures, fade_where_a_sloping_ceiling_comes_under_the_engagement) {
  // Beside the block a wedge-like ceiling rises from 0 to 3 mm: the wall counts from 1 mm on.
  geometry::TriangleMesh mesh;
  mesh.vertices_mm = {{0, 0, 0}, {30, 0, 0}, {30, 10, 0}, {0, 10, 0}, {0, -10, 0}, {30, -10, 3}, {30, 0, 3}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 5, 4}, {0, 6, 5}};
  mesh.face_of = {1, 1, 2, 2};
  const part::Part part{.name = "ramp",
                        .file = {},
                        .sha256 = {},
                        .surface = geometry::Surface(mesh),
                        .edges = {{.edge = 1, .curve = part::Line3{{0, 0, 0}, {30, 0, 0}}, .faces = {1}}},
                        .walls = {},
                        .contours = {},
                        .edge_counts = {},
                        .solids = {},
                        .profile = {}};
  const Features found = find_features(part, stock());
  ASSERT_EQ(found.features.size(), 1U);
  const auto& segment = std::get<geometry::Segment>(found.features[0].curve);
  EXPECT_NEAR(std::min(segment.a_mm.x(), segment.b_mm.x()), 10, 1e-4 + 0.02);
  EXPECT_NEAR(std::max(segment.a_mm.x(), segment.b_mm.x()), 30, 1e-9);
}

TEST(BlockFeatures, follow_the_part_when_another_axis_is_up) {
  const part::Shape shape = boxes({kBlock, {{5, 5, 10}, {25, 15, 14}}});
  for (const Vector3d& up : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0),
                             Vector3d(0, 0, 1), Vector3d(0, 0, -1)}) {
    const Features found = find_features(part_of(shape, part::upright_rotation(up)), stock());
    const std::size_t expected = up.z() > 0 ? 4 : up.z() < 0 ? 8 : 7;  // lying, block and rib share a side
    EXPECT_EQ(found.features.size(), expected) << up.transpose();
  }
}

class TurnedPart : public testing::TestWithParam<const char*> {};

TEST_P(TurnedPart, has_the_features_of_the_part_turned) {
  const part::Shape shape = shipped_shape(GetParam());
  const double angle_rad = 37 * kPi / 180;
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()).toRotationMatrix();
  const Features plain = find_features(part_of(shape), stock());
  const Features turned = find_features(part_of(shape, rotation), stock());
  const geometry::Pose2 turn{angle_rad, Vector2d::Zero()};
  const int missing = without_equal(plain.features, turned.features, 1e-3, [&](const Trace& trace) -> Trace {
    return {turn * trace.from_mm, turn * trace.middle_mm, turn * trace.to_mm, turn * trace.normal,
            trace.length_mm};
  });
  EXPECT_EQ(missing, 0);
  EXPECT_EQ(plain.features.size(), turned.features.size());
  EXPECT_EQ(plain.counts.reachable, turned.counts.reachable);
}

INSTANTIATE_TEST_SUITE_P(Parts, TurnedPart, testing::Values("l_bracket", "valve_housing", "connecting_rod"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(ProfileFeatures, are_those_of_the_solid_it_extrudes_to) {
  using geometry::Arc;
  using geometry::Segment;
  model::Profile profile{.name = "plate", .thickness_mm = 5, .loops = {}};
  profile.loops.push_back({{.curve = Segment{{0, 0}, {30, 0}}},
                           {.curve = Arc{{30, 10}, 10, -kPi / 2, kPi}},
                           {.curve = Segment{{30, 20}, {0, 20}}},
                           {.curve = Segment{{0, 20}, {0, 0}}}});
  profile.loops.push_back({{.curve = Arc{{12, 10}, 4, 0, 2 * kPi}, .reversed = true}});
  const auto prism = part::prism_of(profile);
  ASSERT_TRUE(prism) << prism.error().message;
  part::Part part = part_of(*prism);
  const Features solid = find_features(part, stock());
  part.profile = profile;
  const Features flat = find_features(part, stock());
  EXPECT_EQ(solid.features.size(), 5U);
  EXPECT_EQ(flat.features.size(), 5U);
  EXPECT_EQ(without_equal(flat.features, solid.features, 1e-9, unmoved), 0);
  EXPECT_EQ(flat.features[4].loop, 1);
  EXPECT_EQ(flat.counts.reachable, 5);
}

}  // namespace
}  // namespace pinjaw::planner

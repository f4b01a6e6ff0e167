#include "host/planner/why/near_miss.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "host/planner/features/features.hpp"
#include "tests/host/planner/why/spoilt.hpp"

namespace pinjaw::planner {
namespace {

const NearMiss& miss_of(const std::vector<NearMiss>& misses, const std::string& reason) {
  const auto found = std::ranges::find(misses, reason, &NearMiss::reason);
  if (found == misses.end()) throw std::runtime_error("no miss " + reason);
  return *found;
}

TEST(NearMiss, of_too_little_travel_is_the_separation_from_which_fixtures_exist) {
  Spoilt job = spoilt(shorten_travel);
  ASSERT_EQ(job.plan.funnel.planar, 0);
  const auto misses = job.misses();
  const NearMiss& miss = misses.front();
  EXPECT_EQ(miss.phase, "planar");
  ASSERT_TRUE(miss.gap);
  EXPECT_EQ(miss.gap->has, 2);
  job.task.kit.jaws.separation_mm.hi = miss.gap->needs - 1e-3;
  EXPECT_EQ(plan_or_throw(job.task, job.scene).funnel.planar, 0);
  job.task.kit.jaws.separation_mm.hi = miss.gap->needs + 1e-6;
  EXPECT_GT(plan_or_throw(job.task, job.scene).funnel.planar, 0);
}

TEST(NearMiss, of_too_wide_a_foot_margin_is_the_widest_that_a_fixture_has) {
  Spoilt job = spoilt([](model::Task& task) { task.kit.pins.min_foot_margin_mm = 18; });
  ASSERT_EQ(job.plan.funnel.planar, 0);
  const auto misses = job.misses();
  const NearMiss& miss = miss_of(misses, "feet too near the ends of their features");
  ASSERT_TRUE(miss.gap);
  job.task.kit.pins.min_foot_margin_mm = miss.gap->has + 1e-3;
  EXPECT_EQ(plan_or_throw(job.task, job.scene).funnel.planar, 0);
  job.task.kit.pins.min_foot_margin_mm = miss.gap->has - 1e-6;
  EXPECT_GT(plan_or_throw(job.task, job.scene).funnel.planar, 0);
}

TEST(NearMiss, of_stock_too_short_is_the_plate_gap_and_the_engagement) {
  const Spoilt job = spoilt([](model::Task& task) { task.kit.pins.lengths_mm = {2.25, 2.5}; });
  ASSERT_GT(job.plan.funnel.planar, 0);
  ASSERT_EQ(job.plan.funnel.heights, 0);
  const auto misses = job.misses();
  const NearMiss& miss = miss_of(misses, "stock_too_short");
  EXPECT_EQ(miss.count, job.plan.funnel.planar);
  ASSERT_TRUE(miss.gap);
  EXPECT_EQ(miss.gap->has, 2.5);
  EXPECT_NEAR(miss.gap->needs, 3, 1e-6);  // 2 mm to the part, 1 mm beside it
}

TEST(NearMiss, of_stock_too_long_is_the_plate_gap_the_part_and_the_protrusion) {
  const Spoilt job = spoilt([](model::Task& task) { task.kit.pins.lengths_mm = {40}; });
  ASSERT_EQ(job.plan.funnel.heights, 0);
  const auto misses = job.misses();
  const NearMiss& miss = miss_of(misses, "no_stock_length");
  ASSERT_TRUE(miss.gap);
  EXPECT_EQ(miss.gap->has, 40);
  EXPECT_NEAR(miss.gap->needs, 15, 1e-6);  // 2 mm to the part, 12 mm beside it, 1 mm over it
}

TEST(NearMiss, of_an_obstacle_is_how_far_the_pins_stand_into_it) {
  const Spoilt job = spoilt(stand_a_ring_about_it);
  ASSERT_GT(job.plan.funnel.heights, 0);
  ASSERT_EQ(job.plan.funnel.loadable, 0);
  const auto misses = job.misses();
  const NearMiss& miss = miss_of(misses, "pin_meets_obstacle");
  ASSERT_TRUE(miss.gap);
  // tops 1 mm over a part of 12 mm and 0.2 mm clear of what begins at 5 mm
  EXPECT_NEAR(miss.gap->has, 8.2, 2e-3);
  EXPECT_EQ(miss.gap->needs, 0);
}

TEST(NearMiss, of_jaws_that_cannot_open_is_the_opening_they_have) {
  Spoilt job = spoilt(shorten_travel);
  const auto separations = job.misses();
  const double least_mm = separations.front().gap->needs;
  job.task.kit.jaws.separation_mm.hi = least_mm + 1;
  job.plan = plan_or_throw(job.task, job.scene);
  ASSERT_GT(job.plan.funnel.heights, 0);
  ASSERT_EQ(job.plan.funnel.loadable, 0);
  const auto misses = job.misses();
  const NearMiss& miss = miss_of(misses, "no_opening");
  ASSERT_TRUE(miss.gap);
  EXPECT_NEAR(miss.gap->has, 0.5, 1e-9);
  EXPECT_EQ(miss.gap->needs, 1);
}

TEST(NearMiss, of_too_weak_an_actuator_is_the_least_squeeze_of_all_designs) {
  Spoilt job = spoilt([](model::Task& task) { task.kit.actuator = {1, 0.25}; });
  ASSERT_GT(job.plan.funnel.resistable, 0);
  ASSERT_EQ(job.plan.funnel.strong, 0);
  const auto misses = job.misses();
  const NearMiss& miss = miss_of(misses, "needs more than the usable force");
  ASSERT_TRUE(miss.gap);
  EXPECT_EQ(miss.gap->has, 0.5);
  EXPECT_EQ(miss.unit, Unit::Newton);
  job.task.kit.actuator = {miss.gap->needs * (1 + 1e-9), 0};
  const Plan plan = plan_or_throw(job.task, job.scene);
  ASSERT_FALSE(plan.designs.empty());
  EXPECT_NEAR(plan.designs.front().squeeze.required_n, miss.gap->needs, 1e-9);
}

TEST(NearMiss, of_too_much_friction_is_the_friction_under_which_one_slides) {
  Spoilt job = spoilt([](model::Task& task) { task.friction = 2; });
  ASSERT_GT(job.plan.funnel.loadable, 0);
  ASSERT_EQ(job.plan.funnel.not_wedging, 0);
  double most = 0;
  for (const NearMiss& miss : job.misses()) {
    if (miss.gap && miss.quantity == "friction") most = std::max(most, miss.gap->needs);
  }
  job.task.friction = most + 2e-3;
  EXPECT_EQ(plan_or_throw(job.task, job.scene).funnel.not_wedging, 0);
  job.task.friction = most;
  EXPECT_GT(plan_or_throw(job.task, job.scene).funnel.not_wedging, 0);
}

/// A plate of 40 x 40 x 10 mm with a square pocket from below, of which alone the edges are told.
part::Part pocketed_plate(double depth_mm, double half_mm) {
  const auto corner = [](double half, int i) {
    return std::pair{i == 0 || i == 3 ? -half : half, i < 2 ? -half : half};
  };
  geometry::TriangleMesh mesh;
  const auto quad = [&mesh](const std::array<geometry::Vector3d, 4>& p) {
    const auto at = static_cast<int>(mesh.vertices_mm.size());
    mesh.vertices_mm.insert(mesh.vertices_mm.end(), p.begin(), p.end());
    mesh.triangles.push_back({at, at + 1, at + 2});
    mesh.triangles.push_back({at, at + 2, at + 3});
  };
  std::vector<part::EdgeCurve> edges;
  for (int i = 0; i < 4; ++i) {
    const auto [ox, oy] = corner(20, i);
    const auto [px, py] = corner(20, (i + 1) % 4);
    const auto [ax, ay] = corner(half_mm, i);
    const auto [bx, by] = corner(half_mm, (i + 1) % 4);
    quad({{{ox, oy, 0}, {px, py, 0}, {bx, by, 0}, {ax, ay, 0}}});
    quad({{{ax, ay, 0}, {bx, by, 0}, {bx, by, depth_mm}, {ax, ay, depth_mm}}});
    quad({{{ox, oy, 0}, {px, py, 0}, {px, py, 10}, {ox, oy, 10}}});
    edges.push_back({.edge = i + 1, .curve = part::Line3{{ax, ay, 0}, {bx, by, 0}}});
  }
  quad({{{-half_mm, -half_mm, depth_mm},
         {half_mm, -half_mm, depth_mm},
         {half_mm, half_mm, depth_mm},
         {-half_mm, half_mm, depth_mm}}});
  quad({{{-20, -20, 10}, {20, -20, 10}, {20, 20, 10}, {-20, 20, 10}}});
  mesh.face_of.assign(mesh.triangles.size(), 0);
  part::Part part = spoilt([](model::Task&) {}).scene.part;
  part.profile.reset();
  part.walls.clear();
  part.surface = geometry::Surface(std::move(mesh));
  part.edges = std::move(edges);
  return part;
}

/// The plate as a job: its scene, and a plan as far as phase 1 goes.
struct PocketJob {
  model::Task task;
  Scene scene;
  Plan plan;
};
PocketJob pocket_job(double depth_mm, double half_mm) {
  const part::Part plate = pocketed_plate(depth_mm, half_mm);
  PocketJob job{spoilt([](model::Task&) {}).task, {plate, plate, {}, {}}, {}};
  job.task.disturbances.clear();
  job.task.always.clear();
  job.plan = plan_or_throw(job.task, job.scene);
  return job;
}

TEST(NearMiss, of_edges_under_the_engagement_is_the_largest_step) {
  PocketJob job = pocket_job(0.7, 10);
  ASSERT_EQ(job.plan.funnel.features, 0);
  const auto misses = nearest_misses(job.task, job.scene, job.plan, {});
  ASSERT_EQ(misses.size(), 1U);
  ASSERT_TRUE(misses.front().gap);
  EXPECT_NEAR(misses.front().gap->has, 0.7, 2e-3);
  EXPECT_EQ(misses.front().gap->needs, 1);
}

TEST(NearMiss, of_pins_too_thick_for_every_feature_is_the_thickest_that_has_room) {
  PocketJob job = pocket_job(5, 2);
  ASSERT_GT(job.plan.funnel.features, 0);
  ASSERT_EQ(job.plan.funnel.planar, 0);
  const auto misses = nearest_misses(job.task, job.scene, job.plan, {});
  const NearMiss& miss = miss_of(misses, "no room for a pin");
  ASSERT_TRUE(miss.gap);
  EXPECT_EQ(miss.gap->has, job.task.kit.pins.radius_mm);
  EXPECT_NEAR(miss.gap->needs, 2 + model::kEps_mm / 2, 6e-3);  // 2 r - eps fits between walls 4 mm apart
}

TEST(NearMiss, is_told_of_parts_with_designs_too) {
  const Spoilt job = spoilt([](model::Task&) {});
  ASSERT_GT(job.plan.funnel.strong, 0);
  std::int64_t lost = 0;
  for (const NearMiss& miss : job.misses()) lost += miss.count;
  EXPECT_EQ(lost, job.plan.funnel.planar - job.plan.funnel.strong);
}

}  // namespace
}  // namespace pinjaw::planner

#include "host/planner/force/disturbances.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pinjaw::planner {
namespace {

using geometry::Vector3d;
using model::Wrench;
using testing::ElementsAre;

/// A block of 40 x 20 x 10 mm with its lowest corner at the origin.
geometry::Surface block() {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_mm.emplace_back((i & 1) * 40.0, ((i >> 1) & 1) * 20.0, ((i >> 2) & 1) * 10.0);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh.face_of = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5};
  return geometry::Surface(std::move(mesh));
}

Body body_of(const geometry::Surface& surface) {
  return {0.18, {20, 10, 5}, &surface};
}

std::vector<std::string> names(const std::vector<model::Disturbance>& all) {
  std::vector<std::string> result;
  result.reserve(all.size());
  for (const model::Disturbance& one : all) result.push_back(one.name);
  return result;
}

model::Spray spray(int count, std::uint64_t seed) {
  model::Spray result;
  result.force_n = 8.4;
  result.count = count;
  result.seed = seed;
  return result;
}

TEST(Jet, of_the_papers_nozzle_pushes_with_its_8_4_newtons_up_to_its_rounding) {
  EXPECT_NEAR(model::jet_force_n({1.2, 0.07, 1000}), 8.4,
              0.3);  // BB 4.1 rounds 4.33 N to 4.2 before doubling
}

TEST(Acceleration, of_the_papers_arm_pushes_its_part_with_11_newtons_along_the_directions_listed) {
  const geometry::Surface surface = block();
  model::Task task;
  task.disturbances = {model::Acceleration{"", 6, {Vector3d(0, 0, 2), Vector3d(0, 0, -1)}}};
  const auto all = disturbances_of(task, body_of(surface));
  ASSERT_TRUE(all.has_value());
  EXPECT_THAT(names(*all), ElementsAre("acceleration[+z]", "acceleration[-z]"));
  EXPECT_NEAR((*all)[0].wrench[2], 0.18 * 6 * 9.80665, 1e-12);
  EXPECT_NEAR((*all)[0].wrench[2], 11, 0.5);                         // BB 4.1
  EXPECT_NEAR((*all)[0].wrench[3], 10 * 0.18 * 6 * 9.80665, 1e-9);   // y f_z
  EXPECT_NEAR((*all)[0].wrench[4], -20 * 0.18 * 6 * 9.80665, 1e-9);  // -x f_z
}

TEST(Disturbances, each_carry_what_acts_always) {
  const geometry::Surface surface = block();
  model::Task task;
  task.always = {model::Gravity{"", {Vector3d(0, 0, -3)}}};
  task.disturbances = {model::PointForce{"insertion", {3, 0, 20}, {0, 0, -15}},
                       model::PlainWrench{"lever", Vector3d::Zero(), {200, 0, 0}},
                       model::PlainWrench{"", {1, 0, 0}, {}}, model::PlainWrench{"", {2, 0, 0}, {}}};
  const auto all = disturbances_of(task, body_of(surface));
  ASSERT_TRUE(all.has_value());
  EXPECT_THAT(names(*all), ElementsAre("insertion", "lever", "wrench", "wrench#2", "always"));
  const double weight_n = 0.18 * 9.80665;
  EXPECT_NEAR((*all)[0].wrench[2], -15 - weight_n, 1e-12);
  EXPECT_NEAR((*all)[0].wrench[4], 3 * 15 + 20 * weight_n, 1e-12);
  EXPECT_NEAR((*all)[1].wrench[3], 200 - 10 * weight_n, 1e-12);
  EXPECT_NEAR((*all)[4].wrench[2], -weight_n, 1e-12);  // so that a load may come in part
}

TEST(Disturbances, of_a_task_with_only_what_acts_always_are_that_alone) {
  const geometry::Surface surface = block();
  model::Task task;
  task.always = {model::Gravity{}};
  const auto all = disturbances_of(task, body_of(surface));
  ASSERT_TRUE(all.has_value());
  EXPECT_THAT(names(*all), ElementsAre("always"));
}

TEST(Disturbances, act_with_each_state_of_what_acts_always) {
  const geometry::Surface surface = block();
  model::Task task;
  task.always = {model::Gravity{"", {Vector3d(0, 0, -1), {Vector3d(0, 0, 1), "overhead"}}}};
  task.disturbances = {model::PlainWrench{"lever", Vector3d::Zero(), {200, 0, 0}}, model::PlainWrench{}};
  const auto all = disturbances_of(task, body_of(surface));
  ASSERT_TRUE(all.has_value());
  EXPECT_THAT(names(*all),
              ElementsAre("lever with gravity[-z]", "lever with gravity[overhead]", "wrench with gravity[-z]",
                          "wrench with gravity[overhead]", "gravity[-z]", "gravity[overhead]"));
  EXPECT_NEAR((*all)[1].wrench[2], 0.18 * 9.80665, 1e-12);
  EXPECT_EQ((*all)[1].wrench[3], 200 + 10 * (*all)[1].wrench[2]);
  task.disturbances.clear();
  EXPECT_THAT(names(*disturbances_of(task, body_of(surface))),
              ElementsAre("gravity[-z]", "gravity[overhead]"));
}

TEST(Disturbances, that_act_together_add_up_one_choice_of_each_at_a_time) {
  model::Task task;
  const model::Drilling drill{"drill", {1, 2, 3}, {0, 0, -2}, 40, 300, 0, model::Drilling::Turns::Right};
  const model::PlainWrench hose{"hose", {1, 0, 0}, {0, 5, 0}};
  task.disturbances = {model::Together{"both", {drill, hose}}, hose};
  const auto all = disturbances_of(task, {});
  ASSERT_TRUE(all.has_value());
  EXPECT_THAT(names(*all),
              ElementsAre("both[drill[thrust] with hose]", "both[drill[thrust, torque] with hose]",
                          "both[drill[torque] with hose]", "hose"));
  Wrench expected;
  expected << 1, 0, -40, -80, 45, -300;  // (1, 2, 3) x (0, 0, -40) = (-80, 40, 0)
  EXPECT_EQ((*all)[1].wrench, expected);
}

TEST(Disturbances, refuse_more_loads_than_anyone_could_wait_for) {
  const geometry::Surface surface = block();
  model::Task task;
  const model::Acceleration shaken{"", 1, {}, true};
  task.disturbances = {model::Together{"", {shaken, shaken, shaken}}};
  EXPECT_FALSE(disturbances_of(task, body_of(surface)).has_value());
  task.always = {shaken, shaken};
  task.disturbances = {shaken};
  EXPECT_FALSE(disturbances_of(task, body_of(surface)).has_value());
}

TEST(Disturbances, refuse_the_weight_of_a_part_without_mass) {
  model::Task task;
  task.disturbances = {model::Gravity{}};
  EXPECT_FALSE(disturbances_of(task, {}).has_value());
  task.disturbances = {model::Acceleration{"", 1, {Vector3d(1, 0, 0)}}};
  EXPECT_FALSE(disturbances_of(task, {}).has_value());
}

TEST(Spray, hits_the_surface_and_pushes_into_it_along_the_facet) {
  const geometry::Surface surface = block();
  const auto hits = spray_hits(spray(500, 1), surface);
  ASSERT_TRUE(hits.has_value());
  ASSERT_EQ(hits->size(), 500U);
  const Vector3d middle(20, 10, 5);
  const Vector3d half(20, 10, 5);
  int top_or_bottom = 0;
  for (const SprayHit& hit : *hits) {
    EXPECT_NEAR(hit.force_n.norm(), 8.4, 1e-9);
    const Vector3d unit = (hit.p_mm - middle).cwiseQuotient(half);
    EXPECT_NEAR(unit.cwiseAbs().maxCoeff(), 1, 1e-9);
    EXPECT_LT(hit.force_n.dot(hit.p_mm - middle), 0);
    EXPECT_NEAR(hit.force_n.cwiseAbs().maxCoeff(), 8.4, 1e-9);
    top_or_bottom += std::abs(hit.force_n.z()) > 1 ? 1 : 0;
  }
  EXPECT_NEAR(top_or_bottom, 500 * 800.0 / 1400,
              45);  // facets are hit in proportion to area: Cauchy's formula
}

TEST(Spray, is_the_same_sample_for_the_same_seed_and_another_for_another) {
  const geometry::Surface surface = block();
  const auto a = spray_hits(spray(20, 5), surface);
  const auto b = spray_hits(spray(20, 5), surface);
  const auto c = spray_hits(spray(20, 6), surface);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ((*a)[i].p_mm, (*b)[i].p_mm);
  EXPECT_NE((*a)[0].p_mm, (*c)[0].p_mm);
}

TEST(Spray, from_above_within_a_narrow_cone_pushes_down_only) {
  const geometry::Surface surface = block();
  model::Spray jet = spray(100, 2);
  jet.from = Vector3d::UnitZ();
  jet.within_rad = 1e-3;
  const auto hits = spray_hits(jet, surface);
  ASSERT_TRUE(hits.has_value());
  int down = 0;
  for (const SprayHit& hit : *hits) down += hit.force_n.z() < -8 ? 1 : 0;
  EXPECT_GE(down, 98);  // a tilted ray may graze an upright face
}

TEST(Side, above_turns_forces_and_torques_by_pi_about_y) {
  model::Wrench wrench;
  wrench << 1, 2, 3, 4, 5, 6;
  model::Wrench above;
  above << -1, 2, -3, -4, 5, -6;
  EXPECT_EQ(turned(wrench, model::Side::Above), above);
  EXPECT_EQ(turned(wrench, model::Side::Below), wrench);
}

}  // namespace
}  // namespace pinjaw::planner

#include "host/sequence/loads.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "tests/host/sequence/small_cell.hpp"

namespace pinjaw::sequence {
namespace {

using model::Vector3d;

constexpr double kG = 9.80665;
constexpr double kHalfTurn = std::numbers::pi;

Carried half_kilo() {
  return {.mass_kg = 0.5, .centroid_mm = {10, 20, 30}, .down = -Vector3d::UnitZ()};
}

Vector3d force(const model::Wrench& wrench) {
  return wrench.head<3>();
}
Vector3d torque(const model::Wrench& wrench) {
  return wrench.tail<3>();
}

TEST(Weight, pulls_at_the_centroid) {
  const model::Wrench wrench = weight(half_kilo());
  EXPECT_TRUE(force(wrench).isApprox(Vector3d(0, 0, -0.5 * kG)));
  // (10, 20, 30) x (0, 0, -4.903325)
  EXPECT_TRUE(torque(wrench).isApprox(Vector3d(-20 * 0.5 * kG, 10 * 0.5 * kG, 0)));
}

TEST(Weight, of_nothing_is_nothing) {
  EXPECT_TRUE(weight({}).isZero());
}

TEST(MoveLoads, push_back_while_it_speeds_up_and_forth_while_it_slows_down) {
  const model::MoveStep move{.station = "arm", .seconds = 2, .peak_g = 6, .along = Vector3d::UnitX()};
  const std::vector<Load> loads = loads_of(move, half_kilo(), Vector3d::UnitX());
  ASSERT_EQ(loads.size(), 3U);
  const double peak_n = 0.5 * 6 * kG;
  EXPECT_TRUE(force(loads[0].wrench).isApprox(Vector3d(-peak_n, 0, -0.5 * kG)));
  EXPECT_TRUE(loads[1].wrench.isApprox(weight(half_kilo())));
  EXPECT_TRUE(force(loads[2].wrench).isApprox(Vector3d(peak_n, 0, -0.5 * kG)));
  EXPECT_NEAR(loads[0].seconds + loads[1].seconds + loads[2].seconds, 2, 1e-12);
}

TEST(MoveLoads, of_a_very_short_move_have_no_middle) {
  const model::MoveStep move{.station = "arm", .seconds = 0.04, .peak_g = 1, .along = Vector3d::UnitX()};
  const std::vector<Load> loads = loads_of(move, half_kilo(), Vector3d::UnitX());
  EXPECT_NEAR(loads[0].seconds, 0.02, 1e-12);
  EXPECT_EQ(loads[1].seconds, 0);
}

TEST(TurnedDown, goes_the_other_way_than_the_station) {
  const Vector3d down = -Vector3d::UnitZ();
  const Vector3d y = Vector3d::UnitY();
  EXPECT_TRUE(turned_down(down, y, 0).isApprox(down));
  // turned by +90 deg about y the part's x points down
  EXPECT_TRUE(turned_down(down, y, kHalfTurn / 2).isApprox(Vector3d::UnitX()));
  EXPECT_TRUE(turned_down(down, y, kHalfTurn).isApprox(Vector3d::UnitZ()));
  EXPECT_TRUE(turned_down(turned_down(down, y, kHalfTurn), y, -kHalfTurn).isApprox(down));
}

TEST(RotateLoads, take_the_time_of_the_step_and_end_with_gravity_turned) {
  const model::RotateStep rotate{.station = "arm", .angle_rad = kHalfTurn, .seconds = 2, .peak_g = 6};
  const std::vector<Load> loads = loads_of(rotate, half_kilo(), Vector3d::UnitY());
  double seconds = 0;
  for (const Load& load : loads) seconds += load.seconds;
  EXPECT_NEAR(seconds, 2, 1e-12);
  const double weight_n = 0.5 * kG;
  EXPECT_TRUE(force(loads.front().wrench).isApprox(Vector3d(0, 0, 5 * weight_n)));  // 6 g up, 1 g down
  EXPECT_TRUE(force(loads[1].wrench).isApprox(Vector3d(0, 0, -7 * weight_n)));
  EXPECT_TRUE(force(loads.back().wrench).isApprox(Vector3d(0, 0, (1 - 6) * weight_n)));  // upside down
  const auto half_way = std::ranges::find(loads, "turned 6 of 12", &Load::name);
  ASSERT_NE(half_way, loads.end());
  EXPECT_TRUE(force(half_way->wrench).isApprox(Vector3d(weight_n, 0, 0)));
}

TEST(SprayLoads, are_jets_onto_the_surface_one_every_50_ms) {
  const planner::Scene& scene = testing::small_cell().scene;
  const model::SprayStep spray{.on = "pedestal", .seconds = 5, .force_n = 8.4, .seed = 3};
  const auto loads = loads_of(spray, {}, scene);
  ASSERT_TRUE(loads);
  EXPECT_EQ(loads->size(), 100U);
  double seconds = 0;
  for (const Load& load : *loads) {
    seconds += load.seconds;
    const Vector3d jet_n = force(load.wrench);
    EXPECT_NEAR(jet_n.norm(), 8.4, 1e-9);
    // a point of the block's surface lies on the line of the force: the line through n x m / n.n along n
    const Vector3d foot_mm = jet_n.cross(torque(load.wrench)) / jet_n.squaredNorm();
    const Vector3d inward = jet_n.normalized();
    EXPECT_NEAR(inward.dot(torque(load.wrench)), 0, 1e-9);
    if (std::abs(inward.z()) > 0.5) {
      EXPECT_TRUE(foot_mm.x() >= -1e-9 && foot_mm.x() <= 40 + 1e-9);
      EXPECT_TRUE(foot_mm.y() >= -1e-9 && foot_mm.y() <= 30 + 1e-9);
    } else {
      EXPECT_TRUE(foot_mm.z() >= -1e-9 && foot_mm.z() <= 40 + 1e-9);
    }
  }
  EXPECT_NEAR(seconds, 5, 1e-9);
}

TEST(SprayLoads, depend_on_the_seed_alone) {
  const planner::Scene& scene = testing::small_cell().scene;
  const auto drawn = [&](std::uint64_t seed) {
    return loads_of(model::SprayStep{.on = "arm", .seconds = 1, .force_n = 4, .seed = seed}, {}, scene)
        .value();
  };
  EXPECT_TRUE(drawn(3).back().wrench == drawn(3).back().wrench);
  EXPECT_FALSE(drawn(3).back().wrench == drawn(4).back().wrench);
}

}  // namespace
}  // namespace pinjaw::sequence

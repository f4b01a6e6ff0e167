#include "host/planner/force/source_loads.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "host/base/random.hpp"
#include "host/planner/force/covers.hpp"
#include "host/planner/force/squeeze.hpp"
#include "tests/host/planner/force/zoo.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector3d;
using model::Wrench;
using testing::ElementsAre;

const Body kBody{0.2, {10, 5, 3}, nullptr};

Vector3d random_unit(base::Random& random) {
  return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

std::vector<SourceLoad> all_loads(const model::SingleSource& source) {
  return loads_of(source, kBody).value();
}

std::vector<std::string> labels(const model::SingleSource& source) {
  std::vector<std::string> result;
  for (const SourceLoad& load : all_loads(source)) result.push_back(load.label);
  return result;
}

/// The most squeeze that any load of a source needs.
double worst_n(SqueezeSolver& solver, const model::SingleSource& source) {
  double worst = 0;
  for (const SourceLoad& load : all_loads(source))
    worst = std::max(worst, std::get<Required>(solver.least_squeeze(load.wrench)).force_n);
  return worst;
}

/// Calls `test` with solvers of random grasps that hold anything, and with a random generator.
template <class Test>
void for_grasps(Test&& test) {
  base::Random random(7);
  for (int i = 0; i < 40; ++i) {
    SqueezeSolver solver(zoo::random_grasp(zoo::Family::FormClosed, random));
    test(solver, random);
  }
}

constexpr double kRounding = 1 + 1e-9;

TEST(Covers, stand_around_ball_and_circle_and_hardly_outside_them) {
  base::Random random(3);
  const auto& ball = corners_around_ball();
  EXPECT_EQ(ball.size(), 162U);
  for (const Vector3d& corner : ball) {
    EXPECT_GE(corner.norm(), 1);
    EXPECT_LE(corner.norm(), 1.0181);
  }
  // a convex body holds the unit ball where its support in every direction is 1 or more
  for (int i = 0; i < 10000; ++i) {
    const Vector3d u = random_unit(random);
    double support = 0;
    for (const Vector3d& corner : ball) support = std::max(support, corner.dot(u));
    EXPECT_GE(support, 1 - 1e-12);
  }
  const Vector3d axis = random_unit(random);
  for (const Vector3d& corner : corners_around_circle(axis)) {
    EXPECT_NEAR(corner.dot(axis), 0, 1e-12);
    EXPECT_GE(corner.norm(), 1);
    EXPECT_LE(corner.norm(), 1.009);
  }
}

TEST(Gravity, in_several_poses_is_one_load_a_pose_told_by_name_or_direction) {
  const model::Gravity gravity{"", {Vector3d(0, 0, -1), {Vector3d(0, 2, 0), "on its side"}}};
  EXPECT_THAT(labels(gravity), ElementsAre("-z", "on its side"));
  const auto loads = all_loads(gravity);
  EXPECT_NEAR(loads[1].wrench[1], 0.2 * 9.80665, 1e-12);
  EXPECT_NEAR(loads[1].wrench[5], 10 * 0.2 * 9.80665, 1e-12);  // x f_y
}

TEST(Acceleration, along_every_direction_misses_none_and_asks_for_little_more) {
  for_grasps([](SqueezeSolver& solver, base::Random& random) {
    const double covered_n = worst_n(solver, model::Acceleration{"", 6, {}, true});
    model::Acceleration sample{"", 6, {}};
    for (int i = 0; i < 2000; ++i) sample.along.emplace_back(random_unit(random));
    const double sampled_n = worst_n(solver, sample);
    EXPECT_LE(sampled_n, covered_n * kRounding);
    EXPECT_GE(sampled_n, covered_n * 0.94);  // 1.8 % outside, and the sample's own gaps
  });
}

TEST(Drilling, is_its_thrust_and_torque_each_at_nothing_and_at_its_peak) {
  model::Drilling drilling{"", {1, 2, 3}, {0, 0, -1}, 40, 300, 0, model::Drilling::Turns::Right};
  EXPECT_THAT(labels(drilling), ElementsAre("thrust", "thrust, torque", "torque"));
  drilling.pull_n = 8;
  drilling.turns = model::Drilling::Turns::Both;
  EXPECT_THAT(labels(drilling), ElementsAre("thrust", "thrust, right torque", "thrust, left torque", "pull",
                                            "pull, right torque", "pull, left torque"));
  const auto loads = all_loads(drilling);
  Wrench pull_left;
  pull_left << 0, 0, 8, 16, -8, 300;  // (1, 2, 3) x (0, 0, 8); left about the feed -z is +z
  EXPECT_EQ(loads[5].wrench, pull_left);
  drilling.torque_nmm = 0;
  EXPECT_THAT(labels(drilling), ElementsAre("thrust", "pull"));
}

TEST(Drilling, needs_no_more_at_any_moment_than_at_its_corners) {
  for_grasps([](SqueezeSolver& solver, base::Random& random) {
    const model::Drilling drilling{"", 20 * random_unit(random),    random_unit(random), 40, 300,
                                   12, model::Drilling::Turns::Both};
    const double corners_n = worst_n(solver, drilling);
    for (int i = 0; i < 200; ++i) {
      Wrench wrench = force_at(drilling.at_mm, random.uniform(-12, 40) * drilling.axis);
      wrench.tail<3>() += random.uniform(-300, 300) * drilling.axis;
      EXPECT_LE(std::get<Required>(solver.least_squeeze(wrench)).force_n, corners_n * kRounding);
    }
  });
}

TEST(Insertion, with_a_side_load_covers_every_way_across) {
  for_grasps([](SqueezeSolver& solver, base::Random& random) {
    const model::Insertion insertion{"", 20 * random_unit(random), random_unit(random), 15, 6};
    const double covered_n = worst_n(solver, insertion);
    double sampled_n = 0;
    for (int i = 0; i < 500; ++i) {
      const Vector3d side = random_unit(random).cross(insertion.along).normalized();
      const Wrench wrench = force_at(
          insertion.at_mm, insertion.force_n * insertion.along + std::sqrt(random.uniform()) * 6 * side);
      sampled_n = std::max(sampled_n, std::get<Required>(solver.least_squeeze(wrench)).force_n);
    }
    EXPECT_LE(sampled_n, covered_n * kRounding);
    EXPECT_GE(sampled_n, covered_n * 0.9);
  });
  EXPECT_THAT(labels(model::Insertion{"", {}, {0, 0, -1}, 15, 0}), ElementsAre(""));
}

TEST(Path, needs_no_more_anywhere_on_its_runs_than_at_their_ends) {
  for_grasps([](SqueezeSolver& solver, base::Random& random) {
    model::Path path;
    for (int i = 0; i < 4; ++i) path.points_mm.emplace_back(30 * random_unit(random));
    path.force_n = 5 * random_unit(random);
    path.drag_n = 3;
    path.back_and_forth = true;
    const double ends_n = worst_n(solver, path);
    for (int i = 0; i < 200; ++i) {
      const auto run = static_cast<std::size_t>(random.uniform(0, 3));
      const Vector3d along_mm = path.points_mm[run + 1] - path.points_mm[run];
      const double way = random.uniform() < 0.5 ? 1 : -1;
      const Vector3d p_mm = path.points_mm[run] + random.uniform() * along_mm;
      const Wrench wrench = force_at(p_mm, path.force_n + way * 3 * along_mm.normalized());
      EXPECT_LE(std::get<Required>(solver.least_squeeze(wrench)).force_n, ends_n * kRounding);
    }
  });
}

TEST(Path, tells_its_points_by_number_and_its_runs_by_their_ends) {
  model::Path path{"", {{0, 0, 0}, {10, 0, 0}, {10, 5, 0}}, {0, 0, -2}};
  EXPECT_THAT(labels(path), ElementsAre("0", "1", "2"));
  path.drag_n = 1;
  EXPECT_THAT(labels(path), ElementsAre("0 to 1, at 0", "0 to 1, at 1", "1 to 2, at 1", "1 to 2, at 2"));
  path.back_and_forth = true;
  EXPECT_EQ(labels(path).size(), 8U);
}

TEST(Milling, covers_every_way_its_force_turns_with_axial_force_and_torque_either_way) {
  for_grasps([](SqueezeSolver& solver, base::Random& random) {
    const model::Milling milling{"", {{0, 0, 8}, {20, 5, 8}}, random_unit(random), 12, 4, 60};
    const double covered_n = worst_n(solver, milling);
    for (int i = 0; i < 200; ++i) {
      const Vector3d side = random_unit(random).cross(milling.axis).normalized();
      const Vector3d p_mm =
          milling.points_mm[0] + random.uniform() * (milling.points_mm[1] - milling.points_mm[0]);
      Wrench wrench = force_at(p_mm, 12 * side + random.uniform(-4, 4) * milling.axis);
      wrench.tail<3>() += random.uniform(-60, 60) * milling.axis;
      EXPECT_LE(std::get<Required>(solver.least_squeeze(wrench)).force_n, covered_n * kRounding);
    }
  });
}

TEST(Counts, are_told_before_any_load_is_made) {
  const std::vector<model::SingleSource> sources = {
      model::Gravity{"", {Vector3d(0, 0, -1), Vector3d(1, 0, 0)}},
      model::Acceleration{"", 1, {}, true},
      model::PointForce{},
      model::Drilling{"", {}, {0, 0, -1}, 4, 3, 2, model::Drilling::Turns::Both},
      model::Insertion{"", {}, {0, 0, -1}, 4, 3},
      model::Path{"", {{0, 0, 0}, {1, 0, 0}}, {0, 0, -2}},
      model::Milling{"", {{0, 0, 0}}, {0, 0, -1}, 3, 2, 1}};
  for (const model::SingleSource& source : sources) {
    EXPECT_EQ(count_of(source), all_loads(source).size());
  }
}

}  // namespace
}  // namespace pinjaw::planner

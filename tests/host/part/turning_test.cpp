#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/host/part/shipped_parts.hpp"

namespace pinjaw::part {
namespace {

TEST(UprightRotation, takes_up_to_z_by_the_shortest_way) {
  for (const Vector3d& up : {Vector3d(1, 0, 0), Vector3d(0, -1, 0), Vector3d(0, 0, 1), Vector3d(0, 0, -1),
                             Vector3d(1, 2, 3), Vector3d(-4, 1, -2), Vector3d(1e-9, 0, -1)}) {
    const Eigen::Matrix3d rotation = upright_rotation(up);
    EXPECT_LT((rotation * up.normalized() - Vector3d::UnitZ()).norm(), 2e-9) << up.transpose();
    EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9) << up.transpose();
    EXPECT_NEAR(rotation.determinant(), 1, 1e-9) << up.transpose();
    const double turn_cosine = (rotation.trace() - 1) / 2;
    EXPECT_NEAR(turn_cosine, up.normalized().z(), 1e-9) << up.transpose();
  }
}

TEST(UprightRotation, of_down_is_half_a_turn_about_x) {
  EXPECT_EQ(upright_rotation({0, 0, -2}), Eigen::Matrix3d(Vector3d(1, -1, -1).asDiagonal()));
}

TEST(UprightRotation, of_up_moves_nothing) {
  EXPECT_TRUE(upright_rotation({0, 0, 3}).isIdentity(0));
}

TEST(UprightRotation, of_an_axis_is_exact) {
  Eigen::Matrix3d expected;
  expected << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  EXPECT_EQ(upright_rotation({1, 0, 0}), expected);
}

TEST(Up, must_have_a_direction) {
  model::PartSource source = source_of(shipped("l_bracket"));
  source.up = Vector3d::Zero();
  EXPECT_FALSE(read_part(source));
}

TEST(Up, turns_surface_edges_and_centroid_together) {
  const Part* plain = &shipped_part("l_bracket");
  model::PartSource source = source_of(shipped("l_bracket"));
  source.up = {1, 2, 3};
  const auto part = read_part(source);
  ASSERT_TRUE(plain && part);
  const Eigen::Matrix3d rotation = upright_rotation(source.up);
  EXPECT_LT((part->centroid_mm - rotation * plain->centroid_mm).norm(), 1e-9);
  const auto& plain_vertices = plain->surface.mesh().vertices_mm;
  const auto& vertices = part->surface.mesh().vertices_mm;
  ASSERT_EQ(vertices.size(), plain_vertices.size());
  EXPECT_LT((vertices[7] - rotation * plain_vertices[7]).norm(), 1e-9);
  const auto& plain_line = std::get<Line3>(plain->edges[0].curve);
  const auto& line = std::get<Line3>(part->edges[0].curve);
  EXPECT_LT((line.a_mm - rotation * plain_line.a_mm).norm(), 1e-9);
}

TEST(Side, above_changes_the_signs_of_x_and_z) {
  const Part* part = &shipped_part("l_bracket");
  const Part above = turned(*part, model::Side::Above);
  const Vector3d flip(-1, 1, -1);
  EXPECT_EQ(above.centroid_mm, flip.asDiagonal() * part->centroid_mm);
  EXPECT_EQ(above.surface.z_range_mm().lo, -part->surface.z_range_mm().hi);
  EXPECT_EQ(above.surface.x_range_mm().lo, -part->surface.x_range_mm().hi);
  EXPECT_NEAR(enclosed_mm3(above.surface.mesh()), enclosed_mm3(part->surface.mesh()), 1e-6);
  EXPECT_EQ(above.walls[0].z_mm.hi, -part->walls[0].z_mm.lo);
}

TEST(Side, above_twice_is_the_part_itself) {
  const Part* part = &shipped_part("l_bracket");
  const Part twice = turned(turned(*part, model::Side::Above), model::Side::Above);
  EXPECT_EQ(twice.surface.mesh().vertices_mm, part->surface.mesh().vertices_mm);
  EXPECT_EQ(twice.surface.mesh().triangles, part->surface.mesh().triangles);
}

TEST(Side, below_is_the_part_itself) {
  const Part* part = &shipped_part("l_bracket");
  EXPECT_EQ(turned(*part, model::Side::Below).centroid_mm, part->centroid_mm);
}

}  // namespace
}  // namespace pinjaw::part

#include "host/part/stl_mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/random.hpp"
#include "host/part/mesh_shells.hpp"
#include "tests/host/geometry/solids.hpp"
#include "tests/host/part/stl_bytes.hpp"

namespace pinjaw::part {
namespace {

using geometry::TriangleMesh;
using geometry::testing::append;
using geometry::testing::block;

TriangleMesh cube(double lo, double hi) {
  return block({{lo, lo, lo}, {hi, hi, hi}});
}

void turn(TriangleMesh& mesh, std::size_t facet) {
  std::swap(mesh.triangles[facet][1], mesh.triangles[facet][2]);
}

void turn_all(TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) turn(mesh, i);
}

StlMesh joined(const TriangleMesh& mesh) {
  auto read = read_stl_mesh(binary_stl(mesh), "part.stl", kMostTriangles);
  if (!read) throw std::runtime_error(read.error().message);
  return std::move(*read);
}

double volume_mm3(const StlMesh& mesh) {
  return mass_of(mesh.mesh, mesh.counts).volume_mm3;
}

TEST(StlMesh, a_closed_file_is_one_shell_with_nothing_to_tell) {
  const StlMesh mesh = joined(cube(0, 10));
  EXPECT_EQ(mesh.counts, (MeshCounts{.facets = 12, .shells = 1}));
  EXPECT_TRUE(mesh.counts.closed());
  EXPECT_NEAR(volume_mm3(mesh), 1000, 1e-9);
  EXPECT_LT((mass_of(mesh.mesh, mesh.counts).centroid_mm - Vector3d(5, 5, 5)).norm(), 1e-12);
}

TEST(StlMesh, facets_in_any_order_and_sense_come_out_the_same_way_round) {
  base::Random random(7);
  for (int round = 0; round < 50; ++round) {
    TriangleMesh mesh = geometry::testing::cylinder({{3, 4}, 5, 0, 0}, {1, 9}, 16);
    const double expected_mm3 = volume_mm3(joined(mesh));
    for (std::size_t i = mesh.triangles.size() - 1; i > 0; --i) {
      std::swap(mesh.triangles[i], mesh.triangles[random.bits() % (i + 1)]);
      if (random.uniform() < 0.5) turn(mesh, i);
    }
    const StlMesh mended = joined(mesh);
    EXPECT_TRUE(mended.counts.closed());
    EXPECT_EQ(mended.counts.open_edges, 0);
    EXPECT_NEAR(volume_mm3(mended), expected_mm3, 1e-9);
  }
}

TEST(StlMesh, turned_facets_are_counted) {
  TriangleMesh mesh = cube(0, 10);
  turn(mesh, 3);
  turn(mesh, 7);
  EXPECT_EQ(joined(mesh).counts.turned, 2);
  TriangleMesh inside_out = cube(0, 10);
  turn_all(inside_out);
  EXPECT_EQ(joined(inside_out).counts.turned, 12);
  EXPECT_NEAR(volume_mm3(joined(inside_out)), 1000, 1e-9);
}

TEST(StlMesh, a_cavity_stays_a_cavity_also_in_a_file_that_is_inside_out) {
  TriangleMesh mesh = cube(0, 10);
  TriangleMesh hollow = cube(4, 6);
  turn_all(hollow);
  append(mesh, hollow);
  EXPECT_EQ(joined(mesh).counts.shells, 2);
  EXPECT_EQ(joined(mesh).counts.turned, 0);
  EXPECT_NEAR(volume_mm3(joined(mesh)), 1000 - 8, 1e-9);
  turn_all(mesh);
  EXPECT_NEAR(volume_mm3(joined(mesh)), 1000 - 8, 1e-9);
}

TEST(StlMesh, shells_apart_each_face_outwards) {
  TriangleMesh mesh = cube(0, 10);
  TriangleMesh other = cube(20, 25);
  turn_all(other);
  append(mesh, other);
  const StlMesh both = joined(mesh);
  EXPECT_EQ(both.counts.shells, 2);
  EXPECT_EQ(both.counts.turned, 12);
  EXPECT_NEAR(volume_mm3(both), 1125, 1e-9);
}

TEST(StlMesh, corners_that_differ_by_rounding_are_one) {
  TriangleMesh mesh = cube(0, 100);
  std::vector<Vector3d> apart;
  base::Random random(1);
  for (auto& triangle : mesh.triangles) {
    for (int& corner : triangle) {
      Vector3d p = mesh.vertices_mm[static_cast<std::size_t>(corner)];
      for (int axis = 0; axis < 3; ++axis) p[axis] += random.uniform(-1e-5, 1e-5);
      corner = static_cast<int>(apart.size());
      apart.push_back(p);
    }
  }
  mesh.vertices_mm = apart;
  const StlMesh welded = joined(mesh);
  EXPECT_TRUE(welded.counts.closed());
  EXPECT_EQ(welded.mesh.vertices_mm.size(), 8U);
}

TEST(StlMesh, degenerate_and_repeated_facets_are_dropped_and_counted) {
  TriangleMesh mesh = cube(0, 10);
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({2, 3, 2});
  mesh.triangles.push_back({mesh.triangles[4][1], mesh.triangles[4][2], mesh.triangles[4][0]});
  const StlMesh read = joined(mesh);
  EXPECT_EQ(read.counts, (MeshCounts{.facets = 15, .degenerate = 2, .repeated = 1, .shells = 1}));
  const auto none = read_stl_mesh(binary_stl({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 0}}, {}}), "part.stl", 10);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "part.stl: none of its facets has an area");
}

TEST(StlMesh, a_missing_facet_leaves_three_open_edges_and_no_volume) {
  TriangleMesh mesh = cube(0, 10);
  mesh.triangles.pop_back();
  const StlMesh open = joined(mesh);
  EXPECT_EQ(open.counts.open_edges, 3);
  EXPECT_FALSE(open.counts.closed());
  EXPECT_EQ(volume_mm3(open), 0);
}

TEST(StlMesh, bodies_that_touch_along_an_edge_are_closed_and_the_edge_is_counted) {
  TriangleMesh mesh = cube(0, 10);
  append(mesh, block({{10, 10, 0}, {20, 20, 10}}));
  const StlMesh both = joined(mesh);
  EXPECT_EQ(both.counts.crowded_edges, 1);
  EXPECT_EQ(both.counts.shells, 2);
  EXPECT_TRUE(both.counts.closed());
  EXPECT_NEAR(volume_mm3(both), 2000, 1e-9);
}

TEST(StlMesh, a_band_with_a_twist_has_no_outside_and_says_so) {
  TriangleMesh band;
  constexpr int kSteps = 24;
  for (int i = 0; i < kSteps; ++i) {
    const double turn_rad = 2 * std::numbers::pi * i / kSteps;
    const Vector3d out(std::cos(turn_rad), std::sin(turn_rad), 0);
    const Vector3d across = std::cos(turn_rad / 2) * out + std::sin(turn_rad / 2) * Vector3d::UnitZ();
    band.vertices_mm.emplace_back(10 * out - 3 * across);
    band.vertices_mm.emplace_back(10 * out + 3 * across);
  }
  for (int i = 0; i < kSteps; ++i) {
    const int a = 2 * i;
    const int b = i + 1 < kSteps ? a + 2 : 1;  // joined upside down
    const int d = i + 1 < kSteps ? a + 3 : 0;
    band.triangles.push_back({a, b, d});
    band.triangles.push_back({a, d, a + 1});
  }
  const StlMesh read = joined(band);
  EXPECT_EQ(read.counts.shells, 1);
  EXPECT_GT(read.counts.open_edges, 2 * kSteps) << "its borders, and where the sense changes";
}

TEST(StlMesh, dust_is_refused) {
  TriangleMesh dust;
  for (int i = 0; i <= kMostShells; ++i) append(dust, block({{3. * i, 0, 0}, {3. * i + 1, 1, 1}}));
  const auto read = read_stl_mesh(binary_stl(dust), "part.stl", kMostTriangles);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "part.stl: its facets fall into more than 2000 separate shells");
}

}  // namespace
}  // namespace pinjaw::part

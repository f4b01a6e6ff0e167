#include "host/part/mesh_contours.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/geometry/surface.hpp"
#include "tests/host/geometry/solids.hpp"

namespace pinjaw::part {
namespace {

using geometry::Arc;
using geometry::Segment;
using geometry::TriangleMesh;

constexpr double kPi = std::numbers::pi;
constexpr double kSagittaMm = 0.004;

std::vector<Arc> arcs_of(const std::vector<Contour>& contours) {
  std::vector<Arc> arcs;
  for (const Contour& contour : contours) {
    if (const auto* arc = std::get_if<Arc>(&contour.curve)) arcs.push_back(*arc);
  }
  return arcs;
}

/// A ring between two radii, both of `sides` chords.
TriangleMesh ring(double inner_mm, double outer_mm, double height_mm, int sides) {
  TriangleMesh mesh;
  for (const double z_mm : {0.0, height_mm}) {
    for (const double radius_mm : {inner_mm, outer_mm}) {
      for (int i = 0; i < sides; ++i) {
        const Vector2d p = radius_mm * geometry::direction(2 * kPi * i / sides);
        mesh.vertices_mm.emplace_back(p.x(), p.y(), z_mm);
      }
    }
  }
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < sides; ++i) {
    const int j = (i + 1) % sides;
    quad(i, j, sides + j, sides + i);                                  // below, faces down
    quad(2 * sides + j, 2 * sides + i, 3 * sides + i, 3 * sides + j);  // above
    quad(sides + i, sides + j, 3 * sides + j, 3 * sides + i);          // outside
    quad(j, i, 2 * sides + i, 2 * sides + j);                          // bore
  }
  mesh.face_of.assign(mesh.triangles.size(), 1);
  return mesh;
}

TriangleMesh turned(TriangleMesh mesh, const Eigen::Matrix3d& rotation) {
  for (Vector3d& p : mesh.vertices_mm) p = rotation * p;
  return mesh;
}

/// A sphere by rings of latitude, its equator in the middle of a band.
TriangleMesh sphere(double radius_mm, int rings, int sides) {
  TriangleMesh mesh;
  const auto at = [&](int ring, int side) {
    const double up_rad = -kPi / 2 + kPi * ring / rings;
    const double turn_rad = 2 * kPi * (side + (ring % 2) * 0.5) / sides;
    return Vector3d(radius_mm * std::cos(up_rad) * std::cos(turn_rad),
                    radius_mm * std::cos(up_rad) * std::sin(turn_rad), radius_mm * std::sin(up_rad));
  };
  mesh.vertices_mm.push_back({0, 0, -radius_mm});
  for (int ring = 1; ring < rings; ++ring) {
    for (int side = 0; side < sides; ++side) mesh.vertices_mm.push_back(at(ring, side));
  }
  mesh.vertices_mm.push_back({0, 0, radius_mm});
  const int last = static_cast<int>(mesh.vertices_mm.size()) - 1;
  const auto index = [&](int ring, int side) { return 1 + (ring - 1) * sides + side % sides; };
  for (int side = 0; side < sides; ++side) {
    mesh.triangles.push_back({0, index(1, side + 1), index(1, side)});
    mesh.triangles.push_back({last, index(rings - 1, side), index(rings - 1, side + 1)});
    for (int ring = 1; ring + 1 < rings; ++ring) {
      const int shift = ring % 2;  // odd rings are half a step ahead
      mesh.triangles.push_back({index(ring, side), index(ring, side + 1), index(ring + 1, side + shift)});
      mesh.triangles.push_back(
          {index(ring, side + 1 - shift), index(ring + 1, side + 1), index(ring + 1, side)});
    }
  }
  mesh.face_of.assign(mesh.triangles.size(), 1);
  return mesh;
}

TEST(MeshContours, the_rim_of_a_chorded_cylinder_is_one_arc_with_its_sagitta_as_error) {
  const auto mesh = geometry::testing::cylinder({{3, 4}, 10, 0, 0}, {1, 9}, 40);
  const MeshContours found = contours_of(mesh);
  ASSERT_EQ(found.contours.size(), 2U);
  for (const Contour& contour : found.contours) {
    const auto& arc = std::get<Arc>(contour.curve);
    EXPECT_NEAR(arc.radius_mm, 10, 1e-9);
    EXPECT_LT((arc.center_mm - Vector2d(3, 4)).norm(), 1e-9);
    EXPECT_EQ(arc.sweep_rad, 2 * kPi);
    EXPECT_NEAR(contour.error_mm, 10 * (1 - std::cos(kPi / 40)), 1e-9);
    EXPECT_EQ(contour.trace_mm.size(), 41U);
  }
  EXPECT_EQ(found.counts, (ContourCounts{.edges = 80, .creases = 80}));
}

TEST(MeshContours, the_sides_of_a_polygon_stay_straight) {
  const auto mesh = geometry::testing::cylinder({{3, 4}, 10, 0, 0}, {1, 9}, 8);
  const MeshContours found = contours_of(mesh);
  EXPECT_EQ(found.contours.size(), 16U);
  EXPECT_TRUE(arcs_of(found.contours).empty());
  EXPECT_TRUE(found.rims.empty());
  for (const Contour& contour : found.contours) EXPECT_LT(contour.error_mm, 1e-9);
}

TEST(MeshContours, upright_edges_are_points_in_plan_and_counted) {
  const auto found = contours_of(geometry::testing::block({{0, 0, 0}, {10, 20, 5}}));
  EXPECT_EQ(found.contours.size(), 8U);
  EXPECT_EQ(found.counts, (ContourCounts{.edges = 8, .creases = 8}))
      << "edges between upright facets are none";
  TriangleMesh open = geometry::testing::block({{0, 0, 0}, {10, 20, 5}});
  std::erase_if(open.triangles, [&](const auto& t) {  // without the side at y = 0
    return std::ranges::all_of(t,
                               [&](int v) { return open.vertices_mm[static_cast<std::size_t>(v)].y() == 0; });
  });
  open.face_of.resize(open.triangles.size());
  EXPECT_EQ(contours_of(open).counts.upright, 2);
  EXPECT_EQ(contours_of(open).contours.size(), 8U) << "the border of a hole is a contour like any other";
}

TEST(MeshContours, folds_between_gentle_slopes_are_left_out_and_counted) {
  // a roof: two slopes of 45 degrees over a flat base
  TriangleMesh roof;
  roof.vertices_mm = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {0, 5, 5}, {10, 5, 5}};
  roof.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {3, 4, 5}, {3, 5, 2}, {0, 4, 3}, {1, 2, 5}};
  roof.face_of.assign(8, 1);
  const MeshContours found = contours_of(roof);
  EXPECT_EQ(found.counts.gentle, 1) << "the ridge";
  EXPECT_EQ(found.counts.edges,
            found.counts.creases + found.counts.silhouettes + found.counts.upright + found.counts.gentle);
}

TEST(MeshContours, a_lying_cylinder_has_two_straight_silhouettes) {
  const auto upright = geometry::testing::cylinder({{0, 0}, 5, 0, 0}, {-10, 10}, 34);
  const Eigen::Matrix3d lay = Eigen::AngleAxisd(kPi / 2, Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Matrix3d roll = Eigen::AngleAxisd(0.04, Vector3d::UnitX()).toRotationMatrix();
  const MeshContours found = contours_of(turned(upright, roll * lay));
  int along = 0;
  for (const Contour& contour : found.contours) {
    const auto* segment = std::get_if<Segment>(&contour.curve);
    if (segment == nullptr || std::abs(segment->a_mm.x() - segment->b_mm.x()) < 19) continue;
    ++along;
    EXPECT_NEAR(std::abs(segment->a_mm.y()), 5, contour.error_mm);
  }
  EXPECT_EQ(along, 2);
}

TEST(MeshContours, the_silhouette_of_a_sphere_lies_within_its_stated_error) {
  for (const int rings : {61, 121}) {
    const MeshContours found = contours_of(sphere(10, rings, 2 * rings));
    double covered_rad = 0;
    for (const Contour& contour : found.contours) {
      const auto& arc = std::get<Arc>(contour.curve);
      EXPECT_LE(std::abs(arc.radius_mm - 10) + arc.center_mm.norm(), 1.01 * contour.error_mm);
      EXPECT_LT(contour.error_mm, 0.05);
      covered_rad += arc.sweep_rad;
    }
    EXPECT_GT(covered_rad, 2 * kPi - 0.1);
  }
}

TEST(MeshContours, do_not_depend_on_the_order_of_facets_and_turn_with_the_mesh) {
  const TriangleMesh mesh = ring(6, 10, 5, 36);
  TriangleMesh shuffled = mesh;
  std::ranges::reverse(shuffled.triangles);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.3, Vector3d::UnitZ()).toRotationMatrix();
  for (const TriangleMesh& other : {shuffled, turned(mesh, turn)}) {
    const MeshContours found = contours_of(other);
    EXPECT_EQ(found.counts, contours_of(mesh).counts);
    ASSERT_EQ(found.contours.size(), 4U);
    for (const Arc& arc : arcs_of(found.contours)) {
      EXPECT_LT(arc.center_mm.norm(), 1e-9);
      EXPECT_LT(std::min(std::abs(arc.radius_mm - 6), std::abs(arc.radius_mm - 10)), 1e-9);
    }
  }
}

/// Distances from the axis at which rays along x and y turned by many angles meet the walls.
void expect_walls_at(const TriangleMesh& mesh, double inner_mm, double outer_mm, double height_mm,
                     double within_mm) {
  const geometry::Surface surface(mesh);
  for (int i = 0; i < 500; ++i) {
    const Vector2d out = geometry::direction(0.001 + 2 * kPi * i / 500);
    for (const double z_mm : {0.01, 0.37, 0.5, 0.93}) {
      const Vector3d along(out.x(), out.y(), 0);
      const Vector3d from = Vector3d(0, 0, z_mm * height_mm);
      const auto bore = surface.first_hit({from, along});
      const auto wall = surface.first_hit({from + 20 * along, -along});
      ASSERT_TRUE(bore && wall);
      EXPECT_NEAR(bore->point_mm.head<2>().norm(), inner_mm, within_mm);
      EXPECT_NEAR(wall->point_mm.head<2>().norm(), outer_mm, within_mm);
    }
    // what lies flat reaches as far as the walls
    for (const double radius_mm : {inner_mm, outer_mm}) {
      const double inwards = radius_mm == inner_mm ? 1 : -1;
      EXPECT_TRUE(surface.lowest_above((radius_mm + inwards * 2 * within_mm) * out));
      EXPECT_FALSE(surface.lowest_above((radius_mm - inwards * 2 * within_mm) * out));
    }
  }
}

TEST(MeshRounding, walls_and_flats_follow_the_arcs_that_the_chords_stand_for) {
  const TriangleMesh coarse = ring(6, 10, 5, 28);
  const MeshContours found = contours_of(coarse);
  const TriangleMesh round = rounded(coarse, found.rims, kSagittaMm);
  expect_walls_at(round, 6, 10, 5, kSagittaMm + 1e-9);
  EXPECT_GT(round.triangles.size(), 2 * coarse.triangles.size());
  EXPECT_EQ(round.face_of.size(), round.triangles.size());
  double volume_mm3 = 0;
  for (const auto& [a, b, c] : round.triangles) {
    volume_mm3 += round.vertices_mm[static_cast<std::size_t>(a)].dot(
                      round.vertices_mm[static_cast<std::size_t>(b)].cross(
                          round.vertices_mm[static_cast<std::size_t>(c)])) /
                  6;
  }
  EXPECT_NEAR(volume_mm3, 5 * kPi * (100 - 36), 5 * 2 * kPi * 16 * kSagittaMm) << "facets keep their sense";
}

TEST(MeshRounding, walls_whose_rims_have_other_chords_follow_too) {
  // a wall between a rim of 30 and a rim of 20 chords: its facets have no upright side
  TriangleMesh mesh;
  constexpr int kBelow = 30;
  constexpr int kAbove = 20;
  for (int i = 0; i < kBelow; ++i) {
    const Vector2d p = 8 * geometry::direction(2 * kPi * i / kBelow);
    mesh.vertices_mm.emplace_back(p.x(), p.y(), 0);
  }
  for (int i = 0; i < kAbove; ++i) {
    const Vector2d p = 8 * geometry::direction(2 * kPi * (i + 0.25) / kAbove);
    mesh.vertices_mm.emplace_back(p.x(), p.y(), 6);
  }
  int above = 0;
  int below = 0;
  while (below < kBelow || above < kAbove) {
    const int b = below % kBelow;
    const int a = kBelow + above % kAbove;
    const bool step_below =
        below < kBelow && (above == kAbove || (below + 1.0) / kBelow <= (above + 1.25) / kAbove);
    if (step_below) {
      mesh.triangles.push_back({b, (b + 1) % kBelow, a});
      ++below;
    } else {
      mesh.triangles.push_back({b, kBelow + (above + 1) % kAbove, a});
      ++above;
    }
  }
  for (int i = 1; i + 1 < kBelow; ++i) mesh.triangles.push_back({0, i + 1, i});
  for (int i = 1; i + 1 < kAbove; ++i) mesh.triangles.push_back({kBelow, kBelow + i, kBelow + i + 1});
  mesh.face_of.assign(mesh.triangles.size(), 1);
  const geometry::Surface surface(rounded(mesh, contours_of(mesh).rims, kSagittaMm));
  for (int i = 0; i < 500; ++i) {
    const Vector2d out = geometry::direction(0.001 + 2 * kPi * i / 500);
    for (const double z_mm : {0.1, 2.0, 3.3, 5.9}) {
      const auto hit = surface.first_hit({{20 * out.x(), 20 * out.y(), z_mm}, {-out.x(), -out.y(), 0}});
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->point_mm.head<2>().norm(), 8, kSagittaMm + 1e-9) << z_mm;
    }
  }
}

}  // namespace
}  // namespace pinjaw::part

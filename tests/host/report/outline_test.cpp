#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>

#include "host/report/part_edges.hpp"
#include "tests/host/geometry/solids.hpp"
#include "tests/host/part/shipped_parts.hpp"
#include "tests/host/part/stl_bytes.hpp"
#include "tests/host/planner/features/made_shapes.hpp"

namespace pinjaw::report {
namespace {

using geometry::Vector3d;

constexpr double kCellMm = 0.1;

/// Which cells of a grid over the part have surface above their middle: by the triangles alone.
class Shadow {
 public:
  explicit Shadow(const geometry::Surface& surface)
      : least_mm_(surface.x_range_mm().lo - 1, surface.y_range_mm().lo - 1),
        columns_(cells(surface.x_range_mm())),
        rows_(cells(surface.y_range_mm())),
        dark_(static_cast<std::size_t>(columns_ * rows_)) {
    for (const auto& triangle : surface.mesh().triangles) darken(surface.mesh(), triangle);
  }

  /// The middles between neighbouring cells of which one is dark: within a cell's half of the shadow's
  /// border.
  [[nodiscard]] std::vector<Vector2d> border_mm() const {
    std::vector<Vector2d> border;
    for (int row = 0; row + 1 < rows_; ++row) {
      for (int column = 0; column + 1 < columns_; ++column) {
        const bool here = dark(column, row);
        if (here != dark(column + 1, row)) border.push_back(middle_mm(column + 0.5, row));
        if (here != dark(column, row + 1)) border.push_back(middle_mm(column, row + 0.5));
      }
    }
    return border;
  }

 private:
  static int cells(const geometry::Interval& range_mm) {
    return static_cast<int>((range_mm.length() + 2) / kCellMm);
  }
  [[nodiscard]] Vector2d middle_mm(double column, double row) const {
    return least_mm_ + kCellMm * Vector2d(column + 0.5, row + 0.5);
  }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }
  [[nodiscard]] bool dark(int column, int row) const { return dark_[index(column, row)]; }

  void darken(const geometry::TriangleMesh& mesh, const std::array<int, 3>& triangle) {
    std::array<Vector2d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i)
      corners[i] = mesh.vertices_mm[static_cast<std::size_t>(triangle[i])].head<2>();
    const auto cross = [](const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); };
    const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (area == 0) return;
    const Vector2d lo = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]) - least_mm_;
    const Vector2d hi = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]) - least_mm_;
    for (int row = static_cast<int>(lo.y() / kCellMm); row <= static_cast<int>(hi.y() / kCellMm); ++row) {
      for (int column = static_cast<int>(lo.x() / kCellMm); column <= static_cast<int>(hi.x() / kCellMm);
           ++column) {
        const Vector2d p = middle_mm(column, row);
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i)
          inside &= cross(corners[(i + 1) % 3] - corners[i], p - corners[i]) * area >= 0;
        if (inside) dark_[index(column, row)] = true;
      }
    }
  }

  Vector2d least_mm_;
  int columns_;
  int rows_;
  std::vector<bool> dark_;
};

double distance_mm(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const double t = std::clamp((p - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-18), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

/// The farthest that the border of the part's shadow is from a line drawn bold.
double farthest_from_bold_mm(const part::Part& part) {
  const std::vector<SheetEdge> edges = sheet_edges(part);
  const std::vector<Vector2d> border = Shadow(part.surface).border_mm();
  EXPECT_GT(border.size(), 100U);
  double farthest_mm = 0;
  for (const Vector2d& p : border) {
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (const SheetEdge& edge : edges) {
      if (!edge.from_above) continue;
      for (std::size_t i = 0; i + 1 < edge.points_mm.size(); ++i)
        nearest_mm = std::min(nearest_mm, distance_mm(p, edge.points_mm[i], edge.points_mm[i + 1]));
    }
    farthest_mm = std::max(farthest_mm, nearest_mm);
  }
  return farthest_mm;
}

part::Part stl_part_of(const geometry::TriangleMesh& mesh) {
  const auto file = std::filesystem::path(testing::TempDir()) / "outline.stl";
  std::ofstream(file, std::ios::binary) << part::binary_stl(mesh);
  return part::read_part(part::source_of(file)).value();
}

TEST(Outline, of_an_stl_block_is_closed) {
  EXPECT_LT(farthest_from_bold_mm(stl_part_of(geometry::testing::block({{0, 0, 0}, {40, 20, 5}}))), 0.1);
}

TEST(Outline, of_a_mesh_that_is_open_and_has_no_edges_known_is_closed) {
  auto mesh = geometry::testing::block({{0, 0, 0}, {40, 20, 5}});
  part::Part part = stl_part_of(mesh);
  mesh.triangles.pop_back();
  part.surface = geometry::Surface(mesh);
  part.contours.clear();
  EXPECT_LT(farthest_from_bold_mm(part), 0.1);
}

TEST(Outline, of_a_cylinder_on_its_side_is_closed_where_no_edge_of_the_file_draws_it) {
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(3, 1, 0), Vector3d(3, 1, 1)}) {
    EXPECT_LT(farthest_from_bold_mm(planner::part_of(planner::rod({0, 0, 10}, axis, 6, 25, 0.4))), 0.1)
        << axis.transpose();
  }
}

TEST(Outline, of_rounded_shapes_and_their_holes_is_closed) {
  EXPECT_LT(farthest_from_bold_mm(planner::part_of(planner::ball({0, 0, 8}, 8))), 0.1);
  EXPECT_LT(farthest_from_bold_mm(planner::part_of(planner::ring({0, 0, 8}, {0.3, 0, 1}, 12, 3))), 0.1);
  EXPECT_LT(farthest_from_bold_mm(planner::part_of(planner::filleted_box({{0, 0, 0}, {20, 12, 8}}, 2))), 0.1);
  EXPECT_LT(farthest_from_bold_mm(planner::part_of(planner::drafted_box({20, 12, 8}, 0.05, 3))), 0.1);
}

TEST(Outline, what_lies_under_a_roof_is_not_bold) {
  const auto part = planner::part_of(planner::boxes({{{0, 0, 4}, {30, 30, 8}}, {{10, 10, 0}, {20, 20, 5}}}));
  int foot = 0;
  for (const SheetEdge& edge : sheet_edges(part)) {
    const Vector2d middle = (edge.points_mm.front() + edge.points_mm.back()) / 2;
    if ((middle - Vector2d(15, 15)).cwiseAbs().maxCoeff() > 6) continue;
    ++foot;
    EXPECT_TRUE(edge.from_below && !edge.from_above) << middle.transpose();
  }
  EXPECT_GE(foot, 4);
}

}  // namespace
}  // namespace pinjaw::report

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "host/part/placing.hpp"

namespace pinjaw::part {
namespace {

/// Meshed circles have points at most this far apart; a wider gap is where the cylinder ends.
constexpr double kGapRad = 0.6;

using Points = std::vector<Vector3d>;

std::map<int, Points> points_by_face(const geometry::TriangleMesh& mesh) {
  std::map<int, Points> points;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Points& of_face = points[mesh.face_of[i]];
    for (const int corner : mesh.triangles[i]) {
      of_face.push_back(mesh.vertices_mm[static_cast<std::size_t>(corner)]);
    }
  }
  return points;
}

geometry::Interval heights_of(const Points& points) {
  const auto [lo, hi] = std::ranges::minmax(points, {}, [](const Vector3d& p) { return p.z(); });
  return {lo.z(), hi.z()};
}

std::optional<geometry::Curve> in_plan(const PlaneFace& plane, const Matrix3d& rotation,
                                       const Points& points) {
  const Vector3d normal = rotation * plane.normal;
  if (std::abs(normal.z()) > kUprightSine) return std::nullopt;
  const Vector2d along = Vector2d(-normal.y(), normal.x()).normalized();
  const auto reach = [&](const Vector3d& p) { return along.dot(p.head<2>()); };
  const auto [lo, hi] = std::ranges::minmax(points, {}, reach);
  return geometry::Segment{lo.head<2>(), hi.head<2>()};
}

/// The smallest arc about `center_mm` that holds every angle; a full turn where no gap is wide enough.
geometry::Arc arc_over(std::vector<double> angles_rad, const Vector2d& center_mm, double radius_mm) {
  constexpr double kTurn = 2 * std::numbers::pi;
  std::ranges::sort(angles_rad);
  double gap_rad = angles_rad.front() + kTurn - angles_rad.back();
  double from_rad = angles_rad.front();
  for (std::size_t i = 1; i < angles_rad.size(); ++i) {
    if (angles_rad[i] - angles_rad[i - 1] <= gap_rad) continue;
    gap_rad = angles_rad[i] - angles_rad[i - 1];
    from_rad = angles_rad[i];
  }
  if (gap_rad < kGapRad) return {center_mm, radius_mm, 0, kTurn};
  return {center_mm, radius_mm, from_rad, kTurn - gap_rad};
}

std::optional<geometry::Curve> in_plan(const CylinderFace& cylinder, const Matrix3d& rotation,
                                       const Points& points) {
  const Vector3d axis = rotation * cylinder.axis;
  if (axis.head<2>().norm() > kUprightSine) return std::nullopt;
  const Vector2d center_mm = (rotation * cylinder.point_mm).head<2>();
  std::vector<double> angles_rad;
  for (const Vector3d& p : points) {
    const Vector2d spoke = p.head<2>() - center_mm;
    angles_rad.push_back(geometry::wrapped_rad(std::atan2(spoke.y(), spoke.x())));
  }
  return arc_over(std::move(angles_rad), center_mm, cylinder.radius_mm);
}

}  // namespace

std::vector<Wall> walls_of(const std::vector<WallFace>& faces, const Matrix3d& rotation,
                           const geometry::TriangleMesh& rotated_mesh) {
  const auto points = points_by_face(rotated_mesh);
  std::vector<Wall> walls;
  for (const WallFace& face : faces) {
    const auto found = points.find(face.face);
    if (found == points.end()) continue;
    const auto curve =
        std::visit([&](const auto& s) { return in_plan(s, rotation, found->second); }, face.surface);
    if (curve) walls.push_back({face.face, *curve, heights_of(found->second)});
  }
  return walls;
}

}  // namespace pinjaw::part

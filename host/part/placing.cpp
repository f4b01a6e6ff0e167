#include "host/part/placing.hpp"

#include <cmath>
#include <numbers>

namespace pinjaw::part {
namespace {

struct Rotated {
  const Matrix3d& rotation;

  Curve3 operator()(const Line3& line) const { return Line3{rotation * line.a_mm, rotation * line.b_mm}; }
  Curve3 operator()(const Ellipse3& arc) const {
    return Ellipse3{rotation * arc.center_mm, rotation * arc.u_mm, rotation * arc.v_mm, arc.from_rad,
                    arc.sweep_rad};
  }
  Curve3 operator()(const Polyline3& line) const {
    Polyline3 result = line;
    for (Vector3d& p : result.points_mm) p = rotation * p;
    return result;
  }
};

Vector2d mirrored(Vector2d p_mm, int axis) {
  p_mm[axis] = -p_mm[axis];
  return p_mm;
}

}  // namespace

Curve3 rotated(const Curve3& curve, const Matrix3d& rotation) {
  return std::visit(Rotated{rotation}, curve);
}

geometry::TriangleMesh rotated(geometry::TriangleMesh mesh, const Matrix3d& rotation) {
  for (Vector3d& p : mesh.vertices_mm) p = rotation * p;
  for (geometry::Silhouette& line : mesh.silhouettes) {
    for (Vector3d& p : line.points_mm) p = rotation * p;
  }
  for (Vector3d& normal : mesh.normals) normal = rotation * normal;
  return mesh;
}

geometry::Curve mirrored(const geometry::Curve& curve, int axis) {
  if (const auto* segment = std::get_if<geometry::Segment>(&curve)) {
    return geometry::Segment{mirrored(segment->b_mm, axis), mirrored(segment->a_mm, axis)};
  }
  geometry::Arc arc = std::get<geometry::Arc>(curve);
  arc.center_mm = mirrored(arc.center_mm, axis);
  const double to_rad = arc.from_rad + arc.sweep_rad;
  arc.from_rad = axis == 0 ? std::numbers::pi - to_rad : -to_rad;
  return arc;
}

model::Profile mirrored(model::Profile profile, int axis) {
  for (auto& loop : profile.loops) {
    for (auto& edge : loop) edge.curve = mirrored(edge.curve, axis);
  }
  return profile;
}

Part placed(BrepValues values, const Matrix3d& rotation) {
  for (EdgeCurve& edge : values.edges.edges) edge.curve = rotated(edge.curve, rotation);
  geometry::TriangleMesh mesh = rotated(std::move(values.mesh.mesh), rotation);
  auto walls = walls_of(values.wall_faces, rotation, mesh);
  return Part{.name = {},
              .file = {},
              .sha256 = {},
              .surface = geometry::Surface(std::move(mesh)),
              .edges = std::move(values.edges.edges),
              .walls = std::move(walls),
              .contours = {},
              .edge_counts = values.edges.counts,
              .mesh_deflection_mm = values.mesh.deflection_mm,
              .solids = std::move(values.solids),
              .volume_mm3 = values.mass.volume_mm3,
              .centroid_mm = rotation * values.mass.centroid_mm,
              .profile = {}};
}

}  // namespace pinjaw::part

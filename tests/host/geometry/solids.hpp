#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "host/geometry/mesh.hpp"
#include "host/geometry/plane.hpp"

/// Meshes whose every height is known by hand, for tests of the planner.
namespace pinjaw::geometry::testing {

/// An upright block between two corners.
struct Bounds {
  Vector3d lo;
  Vector3d hi;
};

/// Adds `other` to `mesh`; its faces are numbered on.
inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const int shift = static_cast<int>(mesh.vertices_mm.size());
  const int face = mesh.face_of.empty() ? 0 : mesh.face_of.back() + 1;
  mesh.vertices_mm.insert(mesh.vertices_mm.end(), other.vertices_mm.begin(), other.vertices_mm.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  for (const int f : other.face_of) mesh.face_of.push_back(f + face);
}

/// A prism over a counter-clockwise convex outline; faces: one for each side, then bottom, then top.
inline TriangleMesh prism(const std::vector<Vector2d>& outline_mm, Interval z_mm) {
  TriangleMesh mesh;
  const int n = static_cast<int>(outline_mm.size());
  for (const double z : {z_mm.lo, z_mm.hi}) {
    for (const Vector2d& p : outline_mm) mesh.vertices_mm.emplace_back(p.x(), p.y(), z);
  }
  const auto add = [&](int a, int b, int c, int face) {
    mesh.triangles.push_back({a, b, c});
    mesh.face_of.push_back(face);
  };
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    add(i, j, n + j, i);
    add(i, n + j, n + i, i);
  }
  for (int i = 1; i + 1 < n; ++i) {
    add(0, i + 1, i, n);
    add(n, n + i, n + i + 1, n + 1);
  }
  return mesh;
}

inline TriangleMesh block(const Bounds& b) {
  return prism({{b.lo.x(), b.lo.y()}, {b.hi.x(), b.lo.y()}, {b.hi.x(), b.hi.y()}, {b.lo.x(), b.hi.y()}},
               {b.lo.z(), b.hi.z()});
}

/// Several blocks in one mesh: overlapping or touching, as a queried surface may be.
inline TriangleMesh blocks(const std::vector<Bounds>& all) {
  TriangleMesh mesh;
  for (const Bounds& b : all) append(mesh, block(b));
  return mesh;
}

/// An upright cylinder of `sides` flat sides, its corners on the circle.
inline TriangleMesh cylinder(const Arc& circle, Interval z_mm, int sides) {
  std::vector<Vector2d> outline_mm;
  for (int i = 0; i < sides; ++i) {
    outline_mm.push_back(circle.center_mm + circle.radius_mm * direction(2 * std::numbers::pi * i / sides));
  }
  return prism(outline_mm, z_mm);
}

}  // namespace pinjaw::geometry::testing

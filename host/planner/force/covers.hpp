#pragma once

#include <vector>

#include "host/geometry/plane.hpp"

/// Finitely many loads that stand for every direction: F_sq is convex, so what holds at the corners of a
/// polyhedron holds inside it, and a polyhedron around the ball misses no direction. It asks for a little
/// more than the ball does: the corners stick out by the share stated.
namespace pinjaw::planner {

/// A polyhedron around the unit ball: 162 corners, 1.8 % outside it at most (an icosahedron, each face split
/// in sixteen).
const std::vector<geometry::Vector3d>& corners_around_ball();

/// A regular polygon around the unit circle across `axis` (unit): 24 corners, 0.9 % outside it.
std::vector<geometry::Vector3d> corners_around_circle(const geometry::Vector3d& axis);

}  // namespace pinjaw::planner

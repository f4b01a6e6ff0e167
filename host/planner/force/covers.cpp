#include "host/planner/force/covers.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace pinjaw::planner {
namespace {

using geometry::Vector3d;
using Face = std::array<int, 3>;

/// Triangles on the unit sphere.
struct Globe {
  std::vector<Vector3d> corners;
  std::vector<Face> faces;
};

Globe icosahedron() {
  const double g = std::numbers::phi;
  Globe globe;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-g, g}) {
      globe.corners.emplace_back(0, a, b);
      globe.corners.emplace_back(a, b, 0);
      globe.corners.emplace_back(b, 0, a);
    }
  }
  // neighbours lie 2 apart; every three mutual neighbours are a face
  const auto near = [&](int i, int j) {
    return std::abs((globe.corners[static_cast<std::size_t>(i)] - globe.corners[static_cast<std::size_t>(j)])
                        .norm() -
                    2) < 1e-9;
  };
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        if (near(i, j) && near(j, k) && near(i, k)) globe.faces.push_back({i, j, k});
      }
    }
  }
  for (Vector3d& corner : globe.corners) corner.normalize();
  return globe;
}

/// Each face in four, the new corners on the sphere.
Globe split(const Globe& coarse) {
  Globe fine{coarse.corners, {}};
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int i, int j) {
    const auto [found, is_new] = middles.emplace(std::minmax(i, j), static_cast<int>(fine.corners.size()));
    if (is_new) {
      const Vector3d sum =
          fine.corners[static_cast<std::size_t>(i)] + fine.corners[static_cast<std::size_t>(j)];
      fine.corners.push_back(sum.normalized());
    }
    return found->second;
  };
  for (const auto& [a, b, c] : coarse.faces) {
    const int ab = middle(a, b);
    const int bc = middle(b, c);
    const int ca = middle(c, a);
    for (const Face& face : {Face{a, ab, ca}, Face{b, bc, ab}, Face{c, ca, bc}, Face{ab, bc, ca}}) {
      fine.faces.push_back(face);
    }
  }
  return fine;
}

/// Distance from the centre to the nearest face: the radius of the ball inside.
double inner_radius(const Globe& globe) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : globe.faces) {
    const Vector3d& p = globe.corners[static_cast<std::size_t>(a)];
    const Vector3d normal = (globe.corners[static_cast<std::size_t>(b)] - p)
                                .cross(globe.corners[static_cast<std::size_t>(c)] - p)
                                .normalized();
    least = std::min(least, std::abs(normal.dot(p)));
  }
  return least;
}

}  // namespace

const std::vector<Vector3d>& corners_around_ball() {
  static const std::vector<Vector3d> kCorners = [] {
    const Globe globe = split(split(icosahedron()));
    std::vector<Vector3d> corners = globe.corners;
    const double radius = inner_radius(globe);
    for (Vector3d& corner : corners) corner /= radius;
    return corners;
  }();
  return kCorners;
}

std::vector<Vector3d> corners_around_circle(const Vector3d& axis) {
  constexpr int kCorners = 24;
  const Vector3d u = axis.unitOrthogonal();
  const Vector3d v = axis.cross(u);
  const double radius = 1 / std::cos(std::numbers::pi / kCorners);
  std::vector<Vector3d> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / kCorners;
    corners.emplace_back(radius * (std::cos(angle_rad) * u + std::sin(angle_rad) * v));
  }
  return corners;
}

}  // namespace pinjaw::planner

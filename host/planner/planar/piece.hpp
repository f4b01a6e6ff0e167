#pragma once

#include <vector>

#include "host/model/kit.hpp"
#include "host/planner/planar/pair.hpp"

namespace pinjaw::planner::planar {

/// A pair of pins of one jaw in whole holes: B stands `columns` further from the other jaw and `rows` higher
/// than A, rows > 0, or rows = 0 and columns > 0, so that a set of two pins is told in one way only.
struct HolePair {
  int columns = 0;
  int rows = 0;
};

/// A short part of a pair's curve in the (theta, y) plane, seen from the left jaw's pin A.
///
/// Smooth: y = sum of c_k (theta - lo)^k within kPieceError_mm. Upright (theta almost still: parallel lines,
/// coinciding circles, next to a fold): y anywhere in y_mm.
struct Piece {
  int a = 0;  ///< contact curves of the two pins
  int b = 0;
  HolePair holes;
  bool upright = false;
  geometry::Interval theta_rad;
  double c[4] = {0, 0, 0, 0};
  geometry::Interval y_mm;
  double cone_rad = 0;       ///< middle of the two outward normals, in the part frame
  double cone_half_rad = 0;  ///< half the angle between them; pi where arcs take part (not told)
};

inline constexpr double kPieceError_mm = 2e-5;  // chosen: roots are polished; this only steers the search

/// The pieces of every pair of a left jaw: all curves, all hole offsets of the grid, distinct and not
/// overlapping pins. Grouped by a. A right jaw's are the same turned by 180 degrees.
std::vector<Piece> pair_pieces(const std::vector<ContactCurve>& curves, const model::Kit& kit);

/// y and dy/dtheta of a smooth piece.
struct Level {
  double y_mm = 0;
  double slope = 0;
};
inline Level level_at(const Piece& piece, double theta_rad) {
  const double t = theta_rad - piece.theta_rad.lo;
  const double* c = piece.c;
  return {c[0] + t * (c[1] + t * (c[2] + t * c[3])), c[1] + t * (2 * c[2] + 3 * t * c[3])};
}

}  // namespace pinjaw::planner::planar

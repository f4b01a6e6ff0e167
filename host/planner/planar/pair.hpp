#pragma once

#include <optional>
#include <vector>

#include "host/planner/planar/contact_curve.hpp"

namespace pinjaw::planner::planar {

/// Two pins of one jaw on two curves: pin A in the origin, pin B at `apart_mm`, seen from the left jaw.
///
/// While both touch, the part has one freedom: the origin o(theta) of the part moves along a curve of the
/// (theta, y) plane, in up to two branches where an arc takes part. Where both contact normals turn parallel
/// the branches meet in a fold; for parallel lines and for coinciding circles the curve is a vertical line.
struct Pair {
  const ContactCurve* a = nullptr;
  const ContactCurve* b = nullptr;
  Vector2d apart_mm = Vector2d::Zero();
};

/// The part while both pins of a pair touch.
struct PairState {
  Vector2d o_mm = Vector2d::Zero();      ///< part origin seen from pin A
  double y_slope = 0;                    ///< dy/dtheta along the branch; not finite at a fold
  Vector2d normal_a = Vector2d::Zero();  ///< outward normals in the jaw frame
  Vector2d normal_b = Vector2d::Zero();
};

/// The pair at `theta_rad` on `branch` (0 or 1; lines only have 0); nothing where the branch does not exist.
/// A miss by rounding at a fold counts as the fold.
std::optional<PairState> state_at(const Pair& pair, double theta_rad, int branch);

/// Stretch of theta where a branch exists, both feet are in range and both pins push the part to +x.
struct Stretch {
  int branch = 0;
  geometry::Interval theta_rad;  ///< within one of [0, pi], [pi, 2 pi]
};
std::vector<Stretch> stretches(const Pair& pair);

/// A value of theta at which the pair holds for a whole range of y: parallel lines or coinciding circles.
struct Standstill {
  double theta_rad = 0;
  geometry::Interval y_mm;  ///< may be generous: what is found there is checked
};
std::vector<Standstill> standstills(const Pair& pair);

/// Whether the contact normals are parallel all along, so that only `standstills` applies.
bool parallel_lines(const Pair& pair);

}  // namespace pinjaw::planner::planar

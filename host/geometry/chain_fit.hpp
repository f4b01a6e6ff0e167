#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/geometry/plane.hpp"

namespace pinjaw::geometry {

/// What a curve may differ from the chain that it stands for.
struct FitLimits {
  double tolerance_mm = 0;  ///< farthest that a point of the chain may lie from the curve
  /// Farthest that the middle of a chord may lie from its arc: what tells a chorded circle from a polygon.
  double most_sagitta_mm = 0;
};

/// One segment or arc in place of a run of chain points.
struct FittedPiece {
  Curve curve;  ///< a segment runs along the chain; an arc counter-clockwise whatever the chain does
  bool clockwise = false;  ///< the chain runs the arc backwards
  std::size_t first = 0;   ///< index of the run's first point; neighbouring runs share a point
  std::size_t last =
      0;                ///< index of its last; at most `first` where the run passes the end of a closed chain
  double error_mm = 0;  ///< worst distance of the run's points from the curve
  double sagitta_mm = 0;  ///< worst distance of the run's chords from the arc; 0 for a segment
};

/// The fewest segments and arcs that follow a chain of points, in the chain's order.
///
/// `chain_mm` lists the points in order; a closed chain does not repeat its first. A run of points is one
/// segment where a line passes all of them within the tolerance, else one arc where it has at least four
/// points, passes the least-squares circle within the tolerance, turns one way by at most kMostStepRad a
/// chord and bulges by at most the limit beyond its chords. Among the ways with the fewest pieces the breaks
/// are where the squares of the distances sum to least. A closed chain on one circle is one arc of sweep 2 pi
/// that covers index 0 to 0. Repeated points are passed over; nothing comes of fewer than two different
/// points.
std::vector<FittedPiece> fitted_pieces(std::span<const Vector2d> chain_mm, bool closed,
                                       const FitLimits& limits);

/// The widest chord of an arc: mesh makers turn by 0.5 rad a chord or less; 12 chords a turn still count.
inline constexpr double kMostStepRad = 0.6;

}  // namespace pinjaw::geometry

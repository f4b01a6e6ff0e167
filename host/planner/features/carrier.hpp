#pragma once

#include <optional>
#include <vector>

#include "host/model/feature.hpp"
#include "host/planner/features/projection.hpp"

/// Whole lines and circles that plan curves lie on. Private to phase 1.
namespace pinjaw::planner {

/// What a part of a carrier is covered by.
struct Piece {
  geometry::Interval along_mm;
  const PlanCurve* curve = nullptr;  ///< one of the projection that the carriers come from
};

/// Which side of a carrier is free, seen along its travel; a circle travels counter-clockwise, its right is
/// outside.
enum class FreeSide { None, Right, Left };

/// An endless line or a full circle, and the plan curves that lie on it: coincident edges share one carrier.
///
/// Positions are arc lengths: from `origin_mm` on a line; from angle 0 in [0, circumference] on a circle,
/// where a piece that runs through angle 0 is held as two.
struct Carrier {
  bool round = false;
  geometry::Vector2d origin_mm = geometry::Vector2d::Zero();  ///< the circle's centre, or a point of the line
  geometry::Vector2d along = geometry::Vector2d::UnitX();     ///< unit, of a line
  double radius_mm = 0;
  std::vector<Piece> pieces;

  [[nodiscard]] geometry::Vector2d point_at(double along_mm) const;
  [[nodiscard]] geometry::Vector2d right_at(double along_mm) const;  ///< unit normal to the right of travel
  [[nodiscard]] double position_of(const geometry::Vector2d& p_mm) const;
  [[nodiscard]] double distance_mm(const geometry::Vector2d& p_mm) const;
  [[nodiscard]] double circumference_mm() const;
  [[nodiscard]] bool covers(double along_mm, double margin_mm) const;
  /// The curves that cover the position.
  [[nodiscard]] std::vector<const PlanCurve*> curves_at(double along_mm) const;
  /// The stretch as a feature's curve, directed by its free side.
  [[nodiscard]] geometry::Curve curve_over(const geometry::Interval& stretch_mm, FreeSide side) const;
};

/// Curves within this of one line or circle lie on it. Exported parts agree to 1e-7, real ones to about 1e-3.
inline constexpr double kSameCarrierMm = 1e-3;

/// Pieces of one carrier end at most this far apart where a file's tolerance parts what is one edge. Chosen:
/// half of eps.
inline constexpr double kBridgedMm = model::kEps_mm / 2;

/// The carriers point into `projection`, which must outlive them.
std::vector<Carrier> carriers_of(const Projection& projection);

/// Positions that cut carrier `which` into edgelets: ends of its pieces and crossings with the pieces of all
/// others. Sorted; none nearer than kSameCarrierMm to the next.
std::vector<double> split_positions_mm(const std::vector<Carrier>& carriers, std::size_t which);

}  // namespace pinjaw::planner

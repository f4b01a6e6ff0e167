#pragma once

#include <array>

#include "host/geometry/plane.hpp"
#include "host/model/design.hpp"
#include "host/model/kit.hpp"

namespace pinjaw::planner {

/// One pin of a planar fixture, on one feature. Everything but the hole is independent of column and row
/// shifts.
struct PlanarPin {
  model::Hole hole;           ///< canonical: the least column of each jaw and the least row are 0
  int feature = 0;            ///< id of the feature it touches
  double along_mm = 0;        ///< where on the feature's curve the foot lies
  double foot_margin_mm = 0;  ///< from the foot to the nearer end of the feature
  geometry::Vector2d p_PFoot_mm = geometry::Vector2d::Zero();  ///< contact point in the (turned) part frame
  geometry::Vector2d n_P = geometry::Vector2d::Zero();  ///< unit, from the pin into the part, part frame
};

/// Four pins, a part pose and a jaw separation in strict planar form closure (WC; DESIGN 3, phase 2).
struct PlanarFixture {
  model::Split split = model::Split::TwoTwo;
  double theta_rad = 0;           ///< part orientation in the gripper frame, [0, 2 pi)
  double span_mm = 0;             ///< D = s + 2 e as if the innermost used columns were 0
  double y_mm = 0;                ///< part origin's y above row 0 of the canonical pins
  double x_left_mm = 0;           ///< part origin's x from the innermost used column of the left jaw
  double closure_margin = 0;      ///< least multiplier, their sum being 1
  std::array<PlanarPin, 4> pins;  ///< sorted by hole: left jaw first, then column, then row
};

/// Extra columns that each jaw's pins move outwards, and the jaw separation that follows.
struct ColumnShift {
  int left = 0;
  int right = 0;
  double jaw_separation_mm = 0;
};

}  // namespace pinjaw::planner

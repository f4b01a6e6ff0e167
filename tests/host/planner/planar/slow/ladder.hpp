#pragma once

#include <vector>

#include "tests/host/planner/planar/slow/stand.hpp"

namespace pinjaw::planner::slow {

/// Two pins of one jaw, B `columns` outwards and `rows` above A; rows > 0, or rows = 0 and columns > 0.
struct HolePair {
  int columns = 0;
  int rows = 0;
  friend auto operator<=>(const HolePair&, const HolePair&) = default;
};

/// The part while both pins touch: its origin seen from pin A, and how it is turned.
struct Rung {
  double theta_rad = 0;
  geometry::Vector2d o_mm = geometry::Vector2d::Zero();
};

/// A short way that the two pins can go along their features.
struct Slide {
  int a = 0;
  int b = 0;
  HolePair holes;
  Rung from;
  Rung to;  ///< theta less than half a turn from that of `from`
};

/// All ways of all pairs of pins of a jaw, found in the frame of the part: a pair is a ladder of fixed length
/// whose feet run along two tracks. Over the places of both feet, the ladder fits on curves; where they cross
/// a grid of lines is plane geometry (one foot fixed, the other where its track is a ladder's length away),
/// and the crossings of one cell are joined. Neither turning points nor standstills of theta are special.
/// Kept where both pins push inwards or nearly.
std::vector<Slide> slides(const Task& task, model::JawSide jaw);

}  // namespace pinjaw::planner::slow

#pragma once

#include <string>
#include <vector>

#include "host/model/design.hpp"
#include "host/model/kit.hpp"
#include "host/report/picture.hpp"

namespace pinjaw::report {

/// An edge of the part in plan, in the part frame turned by the task's side, chorded.
struct SheetEdge {
  std::vector<Vector2d> points_mm;
  bool from_above = false;  ///< seen from the side away from the plates: drawn bold
  bool from_below = false;  ///< seen from the plates: drawn thin and grey
};

/// What a set-up sheet tells the person who puts the pins in.
struct Sheet {
  std::string task;
  std::string part;
  std::string part_sha256;
  std::string side;  ///< "below" or "above"
  double friction = 0;
  std::string friction_model;  ///< "pyramid" or "cone"
  model::Kit kit;
  model::Design design;
  std::vector<SheetEdge> edges;
  bool grips = true;  ///< false: a pallet; no force is told
};

/// A set-up sheet at 1:1 on the smallest paper it fits (A4, A3, else its own size): both plates with all
/// holes named (L-C0-R3: left jaw, column 0, row 3), pins with hole and cut length, the part's edges in place
/// (BB fig. 2), jaw separation closed and open, squeeze force, the pin table, and a 50 mm bar to check the
/// print's scale.
Picture sheet_picture(const Sheet& sheet);

/// `L-C0-R3`.
std::string hole_label(const model::Hole& hole);

}  // namespace pinjaw::report

#include <algorithm>
#include <cmath>

#include "host/planner/interference/adjustment.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;
using model::JawSide;

/// The least column of a jaw's pins; nothing where it has none.
std::optional<int> least_column(const model::Design& design, JawSide jaw) {
  std::optional<int> least;
  for (const model::PinDesign& pin : design.pins) {
    if (pin.hole.jaw == jaw && (!least || pin.hole.column < *least)) least = pin.hole.column;
  }
  return least;
}

/// Columns that each jaw moves outwards from where the design has them.
struct Columns {
  int left = 0;
  int right = 0;
  double jaw_separation_mm = 0;
};

/// A jaw without pins (a pallet's) moves as the jaw separation tells.
Columns columns_of(const model::Design& design, const model::Grid& grid,
                   const model::Alternative& alternative) {
  const double gained_mm = design.jaw_separation_mm - alternative.jaw_separation_mm;
  const int total = static_cast<int>(std::lround(gained_mm / grid.spacing_mm));
  if (const auto left = least_column(design, JawSide::Left)) {
    return {alternative.left_shift - *left, total - (alternative.left_shift - *left),
            alternative.jaw_separation_mm};
  }
  const int right = alternative.right_shift - least_column(design, JawSide::Right).value_or(0);
  return {total - right, right, alternative.jaw_separation_mm};
}

/// How far the part moves in the gripper frame: rows along y, columns by half their difference along x, since
/// the gripper's origin lies midway between the plates.
Vector2d moved_mm(const model::Grid& grid, const Stance& stance) {
  return grid.spacing_mm * Vector2d((stance.right_shift - stance.left_shift) / 2.0, stance.row_shift);
}

}  // namespace

std::vector<Stance> stances_of(const model::Design& design, const model::Kit& kit) {
  const auto by_row = [](const model::PinDesign& a, const model::PinDesign& b) {
    return a.hole.row < b.hole.row;
  };
  const auto [low, high] = std::minmax_element(design.pins.begin(), design.pins.end(), by_row);
  const bool opens = design.jaw_open_mm > design.jaw_separation_mm;
  std::vector<Columns> columns{{0, 0, design.jaw_separation_mm}};
  for (const model::Alternative& other : design.alternatives)
    columns.push_back(columns_of(design, kit.grid, other));

  std::vector<Stance> stances;
  for (const Columns& column : columns) {
    for (int row = -low->hole.row; row <= kit.grid.rows - 1 - high->hole.row; ++row) {
      Stance stance{row,
                    column.left,
                    column.right,
                    column.jaw_separation_mm,
                    column.jaw_separation_mm,
                    design.part_pose};
      if (opens) stance.jaw_open_mm = model::open_separation_mm(kit.jaws, column.jaw_separation_mm);
      stance.part_pose.t_mm += moved_mm(kit.grid, stance);
      stances.push_back(stance);
    }
  }
  const auto moves = [](const Stance& s) {
    return std::abs(s.row_shift) + std::abs(s.left_shift) + std::abs(s.right_shift);
  };
  std::stable_sort(stances.begin(), stances.end(),
                   [&](const Stance& a, const Stance& b) { return moves(a) < moves(b); });
  return stances;
}

model::Design moved(const model::Design& design, const model::Kit& kit, const Stance& stance) {
  model::Design result = design;
  result.jaw_separation_mm = stance.jaw_separation_mm;
  result.jaw_open_mm = stance.jaw_open_mm;
  result.part_pose = stance.part_pose;
  for (model::PinDesign& pin : result.pins) {
    pin.hole.row += stance.row_shift;
    pin.hole.column += pin.hole.jaw == JawSide::Left ? stance.left_shift : stance.right_shift;
    pin.contact_mm += moved_mm(kit.grid, stance);
  }
  if (stance.left_shift == 0 && stance.right_shift == 0) return result;
  const int left = least_column(design, JawSide::Left).value_or(0);
  const int right = least_column(design, JawSide::Right).value_or(0);
  for (model::Alternative& other : result.alternatives) {
    const Columns columns = columns_of(design, kit.grid, other);
    if (columns.left == stance.left_shift && columns.right == stance.right_shift) {
      other = {left, right, design.jaw_separation_mm};
    }
  }
  return result;
}

}  // namespace pinjaw::planner

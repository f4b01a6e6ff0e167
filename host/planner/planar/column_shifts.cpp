#include "host/planner/planar/column_shifts.hpp"

#include <algorithm>
#include <cassert>

namespace pinjaw::planner {
namespace {

constexpr double kSeparationTolerance_mm = 1e-9;  // chosen: rounding of the span, far below any plate's play

int column_extent(const PlanarFixture& fixture, model::JawSide jaw) {
  int extent = 0;
  for (const PlanarPin& pin : fixture.pins) {
    if (pin.hole.jaw == jaw) extent = std::max(extent, pin.hole.column);
  }
  return extent;
}

}  // namespace

std::vector<ColumnShift> column_shifts(const model::Kit& kit, const PlanarFixture& fixture) {
  const int left_room = kit.grid.columns - 1 - column_extent(fixture, model::JawSide::Left);
  const int right_room = kit.grid.columns - 1 - column_extent(fixture, model::JawSide::Right);
  std::vector<ColumnShift> shifts;
  if (left_room < 0 || right_room < 0) return shifts;
  for (int total = 0; total <= left_room + right_room; ++total) {
    const double s_mm = fixture.span_mm - 2 * kit.grid.edge_offset_mm - total * kit.grid.spacing_mm;
    if (s_mm > kit.jaws.separation_mm.hi + kSeparationTolerance_mm) continue;
    if (s_mm < kit.jaws.separation_mm.lo - kSeparationTolerance_mm) break;
    for (int left = std::min(total, left_room); left >= std::max(0, total - right_room); --left) {
      shifts.push_back({left, total - left, s_mm});
    }
  }
  return shifts;
}

int row_extent(const PlanarFixture& fixture) {
  const auto by_row = [](const PlanarPin& a, const PlanarPin& b) { return a.hole.row < b.hole.row; };
  const auto [low, high] = std::minmax_element(fixture.pins.begin(), fixture.pins.end(), by_row);
  return high->hole.row - low->hole.row;
}

int centred_row_shift(const model::Kit& kit, const PlanarFixture& fixture) {
  return std::max(0, (kit.grid.rows - 1 - row_extent(fixture)) / 2);
}

PlacedFixture place(const model::Kit& kit, const PlanarFixture& fixture, const ColumnShift& shift,
                    int row_shift) {
  PlacedFixture placed;
  placed.jaw_separation_mm = shift.jaw_separation_mm;
  for (std::size_t i = 0; i < fixture.pins.size(); ++i) {
    model::Hole hole = fixture.pins[i].hole;
    hole.column += hole.jaw == model::JawSide::Left ? shift.left : shift.right;
    hole.row += row_shift;
    placed.holes[i] = hole;
  }
  const geometry::Vector2d p_GHole_mm =
      model::p_GHole_mm(kit.grid, {model::JawSide::Left, shift.left, row_shift}, shift.jaw_separation_mm);
  placed.part_pose.theta_rad = fixture.theta_rad;
  placed.part_pose.t_mm = p_GHole_mm + geometry::Vector2d(fixture.x_left_mm, fixture.y_mm);
  return placed;
}

PlacedFixture placed_least(const model::Kit& kit, const PlanarFixture& fixture) {
  const std::vector<ColumnShift> shifts = column_shifts(kit, fixture);
  assert(!shifts.empty());
  return place(kit, fixture, shifts.front(), 0);
}

}  // namespace pinjaw::planner

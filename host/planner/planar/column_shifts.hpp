#pragma once

#include <array>
#include <vector>

#include "host/model/design.hpp"
#include "host/model/kit.hpp"
#include "host/planner/planar/planar_fixture.hpp"

namespace pinjaw::planner {

/// Every pair of column shifts of `fixture` that the plates have room for and that brings the jaw separation
/// into the kit's range (closed, within 1e-9 mm). Least total shift (largest separation) first; among equal
/// totals the left jaw's columns moved first, so the first entry is where planar JSON puts the pins. Empty:
/// no fixture.
std::vector<ColumnShift> column_shifts(const model::Kit& kit, const PlanarFixture& fixture);

/// Rows from the lowest to the highest pin of `fixture`: 0 when all pins stand in one row.
int row_extent(const PlanarFixture& fixture);

/// Row shift that centres the pins on the plates; the lower of two equal ones.
int centred_row_shift(const model::Kit& kit, const PlanarFixture& fixture);

/// A planar fixture with its pins in holes of the plates.
struct PlacedFixture {
  double jaw_separation_mm = 0;
  geometry::Pose2 part_pose;         ///< X_GP of the (turned) part
  std::array<model::Hole, 4> holes;  ///< in the order of the fixture's pins
};

/// `fixture` with its columns shifted outwards by `shift` and its rows upwards by `row_shift`.
PlacedFixture place(const model::Kit& kit, const PlanarFixture& fixture, const ColumnShift& shift,
                    int row_shift);

/// Where planar JSON puts `fixture`: the first of its column shifts, at the least rows.
/// Precondition: column_shifts(kit, fixture) is not empty.
PlacedFixture placed_least(const model::Kit& kit, const PlanarFixture& fixture);

}  // namespace pinjaw::planner

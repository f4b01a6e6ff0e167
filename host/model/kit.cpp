#include "host/model/kit.hpp"

#include <algorithm>

namespace pinjaw::model {

Vector2d p_GHole_mm(const Grid& grid, const Hole& hole, double separation_mm) {
  const double outward_mm = separation_mm / 2 + grid.edge_offset_mm + hole.column * grid.spacing_mm;
  const double y_mm = (hole.row - (grid.rows - 1) / 2.0) * grid.spacing_mm;
  return {hole.jaw == JawSide::Left ? -outward_mm : outward_mm, y_mm};
}

std::vector<JawBody> jaw_solids(const Kit& kit) {
  const Grid& grid = kit.grid;
  const double width_mm = 2 * grid.edge_offset_mm + (grid.columns - 1) * grid.spacing_mm;
  const double half_y_mm = grid.edge_offset_mm + (grid.rows - 1) / 2.0 * grid.spacing_mm;
  std::vector<JawBody> solids{{{0, width_mm}, {-half_y_mm, half_y_mm}, {-kit.jaws.plate_thickness_mm, 0}}};
  solids.insert(solids.end(), kit.jaws.bodies.begin(), kit.jaws.bodies.end());
  return solids;
}

double open_separation_mm(const Jaws& jaws, double separation_mm) {
  if (!jaws.opening_mm) return jaws.separation_mm.hi;
  return std::min(jaws.separation_mm.hi, separation_mm + 2 * *jaws.opening_mm);
}

std::vector<KitConflict> conflicts_of(const Kit& kit) {
  std::vector<KitConflict> conflicts;
  if (2 * kit.pins.radius_mm > kit.grid.spacing_mm) conflicts.push_back(KitConflict::PinsOverlap);
  const bool rests_on_plate = kit.jaws.plate_gap_mm == 0;  // a pallet: no other plate stands this far away
  if (!rests_on_plate && kit.pins.protrusion_mm >= kit.jaws.plate_gap_mm)
    conflicts.push_back(KitConflict::PinMeetsOtherPlate);
  if (!kit.pins.lengths_mm.empty() && kit.pins.lengths_mm.back() <= kit.jaws.plate_gap_mm)
    conflicts.push_back(KitConflict::NoPinReachesThePart);
  return conflicts;
}

}  // namespace pinjaw::model

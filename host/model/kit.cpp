#include "host/model/kit.hpp"

#include <algorithm>

namespace pinjaw::model {

Vector2d p_GHole_mm(const Grid& grid, const Hole& hole, double separation_mm) {
  const double outward_mm = separation_mm / 2 + grid.edge_offset_mm + hole.column * grid.spacing_mm;
  const double y_mm = (hole.row - (grid.rows - 1) / 2.0) * grid.spacing_mm;
  return {hole.jaw == JawSide::Left ? -outward_mm : outward_mm, y_mm};
}

double open_separation_mm(const Jaws& jaws, double separation_mm) {
  if (!jaws.opening_mm) return jaws.separation_mm.hi;
  return std::min(jaws.separation_mm.hi, separation_mm + 2 * *jaws.opening_mm);
}

}  // namespace pinjaw::model

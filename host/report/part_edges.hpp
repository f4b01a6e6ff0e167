#pragma once

#include <vector>

#include "host/part/part.hpp"
#include "host/report/sheet.hpp"

namespace pinjaw::report {

/// The edges of a part turned to its gripper, in plan, chorded and cut where they pass out of sight. A point
/// is seen from a side where no surface lies beyond it on that side, within 0.05 mm; what neither side sees
/// is left out.
std::vector<SheetEdge> sheet_edges(const part::Part& part);

}  // namespace pinjaw::report

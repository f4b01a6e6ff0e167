#pragma once

#include <vector>

#include "host/part/part.hpp"
#include "host/report/sheet.hpp"

namespace pinjaw::report {

/// The edges of a part turned to its gripper, in plan, chorded and cut where they pass out of sight: the
/// exact edges of its file, the contours of a mesh, and the lines where its surface turns over, so that the
/// outline of its shadow is always whole. A line is seen from a side where on its left or on its right no
/// surface lies beyond it on that side, within 0.05 mm; what neither side sees is left out.
std::vector<SheetEdge> sheet_edges(const part::Part& part);

}  // namespace pinjaw::report

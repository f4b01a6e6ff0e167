#pragma once

#include <string>

#include "host/model/design.hpp"

/// Where a design's pins are by its stated numbers, in the part frame turned by the task's side.
namespace pinjaw::planner {

/// The name of a pin's hole in reports: `L-C0-R2`.
std::string name_of(const model::Hole& hole);

geometry::Vector2d foot_in_part_mm(const model::Design& design, const model::PinDesign& pin);
geometry::Vector2d normal_in_part(const model::Design& design, const model::PinDesign& pin);

/// The axis of a pin that stands in its hole.
geometry::Vector2d axis_in_part_mm(const model::Design& design, const model::PinDesign& pin,
                                   const model::Grid& grid);

}  // namespace pinjaw::planner

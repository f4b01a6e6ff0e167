#include "host/planner/plan/pin_places.hpp"

#include <fmt/format.h>

namespace pinjaw::planner {

using geometry::Vector2d;

std::string name_of(const model::Hole& hole) {
  return fmt::format("{}-C{}-R{}", hole.jaw == model::JawSide::Left ? 'L' : 'R', hole.column, hole.row);
}

Vector2d foot_in_part_mm(const model::Design& design, const model::PinDesign& pin) {
  return design.part_pose.inverse() * pin.contact_mm;
}

Vector2d normal_in_part(const model::Design& design, const model::PinDesign& pin) {
  return design.part_pose.inverse().turned(pin.normal);
}

Vector2d axis_in_part_mm(const model::Design& design, const model::PinDesign& pin, const model::Grid& grid) {
  return design.part_pose.inverse() * model::p_GHole_mm(grid, pin.hole, design.jaw_separation_mm);
}

}  // namespace pinjaw::planner

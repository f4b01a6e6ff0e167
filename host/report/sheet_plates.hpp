#pragma once

#include "host/report/sheet.hpp"

/// The 1:1 drawing in the middle of a set-up sheet. Private to the sheet.
namespace pinjaw::report {

/// The drawing's extent around the gripper origin, y up, callouts and dimension included.
struct PlatesExtent {
  Vector2d least_mm = Vector2d::Zero();
  Vector2d most_mm = Vector2d::Zero();
  [[nodiscard]] double width_mm() const { return most_mm.x() - least_mm.x(); }
  [[nodiscard]] double height_mm() const { return most_mm.y() - least_mm.y(); }
};
PlatesExtent plates_extent(const Sheet& sheet);

/// Draws plates, holes, pins, part and dimensions with the gripper origin at `origin_mm` of the paper.
void draw_plates(const Sheet& sheet, const Vector2d& origin_mm, Picture& picture);

}  // namespace pinjaw::report

#include "host/report/sheet_plates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pinjaw::report {
namespace {

using model::Hole;
using model::JawSide;

constexpr double kCalloutWidthMm = 28;   // fits "cut 100.00 mm" and its leader
constexpr double kCalloutPitchMm = 9;    // two lines of text
constexpr double kDimensionDropMm = 13;  // below the lower of plates and part
constexpr double kGapMm = 3;

struct PlatesBox {
  Vector2d least_mm;
  Vector2d most_mm;
  void add(const Vector2d& p_mm) {
    least_mm = least_mm.cwiseMin(p_mm);
    most_mm = most_mm.cwiseMax(p_mm);
  }
};

/// Inner and outer edge of the right plate from the gripper's middle, and the plates' half height.
struct PlateEdges {
  double inner_mm = 0;
  double outer_mm = 0;
  double half_height_mm = 0;
};

PlateEdges plate_edges(const Sheet& sheet) {
  const model::Grid& grid = sheet.kit.grid;
  const double inner_mm = sheet.design.jaw_separation_mm / 2;
  return {inner_mm, inner_mm + 2 * grid.edge_offset_mm + (grid.columns - 1) * grid.spacing_mm,
          (grid.rows - 1) * grid.spacing_mm / 2 + grid.edge_offset_mm};
}

PlatesBox body_box(const Sheet& sheet) {
  const PlateEdges plate = plate_edges(sheet);
  PlatesBox box{{-plate.outer_mm, -plate.half_height_mm}, {plate.outer_mm, plate.half_height_mm}};
  for (const SheetEdge& edge : sheet.edges) {
    for (const Vector2d& p_mm : edge.points_mm) box.add(sheet.design.part_pose * p_mm);
  }
  return box;
}

/// Draws in the gripper frame, y up, on paper.
class PlatesDrawing {
 public:
  PlatesDrawing(const Sheet& sheet, const Vector2d& origin_mm, Picture& picture)
      : sheet_(sheet), origin_mm_(origin_mm), picture_(picture), body_(body_box(sheet)) {}

  void draw() {
    draw_axes();
    draw_plate(-1);
    draw_plate(1);
    draw_holes();
    draw_part();
    draw_pins();
    draw_callouts(JawSide::Left);
    draw_callouts(JawSide::Right);
    draw_dimension();
    draw_part_origin();
  }

 private:
  [[nodiscard]] Vector2d paper(const Vector2d& p_mm) const {
    return {origin_mm_.x() + p_mm.x(), origin_mm_.y() - p_mm.y()};
  }

  void line(const std::vector<Vector2d>& points_mm, const Pen& pen, bool closed = false,
            bool filled = false) {
    Polyline drawn;
    for (const Vector2d& p_mm : points_mm) drawn.points_mm.push_back(paper(p_mm));
    drawn.pen = pen;
    drawn.closed = closed;
    drawn.filled = filled;
    picture_.lines.push_back(std::move(drawn));
  }

  void circle(const Vector2d& center_mm, double radius_mm, const Pen& pen, bool filled) {
    picture_.circles.push_back({paper(center_mm), radius_mm, pen, filled});
  }

  void text(const Vector2d& at_mm, std::string words, double size_mm, Align align, bool bold = false,
            double grey = 0) {
    picture_.texts.push_back({paper(at_mm), std::move(words), size_mm, align, bold, grey});
  }

  [[nodiscard]] Vector2d hole_mm(const Hole& hole) const {
    return model::p_GHole_mm(sheet_.kit.grid, hole, sheet_.design.jaw_separation_mm);
  }

  void draw_axes() {
    const PlateEdges plate = plate_edges(sheet_);
    const Pen pen{0.1, 0.6, {4, 1, 0.5, 1}};
    line({{-plate.outer_mm, 0}, {plate.outer_mm, 0}}, pen);
    line({{0, -plate.half_height_mm}, {0, plate.half_height_mm}}, pen);
  }

  void draw_plate(double side) {
    const PlateEdges plate = plate_edges(sheet_);
    const double inner = side * plate.inner_mm;
    const double outer = side * plate.outer_mm;
    const double half = plate.half_height_mm;
    line({{inner, -half}, {outer, -half}, {outer, half}, {inner, half}}, {0.35, 0, {3, 1.5}}, true);
    text({side * (plate.outer_mm - 2), half + 1.5}, side < 0 ? "left jaw" : "right jaw", 2.8,
         side < 0 ? Align::Left : Align::Right, true);
  }

  /// The largest text that fits between neighbouring holes.
  [[nodiscard]] double hole_text_size_mm() const {
    const model::Grid& grid = sheet_.kit.grid;
    constexpr double kLargestMm = 1.7;  // chosen: less prominent than anything the operator must read
    const Text longest{
        {0, 0}, hole_label({JawSide::Right, grid.columns - 1, grid.rows - 1}), 1, Align::Left, false, 0};
    const double by_width_mm = 0.92 * grid.spacing_mm / width_mm(longest);
    const double by_height_mm = 0.8 * (grid.spacing_mm - 2 * sheet_.kit.pins.radius_mm);
    return std::min({kLargestMm, by_width_mm, by_height_mm});
  }

  void draw_holes() {
    const model::Grid& grid = sheet_.kit.grid;
    const double size_mm = hole_text_size_mm();
    for (const JawSide jaw : {JawSide::Left, JawSide::Right}) {
      for (int column = 0; column < grid.columns; ++column) {
        for (int row = 0; row < grid.rows; ++row) {
          const Hole hole{jaw, column, row};
          const Vector2d center_mm = hole_mm(hole);
          circle(center_mm, sheet_.kit.pins.radius_mm, {0.12, 0.55, {}}, false);
          const double below_mm = sheet_.kit.pins.radius_mm + 0.45 + 0.73 * size_mm;
          text(center_mm - Vector2d(0, below_mm), hole_label(hole), size_mm, Align::Centre, false, 0.45);
        }
      }
    }
  }

  void draw_part() {
    for (const bool above : {false, true}) {
      for (const SheetEdge& edge : sheet_.edges) {
        if (above ? !edge.from_above : edge.from_above || !edge.from_below) continue;
        std::vector<Vector2d> points_mm;
        for (const Vector2d& p_mm : edge.points_mm) points_mm.push_back(sheet_.design.part_pose * p_mm);
        line(points_mm, above ? Pen{0.45, 0, {}} : Pen{0.2, 0.55, {}});
      }
    }
  }

  void draw_pins() {
    int number = 0;
    for (const model::PinDesign& pin : sheet_.design.pins) {
      const Vector2d center_mm = hole_mm(pin.hole);
      const double radius_mm = sheet_.kit.pins.radius_mm;
      circle(center_mm, radius_mm, {0.2, 0, {}}, true);
      const double size_mm = std::min(4.0, 1.3 * radius_mm);
      text(center_mm - Vector2d(0, 0.36 * size_mm), std::to_string(++number), size_mm, Align::Centre, true,
           1);
      const Vector2d tangent(-pin.normal.y(), pin.normal.x());
      line({pin.contact_mm - 1.2 * tangent, pin.contact_mm + 1.2 * tangent}, {0.6, 0, {}});
    }
  }

  struct Callout {
    int number = 0;
    const model::PinDesign* pin = nullptr;
    double y_mm = 0;
  };

  /// The jaw's pins from top to bottom, moved apart to the callouts' pitch, within the body's height if they
  /// fit.
  [[nodiscard]] std::vector<Callout> spread_callouts(JawSide jaw) const {
    std::vector<Callout> callouts;
    int number = 0;
    for (const model::PinDesign& pin : sheet_.design.pins) {
      ++number;
      if (pin.hole.jaw == jaw) callouts.push_back({number, &pin, hole_mm(pin.hole).y()});
    }
    std::stable_sort(callouts.begin(), callouts.end(),
                     [](const auto& a, const auto& b) { return a.y_mm > b.y_mm; });
    for (std::size_t i = 1; i < callouts.size(); ++i) {
      callouts[i].y_mm = std::min(callouts[i].y_mm, callouts[i - 1].y_mm - kCalloutPitchMm);
    }
    const double lowest_mm = body_.least_mm.y() + kCalloutPitchMm / 2;
    const double lift_mm = callouts.empty() ? 0 : std::max(0.0, lowest_mm - callouts.back().y_mm);
    for (Callout& callout : callouts) callout.y_mm += lift_mm;
    return callouts;
  }

  void draw_callouts(JawSide jaw) {
    const double side = jaw == JawSide::Left ? -1 : 1;
    const double body_mm = side < 0 ? body_.least_mm.x() : body_.most_mm.x();
    const double x_mm = body_mm + side * kGapMm;
    const Align align = side < 0 ? Align::Right : Align::Left;
    for (const Callout& callout : spread_callouts(jaw)) {
      const Vector2d pin_mm = hole_mm(callout.pin->hole);
      const Vector2d elbow_mm(x_mm, callout.y_mm);
      const Vector2d toward = (elbow_mm - pin_mm).normalized();
      line({pin_mm + sheet_.kit.pins.radius_mm * toward, elbow_mm, elbow_mm + Vector2d(side * 2, 0)},
           {0.2, 0.3, {}});
      const double text_x_mm = x_mm + side * 3;
      text({text_x_mm, callout.y_mm + 0.4},
           fmt::format("{}: {}", callout.number, hole_label(callout.pin->hole)), 3.2, align, true);
      text({text_x_mm, callout.y_mm - 3.2}, fmt::format("cut {:.2f} mm", callout.pin->length_mm), 3, align);
    }
  }

  void draw_arrow(const Vector2d& tip_mm, double direction) {
    const Vector2d back_mm = tip_mm - Vector2d(direction * 2.2, 0);
    line({tip_mm, back_mm + Vector2d(0, 0.7), back_mm - Vector2d(0, 0.7)}, {0.1, 0, {}}, true, true);
  }

  void draw_dimension() {
    const PlateEdges plate = plate_edges(sheet_);
    const double y_mm = body_.least_mm.y() - 5;
    for (const double side : {-1.0, 1.0}) {
      const double x_mm = side * plate.inner_mm;
      line({{x_mm, -plate.half_height_mm - 0.5}, {x_mm, y_mm - 1.5}}, {0.15, 0.2, {}});
      draw_arrow({x_mm, y_mm}, side);
    }
    line({{-plate.inner_mm, y_mm}, {plate.inner_mm, y_mm}}, {0.2, 0, {}});
    text({0, y_mm - 5},
         fmt::format("jaw separation: closed {:.2f} mm, open {:.2f} mm", sheet_.design.jaw_separation_mm,
                     sheet_.design.jaw_open_mm),
         3.2, Align::Centre, true);
  }

  void draw_part_origin() {
    const geometry::Pose2& pose = sheet_.design.part_pose;
    for (const Vector2d& axis : {Vector2d(1, 0), Vector2d(0, 1)}) {
      line({pose * Vector2d(-1.5 * axis), pose * Vector2d(5 * axis)}, {0.3, 0.25, {}});
      const Vector2d tip_mm = pose * Vector2d(7 * axis) - Vector2d(0, 0.9);
      text(tip_mm, axis.x() > 0 ? "x" : "y", 2.4, Align::Centre, false, 0.25);
    }
  }

  const Sheet& sheet_;
  Vector2d origin_mm_;
  Picture& picture_;
  PlatesBox body_;
};

}  // namespace

PlatesExtent plates_extent(const Sheet& sheet) {
  const PlatesBox body = body_box(sheet);
  return {body.least_mm - Vector2d(kCalloutWidthMm, kDimensionDropMm),
          body.most_mm + Vector2d(kCalloutWidthMm, 6)};
}

void draw_plates(const Sheet& sheet, const Vector2d& origin_mm, Picture& picture) {
  PlatesDrawing(sheet, origin_mm, picture).draw();
}

}  // namespace pinjaw::report

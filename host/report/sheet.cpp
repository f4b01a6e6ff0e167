#include "host/report/sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/report/sheet_plates.hpp"

namespace pinjaw::report {
namespace {

constexpr double kPaperMarginMm = 8;  // chosen: what office printers leave blank, and a little
constexpr double kCellMm = 11;        // height of a cell: a caption and a value
constexpr double kTableRowMm = 5.5;
constexpr double kBarMm = 50;
constexpr double kLeastWidthMm = 186;  // of the blocks of text; fits A4 upright

struct Cell {
  std::string caption;
  std::string value;
  double share = 1;  ///< of the row's width
  bool bold = false;
};

/// `text` made smaller until it fits `most_mm`, and cut where even that is too wide.
Text fitted(Text text, double most_mm) {
  constexpr double kSmallestMm = 1.9;  // chosen: still readable on paper
  const double wide_mm = width_mm(text);
  if (wide_mm > most_mm) text.size_mm = std::max(kSmallestMm, text.size_mm * most_mm / wide_mm);
  const std::string whole = text.words;
  for (std::size_t kept = whole.size(); width_mm(text) > most_mm && kept > 1; --kept) {
    text.words = whole.substr(0, kept - 1) + "...";
  }
  return text;
}

/// A strip of the paper that blocks of text fill from the top down.
struct Strip {
  double x_mm = kPaperMarginMm;
  double width_mm = 0;
};

/// Lays out blocks of text around the drawing of the plates: force and pin table under it on upright paper,
/// beside it on paper that lies.
class SheetLayout {
 public:
  explicit SheetLayout(const Sheet& sheet) : sheet_(sheet), plates_(plates_extent(sheet)) {}

  Picture picture() {
    picture_.title = fmt::format("set-up sheet {} {}", sheet_.task, sheet_.design.id);
    choose_paper();
    const Strip whole{kPaperMarginMm, picture_.paper.width_mm - 2 * kPaperMarginMm};
    strip_ = whole;
    draw_header();
    const double plates_top_mm = y_mm_;
    const double free_mm = beside_ ? 0 : whole.width_mm - plates_.width_mm();
    draw_plates(sheet_,
                {kPaperMarginMm + free_mm / 2 - plates_.least_mm.x(), plates_top_mm + plates_.most_mm.y()},
                picture_);
    const double plates_end_mm = plates_top_mm + plates_.height_mm() + 2;
    if (beside_) {
      strip_ = {kPaperMarginMm + plates_.width_mm() + 2, whole.width_mm - plates_.width_mm() - 2};
      draw_force();
      draw_table();
      strip_ = whole;
      y_mm_ = std::max(y_mm_, plates_end_mm);
      draw_scale_bar();
    } else {
      y_mm_ = plates_end_mm;
      draw_scale_bar();
      draw_force();
      draw_table();
    }
    draw_notes();
    return std::move(picture_);
  }

 private:
  static constexpr double kHeaderMm = 8 + 2 * kCellMm + 4;
  static constexpr double kBarAndNotesMm = 2 + 11 + 4 * 4;
  static constexpr double kBesideMm = 74;  // the least width of the pin table

  [[nodiscard]] double table_mm() const {
    return 6 + static_cast<double>(sheet_.design.pins.size() + 1) * kTableRowMm;
  }

  /// The smallest usual paper that leaves the margins free, A4 upright first; its own where none does.
  void choose_paper() {
    struct Choice {
      Paper paper;
      bool beside = false;
    };
    const Vector2d under_mm(std::max(kLeastWidthMm, plates_.width_mm()),
                            kHeaderMm + plates_.height_mm() + kBarAndNotesMm + kCellMm + table_mm());
    const Vector2d beside_mm(
        std::max(kLeastWidthMm, plates_.width_mm() + kBesideMm + 2),
        kHeaderMm + kBarAndNotesMm + std::max(plates_.height_mm(), 5 * kCellMm + table_mm()));
    const std::array<Choice, 4> choices = {
        {{{210, 297}, false}, {{297, 210}, true}, {{297, 420}, false}, {{420, 297}, true}}};
    const Vector2d margins_mm(2 * kPaperMarginMm, 2 * kPaperMarginMm);
    for (const Choice& choice : choices) {
      const Vector2d need_mm = (choice.beside ? beside_mm : under_mm) + margins_mm;
      beside_ = choice.beside;
      picture_.paper = choice.paper;
      if (need_mm.x() <= choice.paper.width_mm && need_mm.y() <= choice.paper.height_mm) return;
    }
    beside_ = false;
    const Vector2d need_mm = under_mm + margins_mm;
    picture_.paper = {std::ceil(need_mm.x()), std::ceil(need_mm.y())};
  }

  void text(double x_mm, double y_mm, std::string words, double size_mm, bool bold = false, double grey = 0,
            Align align = Align::Left) {
    picture_.texts.push_back({{x_mm, y_mm}, std::move(words), size_mm, align, bold, grey});
  }

  void rule(const Vector2d& from_mm, const Vector2d& to_mm, double wide_mm = 0.2) {
    picture_.lines.push_back({{from_mm, to_mm}, {wide_mm, 0, {}}, false, false});
  }

  void frame(double x_mm, double y_mm, double wide_mm, double high_mm) {
    picture_.lines.push_back(
        {{{x_mm, y_mm}, {x_mm + wide_mm, y_mm}, {x_mm + wide_mm, y_mm + high_mm}, {x_mm, y_mm + high_mm}},
         {0.25, 0, {}},
         true,
         false});
  }

  /// A row of framed cells over the strip, each a caption over a value.
  void draw_cells(const std::vector<Cell>& cells) {
    double shares = 0;
    for (const Cell& cell : cells) shares += cell.share;
    double x_mm = strip_.x_mm;
    for (const Cell& cell : cells) {
      const double wide_mm = strip_.width_mm * cell.share / shares;
      frame(x_mm, y_mm_, wide_mm, kCellMm);
      text(x_mm + 1.5, y_mm_ + 3.4, cell.caption, 2.4, false, 0.3);
      const Text value{{x_mm + 1.5, y_mm_ + 8.8}, cell.value, 4, Align::Left, cell.bold, 0};
      picture_.texts.push_back(fitted(value, wide_mm - 3));
      x_mm += wide_mm;
    }
    y_mm_ += kCellMm;
  }

  void draw_header() {
    text(kPaperMarginMm, y_mm_ + 5, "Gripper set-up sheet", 5, true);
    text(kPaperMarginMm + strip_.width_mm, y_mm_ + 5, "pinjaw, scale 1:1", 3, false, 0.3, Align::Right);
    y_mm_ += 8;
    const model::Design& design = sheet_.design;
    draw_cells({{"task", sheet_.task, 3, true},
                {"design", design.id, 2, true},
                {"pins left + right", std::string(to_string(design.split)), 1.2, false},
                {"gripper reaches the part from", sheet_.side, 1.8, false}});
    const double theta_deg = design.part_pose.theta_rad * 180 / std::numbers::pi;
    draw_cells({{"part", sheet_.part, 2, false},
                {"kit", sheet_.kit.name, 1.5, false},
                {"pin diameter", fmt::format("{:.4g} mm", 2 * sheet_.kit.pins.radius_mm), 1.1, false},
                {"friction coefficient", fmt::format("{:.3g} ({})", sheet_.friction, sheet_.friction_model),
                 1.5, false},
                {"part origin in the gripper: x, y, turned",
                 fmt::format("{:.2f}, {:.2f} mm, {:.2f}°", design.part_pose.t_mm.x(),
                             design.part_pose.t_mm.y(), theta_deg),
                 2.6, false}});
    y_mm_ += 4;
  }

  void draw_scale_bar() {
    const double x_mm = kPaperMarginMm;
    const double y_mm = y_mm_ + 3;
    rule({x_mm, y_mm}, {x_mm + kBarMm, y_mm}, 0.4);
    for (int i = 0; i <= 5; ++i) {
      const double tick_mm = i == 0 || i == 5 ? 2.5 : 1.2;
      rule({x_mm + i * kBarMm / 5, y_mm - tick_mm}, {x_mm + i * kBarMm / 5, y_mm + tick_mm},
           i % 5 == 0 ? 0.4 : 0.2);
    }
    text(x_mm + kBarMm + 4, y_mm + 1.1,
         "This bar must measure 50 mm. If not, print again at 100 %, without \"fit to page\".", 3);
    y_mm_ += 11;
  }

  void draw_force() {
    const model::Squeeze& squeeze = sheet_.design.squeeze;
    std::vector<Cell> cells = {{"squeeze force", "none: this station only locates the part", 1, true}};
    if (sheet_.grips) {
      cells = {{"squeeze force required", fmt::format("{:.1f} N", squeeze.required_n), 1.5, true},
               {"usable", fmt::format("{:.1f} N", squeeze.usable_n), 1, false},
               {"actuator's limit", fmt::format("{:.1f} N", squeeze.limit_n), 1.1, false},
               {"margin", fmt::format("{:.1f} N", squeeze.margin_n), 1, false},
               {"critical disturbance", squeeze.critical, 1.9, false}};
    }
    if (beside_ && sheet_.grips) {
      draw_cells({cells[0]});
      draw_cells({cells[1], cells[2]});
      draw_cells({cells[3], cells[4]});
    } else {
      draw_cells(cells);
    }
    y_mm_ += 3;
  }

  void draw_row(const std::vector<std::string>& values, bool bold) {
    // Starts of the columns as shares of the strip: as wide as their captions.
    constexpr std::array<double, 6> kStarts = {0.01, 0.09, 0.29, 0.47, 0.62, 0.87};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double end = i + 1 < kStarts.size() ? kStarts[i + 1] : 1;
      const Text value{{strip_.x_mm + kStarts[i] * strip_.width_mm, y_mm_ + 4},
                       values[i],
                       bold ? 2.6 : 3.2,
                       Align::Left,
                       bold,
                       0};
      picture_.texts.push_back(fitted(value, (end - kStarts[i]) * strip_.width_mm - 1));
    }
    y_mm_ += kTableRowMm;
    rule({strip_.x_mm, y_mm_}, {strip_.x_mm + strip_.width_mm, y_mm_}, bold ? 0.3 : 0.1);
  }

  void draw_table() {
    rule({strip_.x_mm, y_mm_}, {strip_.x_mm + strip_.width_mm, y_mm_}, 0.3);
    draw_row({"pin", "hole", "cut mm", "top z", "touches z", "margin"}, true);
    int number = 0;
    for (const model::PinDesign& pin : sheet_.design.pins) {
      draw_row({std::to_string(++number), hole_label(pin.hole), fmt::format("{:.2f}", pin.length_mm),
                fmt::format("{:.2f}", pin.top_z_mm),
                fmt::format("{:.2f} to {:.2f}", pin.contact_z_mm.lo, pin.contact_z_mm.hi),
                fmt::format("{:.2f}", pin.foot_margin_mm)},
               false);
    }
    y_mm_ += 3;
  }

  void draw_notes() {
    const std::vector<std::string> notes = {
        "View onto the plates, part in place. L: left jaw, R: right jaw; C0: column nearest the other jaw; "
        "R0: bottom row.",
        "Cut: from the plate's top face to the pin's top; add what stands in the hole. z: height on the part "
        "as "
        "it lies in this gripper. Margin: to the edge's end. In mm.",
        "Bold lines: edges seen in this view; thin grey: hidden, seen from the plates; dashed: plates, "
        "closed; x, y: part origin.",
        "Squeeze force: sum of both jaws. It can balance every disturbance of the task at this friction; it "
        "is no guarantee.",
    };
    for (const std::string& note : notes) {
      y_mm_ += 4;
      const Text line{{kPaperMarginMm, y_mm_ - 0.8}, note, 2.6, Align::Left, false, 0.2};
      picture_.texts.push_back(fitted(line, strip_.width_mm));
    }
  }

  const Sheet& sheet_;
  PlatesExtent plates_;
  Picture picture_;
  Strip strip_;
  bool beside_ = false;
  double y_mm_ = kPaperMarginMm;
};

}  // namespace

std::string hole_label(const model::Hole& hole) {
  return fmt::format("{}-C{}-R{}", hole.jaw == model::JawSide::Left ? "L" : "R", hole.column, hole.row);
}

Picture sheet_picture(const Sheet& sheet) {
  return SheetLayout(sheet).picture();
}

}  // namespace pinjaw::report

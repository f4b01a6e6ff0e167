#pragma once

#include <string>
#include <vector>

#include "host/base/expected.hpp"
#include "host/geometry/plane.hpp"

/// Pictures as values: laid out once, then written as SVG, PDF or PNG by one drawing path. Lengths in mm on
/// paper, from the top left corner, y down.
namespace pinjaw::report {

using geometry::Vector2d;

struct Paper {
  double width_mm = 0;
  double height_mm = 0;
};

/// Grey from 0 (black) to 1 (white).
struct Pen {
  double width_mm = 0.2;
  double grey = 0;
  std::vector<double> dash_mm;  ///< empty: solid
};

/// A line through the points; filled (without a pen's stroke) where `filled`.
struct Polyline {
  std::vector<Vector2d> points_mm;
  Pen pen;
  bool closed = false;
  bool filled = false;
};

struct Circle {
  Vector2d center_mm = Vector2d::Zero();
  double radius_mm = 0;
  Pen pen;
  bool filled = false;
};

enum class Align { Left, Centre, Right };

/// One line of text; `at_mm` is on its base line.
struct Text {
  Vector2d at_mm = Vector2d::Zero();
  std::string words;
  double size_mm = 3;  ///< of the em
  Align align = Align::Left;
  bool bold = false;
  double grey = 0;
};

/// Everything on one sheet of paper: circles, over them lines, over them texts.
struct Picture {
  Paper paper;
  std::string title;
  std::vector<Circle> circles;
  std::vector<Polyline> lines;
  std::vector<Text> texts;
};

/// The box of a text's ink on paper.
struct TextBox {
  Vector2d least_mm = Vector2d::Zero();
  Vector2d most_mm = Vector2d::Zero();
};
TextBox box_of(const Text& text);

/// The width that the text takes.
double width_mm(const Text& text);

enum class PictureFormat { Svg, Pdf, Png };

/// The file's bytes; physical size is true (1 mm is 1 mm), PNG has `dots_per_mm`. The same picture gives the
/// same bytes. A sentence where the drawing library fails.
base::Expected<std::string> written(const Picture& picture, PictureFormat format, double dots_per_mm = 6);

}  // namespace pinjaw::report

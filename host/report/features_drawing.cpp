#include "host/report/features_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pinjaw::report {

namespace {

using geometry::Vector2d;

constexpr double kDrawingMarginMm = 12;
constexpr double kFootMm = 16;  // title and scale bar
constexpr double kFootTextMm = 2.6;
constexpr double kLabelMm = 1.6;

struct CurvesBox {
  double x_lo = std::numeric_limits<double>::infinity();
  double x_hi = -std::numeric_limits<double>::infinity();
  double y_lo = std::numeric_limits<double>::infinity();
  double y_hi = -std::numeric_limits<double>::infinity();

  void add(const Vector2d& p_mm) {
    x_lo = std::min(x_lo, p_mm.x());
    x_hi = std::max(x_hi, p_mm.x());
    y_lo = std::min(y_lo, p_mm.y());
    y_hi = std::max(y_hi, p_mm.y());
  }
  void add(const geometry::Curve& curve) {
    constexpr int kSamples = 16;
    const double length = geometry::length_mm(curve);
    for (int i = 0; i <= kSamples; ++i) add(geometry::point_at(curve, length * i / kSamples));
  }
};

/// SVG path data of the stretch of `curve` between two arc lengths; y points up in the drawing's group.
std::string path_data(const geometry::Curve& curve, const geometry::Interval& along_mm) {
  const Vector2d a = geometry::point_at(curve, along_mm.lo);
  std::string data = fmt::format("M{:.4f} {:.4f}", a.x(), a.y());
  if (const auto* arc = std::get_if<geometry::Arc>(&curve)) {
    // two halves: SVG cannot draw a full circle as one arc
    const double half_mm = along_mm.length() / 2;
    for (const double at_mm : {along_mm.lo + half_mm, along_mm.hi}) {
      const Vector2d p = geometry::point_at(curve, at_mm);
      data += fmt::format(" A{0:.4f} {0:.4f} 0 0 1 {1:.4f} {2:.4f}", arc->radius_mm, p.x(), p.y());
    }
    return data;
  }
  const Vector2d b = geometry::point_at(curve, along_mm.hi);
  return data + fmt::format(" L{:.4f} {:.4f}", b.x(), b.y());
}

std::string path(const geometry::Curve& curve, const geometry::Interval& along_mm, const char* style) {
  return fmt::format("<path d=\"{}\" {}/>\n", path_data(curve, along_mm), style);
}

std::string edge_path(const SheetEdge& edge) {
  std::string data;
  for (const Vector2d& p : edge.points_mm)
    data += fmt::format("{}{:.4f} {:.4f}", data.empty() ? "M" : " L", p.x(), p.y());
  return fmt::format("<path d=\"{}\" stroke=\"#999\" stroke-width=\"0.25\"/>\n", data);
}

std::string feature_paths(const model::Feature& feature) {
  constexpr const char* kReachable = "stroke=\"#0a5ad6\" stroke-width=\"0.6\" stroke-linecap=\"round\"";
  constexpr const char* kUnreachable = "stroke=\"#d06000\" stroke-width=\"0.5\" stroke-dasharray=\"1 1\"";
  std::string text = path(feature.curve, {0, geometry::length_mm(feature.curve)}, kUnreachable);
  for (const geometry::Interval& piece : feature.reach_mm) text += path(feature.curve, piece, kReachable);
  return text;
}

/// The feature's number beside it; none where it is longer than the feature, and would lie over its
/// neighbours'.
std::string feature_label(const model::Feature& feature) {
  constexpr double kDigitMm = 0.64 * kLabelMm;
  const std::string number = std::to_string(feature.id);
  if (geometry::length_mm(feature.curve) < kDigitMm * static_cast<double>(number.size())) return {};
  const double middle_mm = geometry::length_mm(feature.curve) / 2;
  const Vector2d p =
      geometry::point_at(feature.curve, middle_mm) - 1.5 * model::outward_normal_at(feature, middle_mm);
  return fmt::format("<text x=\"{:.3f}\" y=\"{:.3f}\">{}</text>\n", p.x(), -p.y() + 0.55, number);
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

}  // namespace

std::string features_svg(const FeaturesDrawing& drawing) {
  CurvesBox box;
  for (const model::Feature& feature : drawing.features) box.add(feature.curve);
  for (const SheetEdge& edge : drawing.edges) {
    for (const Vector2d& p_mm : edge.points_mm) box.add(p_mm);
  }
  if (!std::isfinite(box.x_lo)) box = {0, 50, 0, 20};
  const std::string foot =
      fmt::format("{}: {} features; blue: a closed pin has room", drawing.title, drawing.features.size());
  const double foot_mm =
      std::max(75 + drawing.pin_radius_mm, 0.6 * kFootTextMm * static_cast<double>(foot.size()));
  const double width = std::max(foot_mm, box.x_hi - box.x_lo) + 2 * kDrawingMarginMm;
  const double left = (box.x_lo + box.x_hi - width) / 2;
  const double height = box.y_hi - box.y_lo + 2 * kDrawingMarginMm + kFootMm;
  const double foot_y = -box.y_lo + kDrawingMarginMm + 4;

  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.2f}mm\" height=\"{1:.2f}mm\" viewBox=\"{2:.3f} "
      "{3:.3f} {0:.3f} "
      "{1:.3f}\">\n<title>{4}</title>\n<rect x=\"{2:.3f}\" y=\"{3:.3f}\" width=\"100%\" height=\"100%\" "
      "fill=\"#fff\"/>\n",
      width, height, left, -box.y_hi - kDrawingMarginMm, escaped(drawing.title));
  svg += "<g transform=\"scale(1 -1)\" fill=\"none\">\n";
  for (const SheetEdge& edge : drawing.edges) {
    if (edge.from_below) svg += edge_path(edge);
  }
  for (const model::Feature& feature : drawing.features) svg += feature_paths(feature);
  svg += fmt::format(
      "</g>\n<g font-family=\"sans-serif\" font-size=\"{}\" text-anchor=\"middle\" fill=\"#333\">\n",
      kLabelMm);
  for (const model::Feature& feature : drawing.features) svg += feature_label(feature);
  svg += fmt::format(
      "</g>\n<g font-family=\"sans-serif\" font-size=\"{}\" fill=\"#000\" transform=\"translate({:.3f} "
      "{:.3f})\">\n"
      "<path d=\"M0 0 h50 M0 -1.5 v3 M50 -1.5 v3\" stroke=\"#000\" stroke-width=\"0.3\"/><text x=\"52\" "
      "y=\"1\">50 mm</text>\n"
      "<circle cx=\"72\" cy=\"0\" r=\"{:.4f}\" fill=\"none\" stroke=\"#000\" stroke-width=\"0.3\"/>\n"
      "<text x=\"0\" y=\"6.5\">{}</text>\n</g>\n</svg>\n",
      kFootTextMm, left + kDrawingMarginMm, foot_y, drawing.pin_radius_mm, escaped(foot));
  return svg;
}

}  // namespace pinjaw::report

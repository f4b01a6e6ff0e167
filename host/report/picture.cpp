#include "host/report/picture.hpp"

#include <cairo/cairo-pdf.h>
#include <cairo/cairo-svg.h>
#include <cairo/cairo.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace pinjaw::report {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct DestroyContext {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using SurfacePointer = std::unique_ptr<cairo_surface_t, DestroySurface>;
using ContextPointer = std::unique_ptr<cairo_t, DestroyContext>;

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

void choose_font(cairo_t* context, const Text& text) {
  const cairo_font_weight_t weight = text.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL;
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, weight);
  cairo_set_font_size(context, text.size_mm);
}

/// Extents of a text in mm, measured on a surface of its own without rounding to pixels.
cairo_text_extents_t extents_of(const Text& text) {
  const SurfacePointer surface(cairo_recording_surface_create(CAIRO_CONTENT_ALPHA, nullptr));
  const ContextPointer context(cairo_create(surface.get()));
  cairo_scale(context.get(), kPointsPerMm, kPointsPerMm);
  choose_font(context.get(), text);
  cairo_text_extents_t extents{};
  cairo_text_extents(context.get(), text.words.c_str(), &extents);
  return extents;
}

double start_x_mm(const Text& text, const cairo_text_extents_t& extents) {
  switch (text.align) {
    case Align::Left:
      return text.at_mm.x();
    case Align::Centre:
      return text.at_mm.x() - extents.x_advance / 2;
    case Align::Right:
      return text.at_mm.x() - extents.x_advance;
  }
  return text.at_mm.x();
}

void use_pen(cairo_t* context, const Pen& pen) {
  cairo_set_source_rgb(context, pen.grey, pen.grey, pen.grey);
  cairo_set_line_width(context, pen.width_mm);
  cairo_set_dash(context, pen.dash_mm.data(), static_cast<int>(pen.dash_mm.size()), 0);
}

void finish_path(cairo_t* context, bool filled) {
  if (filled) {
    cairo_fill(context);
  } else {
    cairo_stroke(context);
  }
}

void draw(cairo_t* context, const Polyline& line) {
  use_pen(context, line.pen);
  cairo_new_path(context);
  for (const Vector2d& p_mm : line.points_mm) cairo_line_to(context, p_mm.x(), p_mm.y());
  if (line.closed) cairo_close_path(context);
  finish_path(context, line.filled);
}

void draw(cairo_t* context, const Circle& circle) {
  use_pen(context, circle.pen);
  cairo_new_path(context);
  cairo_arc(context, circle.center_mm.x(), circle.center_mm.y(), circle.radius_mm, 0, 2 * std::numbers::pi);
  finish_path(context, circle.filled);
}

void draw(cairo_t* context, const Text& text) {
  choose_font(context, text);
  cairo_set_source_rgb(context, text.grey, text.grey, text.grey);
  cairo_move_to(context, start_x_mm(text, extents_of(text)), text.at_mm.y());
  cairo_show_text(context, text.words.c_str());
}

void draw(cairo_t* context, const Picture& picture) {
  cairo_set_source_rgb(context, 1, 1, 1);
  cairo_paint(context);
  cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  for (const Circle& circle : picture.circles) draw(context, circle);
  for (const Polyline& line : picture.lines) draw(context, line);
  for (const Text& text : picture.texts) draw(context, text);
  cairo_show_page(context);
}

SurfacePointer surface_for(const Picture& picture, PictureFormat format, double dots_per_mm,
                           std::string& bytes) {
  const double width = picture.paper.width_mm;
  const double height = picture.paper.height_mm;
  if (format == PictureFormat::Svg) {
    return SurfacePointer(
        cairo_svg_surface_create_for_stream(append, &bytes, width * kPointsPerMm, height * kPointsPerMm));
  }
  if (format == PictureFormat::Pdf) {
    SurfacePointer pdf(
        cairo_pdf_surface_create_for_stream(append, &bytes, width * kPointsPerMm, height * kPointsPerMm));
    cairo_pdf_surface_set_metadata(pdf.get(), CAIRO_PDF_METADATA_TITLE, picture.title.c_str());
    // A date of today would make two sheets of one design differ.
    cairo_pdf_surface_set_metadata(pdf.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    return pdf;
  }
  return SurfacePointer(cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                                   static_cast<int>(std::ceil(width * dots_per_mm)),
                                                   static_cast<int>(std::ceil(height * dots_per_mm))));
}

/// The library numbers its surfaces over the life of the program; without that number equal pictures are
/// equal bytes.
std::string without_counter(std::string svg) {
  const std::string_view name = "id=\"surface";
  const std::size_t found = svg.find(name);
  if (found == std::string::npos) return svg;
  const std::size_t begin = found + name.size();
  return svg.erase(begin, svg.find('"', begin) - begin);
}

}  // namespace

TextBox box_of(const Text& text) {
  const cairo_text_extents_t extents = extents_of(text);
  const Vector2d least(start_x_mm(text, extents) + extents.x_bearing, text.at_mm.y() + extents.y_bearing);
  return {least, least + Vector2d(extents.width, extents.height)};
}

double width_mm(const Text& text) {
  return extents_of(text).x_advance;
}

base::Expected<std::string> written(const Picture& picture, PictureFormat format, double dots_per_mm) {
  std::string bytes;
  const SurfacePointer surface = surface_for(picture, format, dots_per_mm, bytes);
  ContextPointer context(cairo_create(surface.get()));
  const double scale = format == PictureFormat::Png ? dots_per_mm : kPointsPerMm;
  cairo_scale(context.get(), scale, scale);
  draw(context.get(), picture);
  cairo_status_t status = cairo_status(context.get());
  context.reset();
  if (format == PictureFormat::Png && status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_write_to_png_stream(surface.get(), append, &bytes);
  }
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  if (format == PictureFormat::Svg) bytes = without_counter(std::move(bytes));
  // A surface that was finished after success says so too.
  if (status == CAIRO_STATUS_SUCCESS || status == CAIRO_STATUS_SURFACE_FINISHED) return bytes;
  return base::failure(std::string("the picture cannot be drawn: ") + cairo_status_to_string(status));
}

}  // namespace pinjaw::report

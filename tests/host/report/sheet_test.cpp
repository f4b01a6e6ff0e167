#include "host/report/sheet.hpp"

#include <cairo/cairo.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "host/base/files.hpp"
#include "host/config/read.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::report {
namespace {

/// A sheet of a square part of 24 mm between four pins of a shipped kit.
Sheet sheet_for(const std::string& kit_name) {
  Sheet sheet;
  sheet.kit = config::read_kit(test::source_dir("configs/kits/" + kit_name + ".yaml")).value();
  sheet.task = "valve-housing-pedestal";
  sheet.part = "valve_housing.step";
  sheet.side = "below";
  sheet.friction = 0.2;
  sheet.friction_model = "pyramid";
  sheet.design.id = "3f9c-0a";
  sheet.design.jaw_separation_mm = 24 - 2 * sheet.kit.grid.edge_offset_mm + 2 * sheet.kit.pins.radius_mm;
  sheet.design.jaw_open_mm = 60;
  sheet.design.squeeze = {77.1, 116, 140, 38.9, "spray[17]"};
  for (const model::JawSide jaw : {model::JawSide::Left, model::JawSide::Right}) {
    for (const int row : {4, 5}) {
      model::PinDesign pin;
      pin.hole = {jaw, 0, row};
      pin.length_mm = 16.5;
      pin.top_z_mm = 14.5;
      pin.contact_z_mm = {1, 13.5};
      const double out = jaw == model::JawSide::Left ? -1 : 1;
      const Vector2d hole_mm = model::p_GHole_mm(sheet.kit.grid, pin.hole, sheet.design.jaw_separation_mm);
      pin.normal = Vector2d(-out, 0);
      pin.contact_mm = hole_mm + sheet.kit.pins.radius_mm * pin.normal;
      sheet.design.pins.push_back(pin);
    }
  }
  const Vector2d a(-12, -12), b(12, -12), c(12, 12), d(-12, 12);
  sheet.edges = {{{a, b, c, d, a}, true, true}, {{a, c}, false, true}};
  return sheet;
}

bool overlap(const TextBox& a, const TextBox& b) {
  return a.least_mm.x() < b.most_mm.x() && b.least_mm.x() < a.most_mm.x() && a.least_mm.y() < b.most_mm.y() &&
         b.least_mm.y() < a.most_mm.y();
}

class SheetOfKit : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Shipped, SheetOfKit, testing::Values("acc-pedestal", "acc-pallet", "gluegun"),
                         [](const auto& kit) {
                           return std::string(kit.param).replace(kit.param.find_first_of("-u"), 1, "_");
                         });

TEST_P(SheetOfKit, every_hole_and_pin_is_named) {
  const Sheet sheet = sheet_for(GetParam());
  std::multiset<std::string> words;
  for (const Text& text : sheet_picture(sheet).texts) words.insert(text.words);
  for (int column = 0; column < sheet.kit.grid.columns; ++column) {
    for (int row = 0; row < sheet.kit.grid.rows; ++row) {
      EXPECT_EQ(words.count(hole_label({model::JawSide::Left, column, row})) -
                    (column == 0 && (row == 4 || row == 5) ? 1U : 0U),
                1U)
          << column << " " << row;
      EXPECT_GE(words.count(hole_label({model::JawSide::Right, column, row})), 1U);
    }
  }
  EXPECT_EQ(words.count("cut 16.50 mm"), 4U);
  EXPECT_EQ(words.count("1: L-C0-R4"), 1U);
}

TEST_P(SheetOfKit, every_text_lies_on_the_paper_and_none_over_another) {
  Sheet sheet = sheet_for(GetParam());
  for (const double separation_mm : {sheet.design.jaw_separation_mm, 59.0}) {
    sheet.design.jaw_separation_mm = separation_mm;
    const Picture picture = sheet_picture(sheet);
    std::vector<TextBox> boxes;
    for (const Text& text : picture.texts) boxes.push_back(box_of(text));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      EXPECT_GT(boxes[i].least_mm.minCoeff(), 5) << picture.texts[i].words;
      EXPECT_LT(boxes[i].most_mm.x(), picture.paper.width_mm - 5) << picture.texts[i].words;
      EXPECT_LT(boxes[i].most_mm.y(), picture.paper.height_mm - 5) << picture.texts[i].words;
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_FALSE(overlap(boxes[i], boxes[j]))
            << picture.texts[i].words << " over " << picture.texts[j].words;
      }
    }
  }
}

TEST_P(SheetOfKit, fits_an_office_printer) {
  const Paper paper = sheet_picture(sheet_for(GetParam())).paper;
  EXPECT_EQ(std::min(paper.width_mm, paper.height_mm), 210);
  EXPECT_EQ(std::max(paper.width_mm, paper.height_mm), 297);
}

TEST(Sheet, grows_with_the_part) {
  Sheet sheet = sheet_for("acc-pedestal");
  sheet.edges.push_back({{{-240, 0}, {240, 0}}, true, false});
  const Paper paper = sheet_picture(sheet).paper;
  EXPECT_GT(paper.width_mm, 480);
}

TEST(Sheet, a_pallet_tells_no_force) {
  Sheet sheet = sheet_for("acc-pallet");
  sheet.grips = false;
  for (const Text& text : sheet_picture(sheet).texts)
    EXPECT_THAT(text.words, testing::Not(testing::HasSubstr("77.1")));
}

TEST(Sheet, the_same_design_gives_the_same_bytes) {
  const Picture picture = sheet_picture(sheet_for("acc-pedestal"));
  for (const PictureFormat format : {PictureFormat::Svg, PictureFormat::Pdf, PictureFormat::Png}) {
    const std::string bytes = written(picture, format).value();
    EXPECT_GT(bytes.size(), 10000U);
    EXPECT_TRUE(bytes == written(picture, format).value());
  }
}

TEST(Sheet, names_that_no_cell_holds_are_cut) {
  Sheet sheet = sheet_for("acc-pedestal");
  sheet.task = std::string(300, 'w');
  const Picture picture = sheet_picture(sheet);
  for (const Text& text : picture.texts) EXPECT_LT(box_of(text).most_mm.x(), picture.paper.width_mm);
}

constexpr int kDotsPerMm = 10;

/// Longest dark run, in dots, in the row of a PNG file.
int longest_run_dots(const std::string& png, double y_mm) {
  cairo_surface_t* image = cairo_image_surface_create_from_png(png.c_str());
  EXPECT_EQ(cairo_surface_status(image), CAIRO_STATUS_SUCCESS) << png;
  const int width = cairo_image_surface_get_width(image);
  const unsigned char* row =
      cairo_image_surface_get_data(image) +
      static_cast<std::ptrdiff_t>(std::lround(y_mm * kDotsPerMm)) * cairo_image_surface_get_stride(image);
  int longest = 0;
  int run = 0;
  for (int x = 0; x < width; ++x) {
    run = row[4 * x] < 128 ? run + 1 : 0;  // blue, of black on white
    longest = std::max(longest, run);
  }
  cairo_surface_destroy(image);
  return longest;
}

TEST(Sheet, the_scale_bar_measures_50_mm_in_svg_and_in_pdf) {
  const Picture picture = sheet_picture(sheet_for("acc-pedestal"));
  const auto is_bar = [](const Polyline& line) {
    return line.points_mm.size() == 2 && (line.points_mm[1] - line.points_mm[0]).norm() == 50 &&
           line.pen.width_mm == 0.4;
  };
  const auto bar = std::find_if(picture.lines.begin(), picture.lines.end(), is_bar);
  ASSERT_NE(bar, picture.lines.end());
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("pinjaw-sheet-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string stem = (folder / "sheet").string();
  ASSERT_TRUE(base::write_file_whole(stem + ".svg", written(picture, PictureFormat::Svg).value()));
  ASSERT_TRUE(base::write_file_whole(stem + ".pdf", written(picture, PictureFormat::Pdf).value()));
  const std::string svg_to_png = "rsvg-convert -d 254 -p 254 " + stem + ".svg -o " + stem + "-svg.png";
  const std::string pdf_to_png = "pdftoppm -r 254 -png -singlefile " + stem + ".pdf " + stem + "-pdf";
  ASSERT_EQ(std::system(svg_to_png.c_str()), 0);
  ASSERT_EQ(std::system(pdf_to_png.c_str()), 0);
  const double y_mm = bar->points_mm[0].y();
  EXPECT_NEAR(longest_run_dots(stem + "-svg.png", y_mm), 50 * kDotsPerMm, 5);
  EXPECT_NEAR(longest_run_dots(stem + "-pdf.png", y_mm), 50 * kDotsPerMm, 5);
  std::filesystem::remove_all(folder);
}

TEST(Sheet, a_wide_grip_lies_on_its_side_on_office_paper) {
  Sheet sheet = sheet_for("acc-pedestal");
  sheet.design.jaw_separation_mm = 59;
  const Paper paper = sheet_picture(sheet).paper;
  EXPECT_EQ(paper.width_mm, 297);
  EXPECT_EQ(paper.height_mm, 210);
}

}  // namespace
}  // namespace pinjaw::report

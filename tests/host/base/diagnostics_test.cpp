#include "host/base/diagnostics.hpp"

#include <gmock/gmock.h>

namespace pinjaw::base {
namespace {

TEST(Diagnostics, are_rendered_by_place_with_a_count_and_a_consequence) {
  Diagnostics mistakes;
  mistakes.add({"configs/kits/acc.yaml", 22, 1}, "pins[5].radis_mm",
               "no such setting" + did_you_mean("radis_mm", {"spacing_mm", "radius_mm"}));
  mistakes.add({"configs/kits/acc.yaml", 17, 13}, "pins[3].radius_mm",
               "expected a length above 0, found \"4\"");
  EXPECT_EQ(render(mistakes, "nothing was planned"),
            "configs/kits/acc.yaml:17:13: error: pins[3].radius_mm: expected a length above 0, found \"4\"\n"
            "configs/kits/acc.yaml:22:1: error: pins[5].radis_mm: no such setting; did you mean radius_mm?\n"
            "2 mistakes; nothing was planned\n");
}

TEST(Diagnostics, tell_the_same_mistake_once) {
  Diagnostics mistakes;
  mistakes.add({"f", 1, 1}, "a", "wrong");
  mistakes.add({"f", 1, 1}, "a", "wrong");
  Diagnostics others(mistakes);
  mistakes.add(others);
  EXPECT_EQ(render(mistakes, "stop"), "f:1:1: error: a: wrong\n1 mistake; stop\n");
}

TEST(Diagnostics, keep_the_order_of_files) {
  Diagnostics mistakes;
  mistakes.add({"z", 9, 1}, "", "first file");
  mistakes.add({"a", 0, 0}, "", "second file");
  mistakes.add({"z", 1, 1}, "", "above");
  EXPECT_EQ(render(mistakes, "stop"),
            "z:1:1: error: above\nz:9:1: error: first file\na: error: second file\n3 mistakes; stop\n");
}

TEST(NearestWord, finds_slips_of_typing_and_other_units) {
  const std::vector<std::string> known = {"radius_mm", "spacing_mm", "columns", "rows", "deg"};
  EXPECT_EQ(nearest_word("radis_mm", known), "radius_mm");
  EXPECT_EQ(nearest_word("raduis_mm", known), "radius_mm");
  EXPECT_EQ(nearest_word("radius", known), "radius_mm");
  EXPECT_EQ(nearest_word("spacing_inch", known), "spacing_mm");
  EXPECT_EQ(nearest_word("colums", known), "columns");
  EXPECT_EQ(nearest_word("degrees", known), "deg");
}

TEST(NearestWord, is_silent_where_nothing_is_near) {
  const std::vector<std::string> known = {"radius_mm", "x", "rows"};
  EXPECT_EQ(nearest_word("colour", known), "");
  EXPECT_EQ(nearest_word("y", known), "");
  EXPECT_EQ(nearest_word("", known), "");
  EXPECT_EQ(nearest_word(std::string(100000, 'r'), known), "");
}

}  // namespace
}  // namespace pinjaw::base

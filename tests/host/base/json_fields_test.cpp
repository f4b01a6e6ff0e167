#include "host/base/json_fields.hpp"

#include <gmock/gmock.h>

namespace pinjaw::base {
namespace {

using testing::HasSubstr;

std::string refusal_of(std::string_view text) {
  const auto value = parse_json(text, "f");
  return value ? "it was read" : render(value.error(), "stop");
}

std::string nested(int depth) {
  return "{\"a\":\n" + std::string(static_cast<std::size_t>(depth - 1), '[') +
         std::string(static_cast<std::size_t>(depth - 1), ']') + "}";
}

TEST(Json, is_read_to_its_greatest_depth_and_no_further) {
  EXPECT_TRUE(parse_json(nested(kMaxJsonDepth), "f"));
  EXPECT_THAT(refusal_of(nested(kMaxJsonDepth + 1)), HasSubstr("f:2:64: error: nested too deeply"));
  EXPECT_THAT(refusal_of(std::string(10'000'000, '[')), HasSubstr("f:1:65: error: nested too deeply"));
}

TEST(Json, brackets_in_texts_are_no_depth) {
  EXPECT_TRUE(parse_json("[\"" + std::string(1000, '[') + "\\\"[[\"]", "f"));
}

TEST(Json, a_number_that_no_double_holds_is_told_with_its_place) {
  EXPECT_EQ(refusal_of("{\"a\": 1,\n \"b\": -1e999}"),
            "f:2:7: error: a number too large to be read\n1 mistake; stop\n");
}

TEST(Json, an_endless_text_is_not_told_whole) {
  EXPECT_LT(refusal_of("[\"" + std::string(1'000'000, 'x')).size(), 400U);
}

class Fields : public testing::Test {
 protected:
  /// What is told of the value when `read` reads it.
  std::string told(std::string_view text, const std::function<void(const JsonField&)>& read) {
    const auto value = parse_json(text, "f");
    Diagnostics mistakes;
    const std::string file = "f";
    read(JsonField(&*value, "it", &file, &mistakes));
    return mistakes.empty() ? "" : mistakes.begin()->message;
  }
};

TEST_F(Fields, numbers_obey_their_rules) {
  const auto length = [](const JsonField& field) { (void)field.number({"a length from 0 to 9", 0, 9}); };
  EXPECT_EQ(told("9", length), "");
  EXPECT_EQ(told("9.5", length), "expected a length from 0 to 9, found 9.5");
  EXPECT_EQ(told("\"9\"", length), "expected a length from 0 to 9, found \"9\"");
  const auto count = [](const JsonField& field) { (void)field.whole({"a count from 1 to 64", 1, 64}); };
  EXPECT_EQ(told("64", count), "");
  EXPECT_EQ(told("65", count), "expected a count from 1 to 64, found 65");
  EXPECT_EQ(told("1.5", count), "expected a count from 1 to 64, found 1.5");
  const auto any = [](const JsonField& field) { (void)field.whole(); };
  EXPECT_EQ(told("18446744073709551615", any), "expected a whole number, found 18446744073709551615");
}

TEST_F(Fields, what_is_found_is_told_shortly) {
  const auto number = [](const JsonField& field) { (void)field.number(); };
  EXPECT_EQ(told("[1, 2, 3]", number), "expected a number, found a list of 3");
  EXPECT_EQ(told("{\"a\": 1}", number), "expected a number, found an object");
  const auto three = [](const JsonField& field) { (void)field.numbers(3); };
  EXPECT_EQ(told("[1, 2]", three), "expected 3 numbers, found 2");
}

}  // namespace
}  // namespace pinjaw::base

#include "host/base/yaml.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <limits>

#include "host/base/random.hpp"

namespace pinjaw::base {
namespace {

/// What is told of a text of which nothing is asked.
std::string told(std::string_view text) {
  YamlFile file(text, "file.yaml");
  const YamlMap top = file.top();
  return render(file.mistakes(), "stop");
}

TEST(Yaml, reads_json_too) {
  YamlFile file(R"({"name":"a", "list": [1, 2.5e0], "deep": {"yes": true}})", "file.json");
  YamlMap top = file.top();
  EXPECT_EQ(top.text("name", "a name"), "a");
  EXPECT_THAT(top.find("list")->numbers(2, {"a number"}, "two numbers"),
              testing::Optional(testing::ElementsAre(1, 2.5)));
  EXPECT_EQ(top.find("deep")->map("a map").find("yes")->truth(), true);
  top.finish();
  EXPECT_TRUE(file.mistakes().empty());
}

TEST(Yaml, takes_only_plain_finite_decimals_for_numbers) {
  const NumberRule any{"a number"};
  for (const char* good : {"1", "+1", "-1.5", ".5", "1e3", "1E-3", "007"}) {
    YamlFile file(std::string("n: ") + good, "f");
    EXPECT_TRUE(file.top().find("n")->number(any).has_value()) << good;
  }
  for (const char* bad : {"'1'", "nan", ".nan", "inf", "-.inf", "1e999", "0x10", "1_000", "1,5", "++1", "+-1",
                          "1 mm", "", "~", "true", "[1]", "{a: 1}", "1.2.3"}) {
    YamlFile file(std::string("n: ") + bad, "f");
    EXPECT_FALSE(file.top().find("n")->number(any).has_value()) << bad;
    EXPECT_EQ(file.mistakes().size(), 1U) << bad;
  }
}

TEST(Yaml, a_wrong_number_is_told_once_and_breaks_no_later_rule) {
  YamlFile file("n: x", "f");
  YamlMap top = file.top();
  const double value = top.number("n", {"a number"});
  EXPECT_FALSE(value < 0);
  EXPECT_FALSE(value >= 0);
  EXPECT_EQ(file.mistakes().size(), 1U);
}

TEST(Yaml, limits_nesting) {
  const std::string deep(100000, '[');
  EXPECT_THAT(told(deep), testing::HasSubstr("error: nested too deeply\n1 mistake; stop"));
  std::string blocks = "a:";
  for (int i = 0; i < 100; ++i) blocks += fmt::format("\n{:{}}a:", "", i + 1);
  EXPECT_THAT(told(blocks), testing::HasSubstr("nested too deeply"));
}

TEST(Yaml, refuses_aliases_before_they_multiply) {
  std::string bomb = "a0: &a0 [x, x]\n";
  for (int i = 1; i < 40; ++i) bomb += fmt::format("a{0}: &a{0} [*a{1}, *a{1}]\n", i, i - 1);
  EXPECT_EQ(told(bomb),
            "file.yaml:1:5: error: anchors (&name) are not allowed here; write the value in each place\n"
            "1 mistake; stop\n");
}

TEST(Yaml, limits_the_count_of_values) {
  std::string many = "a: [";
  for (std::size_t i = 0; i <= YamlFile::kMaxValues; ++i) many += "1,";
  EXPECT_THAT(told(many + "]"), testing::HasSubstr("too many values for one file"));
}

TEST(Yaml, refuses_what_is_no_text) {
  EXPECT_THAT(told(std::string("a: \0b", 5)), testing::HasSubstr("file.yaml:1:4: error: not a text file"));
  EXPECT_THAT(told("a: 1\nb: \xC3\x28"), testing::HasSubstr("file.yaml:2:4: error: not a text file"));
  EXPECT_THAT(told("\x7F"
                   "ELF"),
              testing::HasSubstr("not a text file"));
}

TEST(Yaml, tells_a_key_given_twice_by_its_path) {
  EXPECT_EQ(told("a:\n  - {b: 1}\n  - {b: 1, b: 2}\n"),
            "file.yaml:3:12: error: a[1].b: given twice; first in line 3\n1 mistake; stop\n");
}

TEST(Yaml, refuses_a_mapping_of_endless_settings) {
  std::string text;
  for (std::size_t i = 0; i <= YamlFile::kMaxKeys; ++i) text += "k" + std::to_string(i) + ": 1\n";
  YamlFile file(text, "f");
  EXPECT_EQ(render(file.mistakes(), "stop"),
            "f:1:1: error: too many settings in one mapping (line 4001)\n1 mistake; stop\n");
}

TEST(Yaml, counts_mistakes_that_nobody_would_read) {
  std::string many;
  for (int i = 0; i < 3000; ++i) many += fmt::format("key{}: 1\n", i);
  YamlFile file(many, "f");
  file.top().finish();
  EXPECT_EQ(file.mistakes().size(), 3000U);
  EXPECT_THAT(render(file.mistakes(), "stop"), testing::HasSubstr("and 2000 more\n3000 mistakes; stop"));
}

TEST(Yaml, ends_with_a_tree_or_a_mistake_on_any_damage) {
  const std::string good =
      "kit: a\ngrid: {x: 1, y: [1, 2, {z: \"q\"}]}\nlist:\n  - a: 1\n    b: |\n      text\n  - ? k\n    : "
      "v\n";
  const std::string_view noise = "{}[]:,-?|>&*!%@`'\"# \n\t\x01\xC3\xA4za9";
  Random random(7);
  for (int round = 0; round < 3000; ++round) {
    std::string text = good;
    for (int i = 0; i < 4; ++i) {
      text[random.bits() % text.size()] = noise[random.bits() % noise.size()];
      if (random.bits() % 4 == 0)
        text.insert(random.bits() % text.size(), text.substr(random.bits() % text.size()));
    }
    YamlFile file(text, "f");
    EXPECT_TRUE(file.top().present() || !file.mistakes().empty()) << text;
  }
}

}  // namespace
}  // namespace pinjaw::base

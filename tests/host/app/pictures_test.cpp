#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/host/app/child.hpp"

/// features, sheet, kit and dbc.
namespace pinjaw::app_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Features, are_written_as_json_and_as_a_picture) {
  const Bench bench;
  EXPECT_EQ(json::parse(bench.pinjaw("features " + kTask).out).at("format"), "pinjaw-features/1");
  const Ran picture = bench.pinjaw("features " + kTask + " -o features.svg");
  EXPECT_EQ(picture.exit_code, 0);
  EXPECT_THAT(picture.out, HasSubstr("reachable"));
  EXPECT_THAT(bench.read("features.svg"), HasSubstr("<svg"));
  const Ran document = bench.pinjaw("features " + kTask + " -o features.json --json");
  EXPECT_EQ(document.out, bench.read("features.json"));
}

TEST(Sheet, is_drawn_in_each_format_and_never_printed) {
  const Bench bench;
  ASSERT_EQ(bench.pinjaw("plan " + kTask + " --top 1 -o plan.json").exit_code, 0);
  for (const auto& [file, start] :
       {std::pair("sheet.svg", "<?xml"), std::pair("sheet.pdf", "%PDF"), std::pair("sheet.png", "\x89PNG")}) {
    const Ran ran = bench.pinjaw(std::string("sheet plan.json --design best -o ") + file);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_EQ(ran.out, "");
    EXPECT_THAT(bench.read(file), StartsWith(start));
  }
  EXPECT_EQ(bench.pinjaw("sheet plan.json --design nosuch -o other.svg").exit_code, 1);
  EXPECT_FALSE(bench.has("other.svg"));
}

TEST(Kit, is_listed_shown_and_checked) {
  const Bench bench;
  const std::string folder = shipped("configs/kits");
  EXPECT_THAT(bench.pinjaw("kit list " + folder).out, HasSubstr("acc-pedestal"));
  EXPECT_GE(json::parse(bench.pinjaw("kit list --json " + folder).out).size(), 4U);
  const std::string kit = folder + "/acc-arm.yaml";
  EXPECT_THAT(bench.pinjaw("kit show " + kit).out, HasSubstr("usable squeeze"));
  EXPECT_EQ(json::parse(bench.pinjaw("kit show --json " + kit).out).at("name"), "acc-arm");
  EXPECT_EQ(bench.pinjaw("kit check " + kit).out, "the kit is good\n");
  EXPECT_EQ(bench.pinjaw("kit check " + kit + " " + folder + "/gluegun.yaml").out, "all kits are good\n");
}

TEST(Kit, with_mistakes_does_not_hide_the_others) {
  const Bench bench;
  bench.write("kits/a.yaml", "kit: a\n");
  bench.write("kits/b.yaml", bench.run("/bin/cat", shipped("configs/kits/acc-arm.yaml")).out);
  const Ran list = bench.pinjaw("kit list kits");
  EXPECT_EQ(list.exit_code, 3);
  EXPECT_THAT(list.out, StartsWith("acc-arm"));
  EXPECT_THAT(list.err, HasSubstr("1 of 2 kits are good"));
  EXPECT_EQ(bench.pinjaw("kit check kits/a.yaml kits/b.yaml").exit_code, 3);
  EXPECT_THAT(bench.pinjaw("kit list nosuch").err, HasSubstr("nosuch: No such file or directory"));
}

TEST(Dbc, is_what_is_checked_in_and_json_with_json) {
  const Bench bench;
  EXPECT_THAT(bench.pinjaw("dbc").out, HasSubstr("BO_ "));
  EXPECT_EQ(bench.pinjaw("dbc -o all.dbc").exit_code, 0);
  EXPECT_EQ(bench.read("all.dbc"), bench.pinjaw("dbc").out);
  EXPECT_LT(bench.pinjaw("dbc --nodes 1,2").out.size(), bench.read("all.dbc").size());
  EXPECT_EQ(json::parse(bench.pinjaw("dbc --json").out).at("format"), "pinjaw-bus/1");
}

}  // namespace
}  // namespace pinjaw::app_test

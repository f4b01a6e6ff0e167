#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/host/app/child.hpp"

/// plan, planar, why and check on small parts.
namespace pinjaw::app_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json plan_of(const std::string& options) {
  const Ran ran = Bench().pinjaw("plan " + kTask + " " + options);
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  return json::parse(ran.out);
}

TEST(Plan, keeps_as_many_designs_as_asked_and_counts_all) {
  const json all = plan_of("--top all");
  const json three = plan_of("--top 3");
  EXPECT_EQ(all.at("designs").size(), all.at("funnel").at("strong"));
  EXPECT_EQ(three.at("designs").size(), 3U);
  EXPECT_EQ(three.at("funnel"), all.at("funnel"));
  EXPECT_EQ(three.at("designs")[2], all.at("designs")[2]);
}

TEST(Plan, is_the_same_whatever_the_threads) {
  EXPECT_EQ(plan_of("--threads 1"), plan_of("--threads 3"));
}

TEST(Plan, needs_no_more_squeeze_with_the_exact_cone_than_with_the_pyramid) {
  const json cone = plan_of("--friction cone --top 1");
  EXPECT_EQ(cone.at("friction").at("model"), "cone");
  EXPECT_LE(cone.at("designs")[0].at("squeeze").at("required_n"),
            plan_of("--top 1").at("designs")[0].at("squeeze").at("required_n"));
}

TEST(Plan, loads_no_more_fixtures_with_pins_as_tall_as_the_part) {
  const json flat = plan_of("--loading 2d");
  EXPECT_EQ(flat.at("loading"), "2d");
  EXPECT_LE(flat.at("funnel").at("loadable"), plan_of("").at("funnel").at("loadable"));
}

TEST(Plan, of_a_part_that_no_force_can_hold_exits_1_with_the_reason) {
  const Bench bench;
  bench.write("task.yaml",
              "task: heavy\npart: {file: " + shipped("configs/parts/l-plate.yaml") +
                  ", mass_kg: 0.1}\nkit: " + shipped("configs/kits/acc-pedestal.yaml") +
                  "\nfriction: 0.2\ndisturbances:\n  - force: {name: ram, at_mm: [20, 10, 6], force_n: "
                  "[0, 0, -90000]}\n");
  const Ran ran = bench.pinjaw("plan task.yaml -o plan.json");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.out, HasSubstr("no design holds the part"));
  EXPECT_EQ(json::parse(bench.read("plan.json")).at("funnel").at("strong"), 0);
  const Ran why = bench.pinjaw("why task.yaml");
  EXPECT_EQ(why.exit_code, 1);
  EXPECT_THAT(why.out, HasSubstr("left out: needs more than the usable force"));
  EXPECT_EQ(bench.pinjaw("why task.yaml --design best").exit_code, 1);
  EXPECT_EQ(bench.pinjaw("check plan.json").exit_code, 0);
  EXPECT_THAT(bench.pinjaw("sheet plan.json -o a.svg").err, HasSubstr("plan.json has no designs"));
}

class KnownCase : public testing::TestWithParam<const char*> {};

TEST_P(KnownCase, has_as_many_planar_fixtures_as_known) {
  const std::string folder = shipped("tests/host/planner/planar/cases/") + GetParam();
  const Bench bench;
  const Ran expected = bench.run("/bin/cat", folder + "/expected.json");
  const Ran ran = bench.pinjaw("planar " + folder + "/profile.yaml --kit " + folder + "/kit.yaml");
  EXPECT_EQ(ran.exit_code, 0);
  const json document = json::parse(ran.out);
  EXPECT_EQ(document.at("format"), "pinjaw-planar/1");
  EXPECT_EQ(document.at("count"), document.at("fixtures").size());
  EXPECT_EQ(document.at("count"), json::parse(expected.out).at("count"));
}

INSTANTIATE_TEST_SUITE_P(Cases, KnownCase,
                         testing::Values("arcs", "lshape", "pentagon", "star12", "triangle"));

TEST(Why, tells_the_losses_and_what_binds_a_design_as_text_and_as_json) {
  const Bench bench;
  EXPECT_THAT(bench.pinjaw("why " + kTask).out, HasSubstr("left out: "));
  EXPECT_THAT(bench.pinjaw("why " + kTask + " --design best").out, HasSubstr("pushes"));
  const json losses = json::parse(bench.pinjaw("why " + kTask + " --json").out);
  EXPECT_TRUE(losses.contains("funnel") && losses.contains("losses"));
  const json best = json::parse(bench.pinjaw("why " + kTask + " --design best --json").out);
  EXPECT_GE(best.at("contacts").size(), 4U);
  const Ran none = bench.pinjaw("why " + kTask + " --design nosuch");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("none is called nosuch"));
}

TEST(Why, names_a_change_of_the_kit_that_works_when_the_kit_is_changed) {
  const Bench bench;
  const auto write_kit = [&](const std::string& separation) {
    bench.write("kit.yaml",
                "kit: short\ngrid: {spacing_mm: 11.1125, columns: 1, rows: 9, edge_offset_mm: 5.55625}\n"
                "pins: {radius_mm: 2.38125, lengths_mm: any, min_engagement_mm: 1, protrusion_mm: 1}\n"
                "jaws: {separation_mm: " +
                    separation + ", plate_gap_mm: 2}\nactuator: {max_squeeze_n: 140}\n");
  };
  write_kit("[0, 2]");
  bench.write("task.yaml", "task: short\npart: {file: " + shipped("configs/parts/l-plate.yaml") +
                               ", mass_kg: 0.1}\nkit: kit.yaml\nfriction: 0.2\ndisturbances: []\n");
  const Ran why = bench.pinjaw("why task.yaml --json");
  EXPECT_EQ(why.exit_code, 1);
  const json document = json::parse(why.out);
  EXPECT_EQ(document.at("near_misses")[0].at("quantity"), "jaw separation");
  const json& found = document.at("suggestions");
  const auto wider = std::ranges::find_if(found, [](const json& suggestion) {
    return suggestion.at("changes")[0].at("key") == "kit.jaws.separation_mm";
  });
  ASSERT_NE(wider, found.end());
  write_kit(wider->at("changes")[0].at("to"));
  const Ran plan = bench.pinjaw("plan task.yaml");
  EXPECT_EQ(plan.exit_code, 0);
  EXPECT_EQ(json::parse(plan.out).at("funnel").at("strong"), wider->at("designs"));
}

TEST(Why, says_in_words_what_is_missing_and_what_would_help) {
  const Bench bench;
  bench.write("kit.yaml",
              "kit: weak\ngrid: {spacing_mm: 11.1125, columns: 2, rows: 5, edge_offset_mm: 5.55625}\n"
              "pins: {radius_mm: 2.38125, lengths_mm: any, min_engagement_mm: 1, protrusion_mm: 1}\n"
              "jaws: {separation_mm: [0, 60], plate_gap_mm: 2}\nactuator: {max_squeeze_n: 0.5}\ngrip: "
              "{light_n: 0.1}\n");
  bench.write("task.yaml",
              "task: weak\npart: {file: " + shipped("configs/parts/l-plate.yaml") +
                  ", mass_kg: 0.1}\nkit: kit.yaml\nfriction: 0.2\nalways: [{gravity: [0, 0, -1]}]\n"
                  "disturbances: []\n");
  const Ran why = bench.pinjaw("why task.yaml");
  EXPECT_EQ(why.exit_code, 1);
  EXPECT_THAT(why.out, HasSubstr("usable squeeze 0.50 N, needs at least"));
  EXPECT_THAT(why.out, HasSubstr("with kit.actuator.max_squeeze_n: "));
  EXPECT_THAT(bench.pinjaw("why task.yaml --seconds 0").out, HasSubstr("not tried for lack of time"));
}

TEST(Plan, tells_how_robust_the_best_designs_are_and_check_agrees) {
  const Bench bench;
  const Ran ran = bench.pinjaw("plan " + kTask + " --robust 3 --rank robust --top 5 -o plan.json");
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("worst N"));
  json plan = json::parse(bench.read("plan.json"));
  EXPECT_TRUE(plan.contains("ranges"));
  for (std::size_t i = 0; i < 5; ++i) {
    const json& design = plan.at("designs")[i];
    EXPECT_EQ(design.contains("robust"), i < 3);
    if (i >= 3) continue;
    EXPECT_GE(design.at("robust").at("worst_required_n"), design.at("squeeze").at("required_n"));
    EXPECT_LE(design.at("robust").at("location_error_mm"), design.at("robust").at("location_bound_mm"));
  }
  EXPECT_EQ(bench.pinjaw("check plan.json").exit_code, 0);
  plan["designs"][0]["robust"]["worst_required_n"] = 0.5;
  bench.write("lie.json", plan.dump());
  const Ran lie = bench.pinjaw("check lie.json");
  EXPECT_EQ(lie.exit_code, 1);
  EXPECT_THAT(lie.out, HasSubstr("squeeze at the worst point of its ranges"));
}

TEST(Plan, ranked_by_the_worst_lists_the_least_worst_first_and_check_agrees) {
  const Bench bench;
  EXPECT_EQ(bench.pinjaw("plan " + kTask + " --rank robust --robust 4 --top 6 -o plan.json").exit_code, 0);
  const json plan = json::parse(bench.read("plan.json"));
  EXPECT_EQ(plan.at("rank"), "robust");
  EXPECT_EQ(plan.at("designs").size(), 6U);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_LE(plan.at("designs")[i - 1].at("robust").at("worst_required_n"),
              plan.at("designs")[i].at("robust").at("worst_required_n"));
  }
  EXPECT_EQ(bench.pinjaw("check plan.json").exit_code, 0);
}

class Check : public testing::Test {
 protected:
  Check() { bench_.write("plan.json", plan_of("--top 3").dump()); }
  Bench bench_;
};

TEST_F(Check, finds_that_a_plan_holds) {
  const Ran ran = bench_.pinjaw("check plan.json");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_THAT(ran.out, HasSubstr("claims of 3 designs hold"));
  EXPECT_THAT(bench_.pinjaw("check plan.json --design best --all").out, HasSubstr("ok   "));
}

TEST_F(Check, names_the_claim_that_was_tampered_with) {
  json plan = json::parse(bench_.read("plan.json"));
  plan["designs"][1]["squeeze"]["required_n"] = 0.01;
  bench_.write("plan.json", plan.dump());
  const Ran ran = bench_.pinjaw("check plan.json");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.out, HasSubstr("NO   " + plan["designs"][1]["id"].get<std::string>()));
  EXPECT_EQ(bench_.pinjaw("check plan.json --design best").exit_code,
            1);  // the order of the designs is wrong now
  const Ran document = bench_.pinjaw("check plan.json --json");
  EXPECT_EQ(document.exit_code, 1);
  EXPECT_EQ(json::parse(document.out).at("holds"), false);
  EXPECT_FALSE(json::parse(document.out).at("claims").empty());
}

TEST_F(Check, asks_the_exact_faces_about_the_best_designs_unless_told_not_to) {
  EXPECT_THAT(bench_.pinjaw("check plan.json").out, HasSubstr("3 designs re-checked on the exact B-rep"));
  EXPECT_THAT(bench_.pinjaw("check plan.json --exact 1").out,
              HasSubstr("1 design re-checked on the exact B-rep"));
  EXPECT_THAT(bench_.pinjaw("check plan.json --exact none").out, HasSubstr("no design re-checked"));
  const Ran document = bench_.pinjaw("check plan.json --exact 2 --json");
  EXPECT_EQ(json::parse(document.out).at("exact").at("designs"), 2);
  const Ran wrong = bench_.pinjaw("check plan.json --exact some");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err,
              HasSubstr("--exact: expected a whole number from 0 to 1000000, all or none, found some"));
}

TEST_F(Check, exits_1_where_a_pin_does_not_stand_where_the_exact_faces_let_it) {
  json plan = json::parse(bench_.read("plan.json"));
  json& pose = plan["designs"][0]["part_pose"];
  pose["x_mm"] = pose["x_mm"].get<double>() + 0.1;
  bench_.write("plan.json", plan.dump());
  const Ran ran = bench_.pinjaw("check plan.json");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.out, HasSubstr("does not cut the part (exact faces): it does by 0."));
  EXPECT_THAT(ran.out, HasSubstr("gap to the part: mesh 0.0000, exact "));
}

TEST(Plan, tells_what_the_best_designs_come_to_on_exact_faces_and_check_agrees) {
  const Bench bench;
  EXPECT_EQ(bench.pinjaw("plan " + kTask + " --exact 2 --top 3 -o plan.json").exit_code, 0);
  json plan = json::parse(bench.read("plan.json"));
  EXPECT_LT(plan.at("designs")[1].at("exact").at("contact_gap_mm"), 1e-3);
  EXPECT_FALSE(plan.at("designs")[2].contains("exact"));
  EXPECT_EQ(bench.pinjaw("check plan.json").exit_code, 0);
  plan["designs"][1]["exact"]["least_clearance_mm"] = 7;
  bench.write("lie.json", plan.dump());
  const Ran lie = bench.pinjaw("check lie.json --exact 1");
  EXPECT_EQ(lie.exit_code, 1) << "a design that tells it is asked, too";
  EXPECT_THAT(lie.out, HasSubstr("least clearance on the exact faces: stated 7"));
  const Ran mesh = bench.pinjaw("plan " + shipped("configs/tasks/l-bracket-stl.yaml") + " --exact -o x.json");
  EXPECT_EQ(mesh.exit_code, 3);
  EXPECT_THAT(mesh.err, HasSubstr("l_bracket.stl is a mesh without any"));
}

TEST_F(Check, of_a_design_that_is_not_there_says_so) {
  const Ran ran = bench_.pinjaw("check plan.json --design nosuch");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("plan.json has 3 designs, none is called nosuch"));
}

TEST_F(Check, of_a_plan_whose_part_is_gone_names_the_part) {
  json plan = json::parse(bench_.read("plan.json"));
  plan["part"]["file"] = "gone.yaml";
  bench_.write("plan.json", plan.dump());
  const Ran ran = bench_.pinjaw("check plan.json");
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_THAT(ran.err, HasSubstr("gone.yaml"));
}

}  // namespace
}  // namespace pinjaw::app_test

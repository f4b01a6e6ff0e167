#include "host/sequence/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/host/sequence/small_cell.hpp"

/// Whole runs with real controllers, pneumatics and world on the in-process bus.
namespace pinjaw::sequence {
namespace {

using testing::cleaning;
using testing::play;
using testing::Played;

TEST(Run, plays_the_cleaning_sequence_without_ever_letting_go_of_the_part) {
  const Played played = play(cleaning());
  EXPECT_EQ(played.report.result, RunResult::Done) << played.json;
  EXPECT_FALSE(played.trouble);
  EXPECT_FALSE(played.report.undersampled);
  ASSERT_TRUE(played.report.plant);
  const bench::Truth& truth = *played.report.plant;
  EXPECT_FALSE(truth.dropped);
  EXPECT_EQ(truth.slip_mm, 0);
  EXPECT_GE(truth.min_holders.value_or(0), 1);
  EXPECT_TRUE(truth.holders.empty());  // a hand took the part away at the end
  for (const bench::NodeTruth& node : truth.nodes) {
    EXPECT_LE(node.max_steady_n, 140) << node.node;
    EXPECT_LE(node.over_limit_s, 0.02) << node.node;
    EXPECT_TRUE(node.passive || node.max_squeeze_n > 10) << node.node;
  }
}

TEST(Run, holds_with_at_least_the_squeeze_that_was_planned) {
  model::Sequence sequence = cleaning();
  sequence.steps.resize(3);  // the arm has carried it away
  const Played played = play(sequence);
  ASSERT_EQ(played.report.result, RunResult::Done) << played.json;
  const bench::Truth& truth = played.report.plant.value();
  EXPECT_EQ(truth.holders, std::vector{1});
  EXPECT_GE(truth.nodes.front().squeeze_n,
            testing::small_cell().design.stations.front().design.squeeze.required_n);
}

TEST(Run, of_one_seed_is_the_same_to_the_byte) {
  const Played one = play(cleaning());
  const Played other = play(cleaning());
  EXPECT_TRUE(one.log == other.log);
  EXPECT_EQ(one.json, other.json);
}

TEST(Run, of_another_seed_is_another) {
  EXPECT_FALSE(play(cleaning()).log == play(cleaning(), {.seed = 2}).log);
}

TEST(Run, is_done_with_every_specimen_of_the_hardware) {
  for (std::uint64_t seed = 3; seed <= 10; ++seed) {
    const Played played = play(cleaning(), {.seed = seed});
    EXPECT_EQ(played.report.result, RunResult::Done) << seed << played.json;
    EXPECT_FALSE(played.report.plant->dropped) << seed;
  }
}

TEST(Run, reports_what_the_contract_names) {
  const auto report = nlohmann::json::parse(play(cleaning()).json);
  EXPECT_EQ(report.at("format"), "pinjaw-run/1");
  EXPECT_EQ(report.at("result"), "done");
  EXPECT_EQ(report.at("undersampled"), false);
  ASSERT_EQ(report.at("steps").size(), 12U);
  double last_s = 0;
  for (const auto& step : report.at("steps")) {
    EXPECT_EQ(step.at("result"), "done") << step;
    EXPECT_EQ(step.at("from_s"), last_s) << step;
    last_s = step.at("to_s");
    for (const auto& change : step.at("states")) {
      EXPECT_TRUE(change.contains("t_s") && change.contains("node") && change.contains("state") &&
                  change.contains("fact"))
          << change;
    }
  }
  EXPECT_TRUE(report.at("plant").at("max_squeeze_n").contains("1"));
  EXPECT_EQ(report.at("plant").at("dropped"), false);
  EXPECT_GE(report.at("plant").at("min_holders"), 1);
  EXPECT_GT(report.at("bus").at("frames"), 1000);
  EXPECT_TRUE(report.at("bus").contains("load_percent"));
}

TEST(Run, says_undersampled_where_a_draw_needs_more_than_was_planned) {
  model::Sequence sequence = cleaning();
  std::get<model::RotateStep>(sequence.steps.at(6)).peak_g = 4;  // planned for 3 g
  const Played played = play(sequence);
  EXPECT_TRUE(played.report.undersampled);
  EXPECT_EQ(played.report.result, RunResult::Done) << "the controllers squeeze their uncertainty more";
}

TEST(Run, without_a_world_has_no_plant_in_its_report) {
  EXPECT_EQ(nlohmann::json::parse(to_json(RunReport{})).at("plant"), nullptr);
}

TEST(Run, gives_a_handoff_up_when_its_time_is_over) {
  model::Sequence sequence = cleaning();
  std::get<model::HandoffStep>(sequence.steps.at(1)).within_s = 0.2;
  const Played played = play(sequence);
  EXPECT_EQ(played.report.result, RunResult::Aborted);
  EXPECT_EQ(played.trouble, Trouble::Silent);
  EXPECT_EQ(played.report.steps.back().result, "not done within 0.2 s");
  EXPECT_FALSE(played.report.plant->dropped);
  EXPECT_FALSE(played.report.plant->holders.empty());
}

TEST(Run, ends_at_the_commit_where_the_controller_may_not_squeeze_so_much) {
  const Played played = play(cleaning(), {.controller_limit_n = 100});  // the kit says 140
  EXPECT_EQ(played.report.result, RunResult::Aborted);
  EXPECT_EQ(played.trouble, Trouble::ForceLimit) << played.json;
  EXPECT_EQ(played.report.steps.size(), 1U);
  EXPECT_THAT(played.report.steps.front().result, ::testing::HasSubstr("node 1"));
}

}  // namespace
}  // namespace pinjaw::sequence

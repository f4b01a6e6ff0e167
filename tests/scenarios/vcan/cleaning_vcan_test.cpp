#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/scenarios/vcan/programs.hpp"

/// The cleaning sequence on a real vcan: pinjaw, pinjaw-jaw with three controllers, and candump, which hears
/// it all.
namespace pinjaw::scenario {
namespace {

const std::string kCleaning = config("sequences/acc-cleaning.yaml");

TEST(CleaningOnVcan, plays_to_its_end_with_the_part_held_and_the_force_within_its_limit) {
  Controllers controllers(kThree);
  Candump candump(kOut + "/candump.log");
  const std::string report_file = kOut + "/report.json";
  EXPECT_EQ(Process(run_command(kCleaning, controllers, report_file)).wait(), 0);
  candump.stop();

  const nlohmann::json report = finished_report(report_file, 12);
  ASSERT_FALSE(report.is_null());
  for (const auto& [node, squeeze_n] : report.at("plant").at("max_squeeze_n").items()) {
    EXPECT_GT(squeeze_n, 10) << node;
    EXPECT_LE(squeeze_n, 1.05 * 140) << node;
  }
  EXPECT_GT(content(kOut + "/candump.log").size(), 100'000U);
}

TEST(CleaningOnVcan, a_host_killed_in_the_middle_of_a_handoff_leaves_the_part_held) {
  Controllers controllers(kThree);
  Process host(run_command(kCleaning, controllers, kOut + "/never.json"));
  const auto arm_and_pedestal_touch = [](const bench::Truth& truth) {
    return truth.nodes.at(0).touches && truth.nodes.at(1).touches;
  };
  ASSERT_TRUE(controllers.comes_true(arm_and_pedestal_touch, std::chrono::seconds(90)));
  host.signal(SIGKILL);
  EXPECT_EQ(host.wait(), 128 + SIGKILL);
  std::this_thread::sleep_for(std::chrono::seconds(3));  // longer than every time limit of a handoff
  expect_held(controllers.truth());
}

}  // namespace
}  // namespace pinjaw::scenario

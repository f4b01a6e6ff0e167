#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/scenarios/vcan/programs.hpp"
#include "tests/support/places.hpp"

/// The cleaning sequence on a real vcan: pinjaw, pinjaw-jaw with three controllers, and candump, which hears
/// it all.
namespace pinjaw::scenario {
namespace {

const std::vector<std::string> kThree = {"arm", "pedestal", "pallet"};

std::vector<std::string> run_command(const Controllers& controllers, const std::string& report) {
  return {"run",      config("sequences/acc-cleaning.yaml"),
          "--plan",   kOut + "/cell.json",
          "--world",  controllers.world_path(),
          "--report", report};
}

TEST(CleaningOnVcan, plays_to_its_end_with_the_part_held_and_the_force_within_its_limit) {
  Controllers controllers(kThree);
  Process candump({"candump", "-L", "vcan0"}, kOut + "/candump.log");
  const std::string report_file = kOut + "/report.json";
  EXPECT_EQ(pinjaw(run_command(controllers, report_file)), 0);
  candump.signal(SIGINT);
  candump.wait();

  const auto report = nlohmann::json::parse(content(report_file), nullptr, false);
  ASSERT_FALSE(report.is_discarded());
  EXPECT_EQ(report.at("result"), "done");
  EXPECT_EQ(report.at("steps").size(), 12U);
  const auto& plant = report.at("plant");
  EXPECT_EQ(plant.at("dropped"), false);
  EXPECT_GE(plant.at("min_holders"), 1);
  for (const auto& [node, squeeze_n] : plant.at("max_squeeze_n").items()) {
    EXPECT_GT(squeeze_n, 10) << node;
    EXPECT_LE(squeeze_n, 1.05 * 140) << node;
  }
  EXPECT_GT(content(kOut + "/candump.log").size(), 100'000U);
}

TEST(CleaningOnVcan, a_host_killed_in_the_middle_of_a_handoff_leaves_the_part_held) {
  Controllers controllers(kThree);
  std::vector<std::string> command = run_command(controllers, kOut + "/never.json");
  command.insert(command.begin(), test::program("pinjaw"));
  command.insert(command.end(), {"--bus", "can:vcan0"});
  Process host(command);
  const auto arm_and_pedestal_touch = [](const bench::Truth& truth) {
    return truth.nodes.at(0).touches && truth.nodes.at(1).touches;
  };
  ASSERT_TRUE(controllers.comes_true(arm_and_pedestal_touch, std::chrono::seconds(90)));
  host.signal(SIGKILL);
  EXPECT_EQ(host.wait(), 128 + SIGKILL);
  std::this_thread::sleep_for(std::chrono::seconds(3));  // longer than every time limit of a handoff

  const bench::Truth truth = controllers.truth();
  EXPECT_FALSE(truth.dropped);
  EXPECT_FALSE(truth.holders.empty());
  EXPECT_GE(truth.min_holders.value_or(0), 1);
  EXPECT_EQ(truth.slip_mm, 0);
}

}  // namespace
}  // namespace pinjaw::scenario

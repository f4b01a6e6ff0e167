#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/scenarios/vcan/programs.hpp"

/// One controller by hand, each command a host of its own, and the exit codes that scripts rely on.
namespace pinjaw::scenario {
namespace {

using ::testing::HasSubstr;

std::string status() {
  const std::string file = kOut + "/status.txt";
  EXPECT_EQ(pinjaw({"jaw", "status", "--node", "2"}, file), 0);
  return content(file);
}

TEST(CommandsOnVcan, take_a_controller_from_its_layout_to_a_hold) {
  Controllers controllers({"pedestal"});
  EXPECT_THAT(status(), HasSubstr("UNCONF"));
  EXPECT_EQ(pinjaw({"jaw", "close", "--node", "2"}), 4) << "without a layout";
  ASSERT_EQ(pinjaw({"send", kOut + "/plan.json", "--design", "best", "--node", "2"}), 0);
  EXPECT_THAT(status(), HasSubstr("LOADED"));
  EXPECT_EQ(pinjaw({"jaw", "hold", "--node", "2"}), 0);

  const auto design = nlohmann::json::parse(content(kOut + "/plan.json")).at("designs").at(0);
  const double required_n = design.at("squeeze").at("required_n");
  controllers.ask(bench::Place{2, {{2, design.at("jaw_separation_mm"), required_n}}});
  controllers.ask(bench::Enable{2, true});
  ASSERT_EQ(pinjaw({"jaw", "close", "--node", "2"}), 0);
  EXPECT_THAT(status(), HasSubstr("SEATED"));
  EXPECT_EQ(pinjaw({"jaw", "squeeze", "--node", "2", "--force-n", "180", "--permit-n", "200"}), 6);
  EXPECT_THAT(status(), HasSubstr("SEATED"));
  ASSERT_EQ(pinjaw({"jaw", "squeeze", "--node", "2", "--force-n", "60", "--permit-n", "140"}), 0);
  EXPECT_THAT(status(), HasSubstr("HOLD"));
  EXPECT_EQ(controllers.truth().holders, std::vector{2});
  EXPECT_EQ(pinjaw({"jaw", "hold", "--node", "2"}), 0);
  EXPECT_EQ(controllers.truth().holders, std::vector{2});
}

TEST(CommandsOnVcan, tell_a_node_that_is_not_there) {
  Controllers controllers({"pedestal"});
  EXPECT_EQ(pinjaw({"jaw", "status", "--node", "9"}), 5);
  EXPECT_EQ(pinjaw({"send", kOut + "/plan.json", "--design", "best", "--node", "9"}), 5);
}

TEST(CommandsOnVcan, refuse_a_layout_for_another_kit) {
  Controllers controllers({"arm"});  // node 1; the plan is the pedestal's
  EXPECT_EQ(pinjaw({"send", kOut + "/plan.json", "--design", "best", "--node", "1"}), 4);
}

}  // namespace
}  // namespace pinjaw::scenario

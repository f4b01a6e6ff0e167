// Promises: BUS-STRESS.
// The interface goes down or away while pinjaw plays a handoff or waits for a controller: it ends with exit
// code 5 and says why; the controllers hold the part, and answer when the interface is back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenarios/vcan/programs.hpp"

namespace pinjaw::scenario {
namespace {

using testing::HasSubstr;

const std::string kBack =
    "(ip link show vcan0 || ip link add dev vcan0 type vcan) >/dev/null 2>&1 && ip link set vcan0 up";

class InterfaceGone : public testing::TestWithParam<std::string> {
 protected:
  void TearDown() override { shell(kBack); }
};
INSTANTIATE_TEST_SUITE_P(Ways, InterfaceGone, testing::Values("ip link set vcan0 down", "ip link del vcan0"),
                         [](const auto& way) { return way.index == 0 ? "down" : "deleted"; });

TEST_P(InterfaceGone, in_a_run_ends_it_with_exit_code_5_and_the_part_stays_held) {
  Controllers controllers(kThree);
  const std::string told = kOut + "/gone.txt";
  Process host(run_command(handoffs(), controllers), told);
  ASSERT_TRUE(controllers.comes_true(arm_touches, std::chrono::seconds(60)));
  ASSERT_TRUE(shell(GetParam()));
  EXPECT_EQ(host.wait(std::chrono::seconds(60)), 5) << content(told);
  EXPECT_THAT(content(told), HasSubstr("CAN interface vcan0")) << "the step that it ended tells why";
  EXPECT_TRUE(controllers.tells("CAN interface vcan0")) << controllers.said();
  expect_held(controllers.truth());

  ASSERT_TRUE(shell(kBack));
  EXPECT_TRUE(controllers.tells("the bus is back")) << controllers.said();
  for (const std::string node : {"1", "2", "3"}) {
    EXPECT_EQ(pinjaw({"jaw", "status", "--node", node}, "/dev/null"), 0) << node;
  }
  EXPECT_FALSE(controllers.truth().holders.empty());
}

TEST_P(InterfaceGone, before_a_command_ends_it_with_exit_code_5) {
  ASSERT_TRUE(shell(GetParam()));
  const std::string errors = kOut + "/gone.txt";
  EXPECT_EQ(pinjaw({"jaw", "status", "--node", "1"}, "/dev/null", errors), 5);
  EXPECT_THAT(content(errors), HasSubstr("vcan0"));
}

}  // namespace
}  // namespace pinjaw::scenario

// Promises: SIM.
#include "firmware_sim/app/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pinjaw::jaw_app {
namespace {

using ::testing::HasSubstr;

std::variant<Options, Ended> read(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "pinjaw-jaw");
  return read_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(Options, reads_everything) {
  const auto asked =
      read({"a.yaml", "b.yaml", "--bus", "can:vcan0", "--world", "w.sock", "--seed", "7", "--fault",
            "2:leak=0.05", "--fault", "1:supply_lost@20", "--events", "--node-bus", "2=can:vcan1"});
  ASSERT_TRUE(std::holds_alternative<Options>(asked));
  const auto& options = std::get<Options>(asked);
  EXPECT_EQ(options.controllers.size(), 2U);
  EXPECT_EQ(options.interface, "vcan0");
  EXPECT_EQ(options.world, "w.sock");
  EXPECT_EQ(options.seed, 7U);
  ASSERT_EQ(options.faults.size(), 2U);
  EXPECT_EQ(options.faults[0].node, 2);
  EXPECT_EQ(options.faults[0].text, "leak=0.05");
  EXPECT_EQ(options.faults[1].at_s, 20);
  EXPECT_TRUE(options.events);
  EXPECT_EQ(options.interfaces, (std::map<int, std::string>{{2, "vcan1"}}));
}

TEST(Options, wrong_usage_ends_with_2) {
  for (const auto& arguments :
       std::vector<std::vector<const char*>>{{},
                                             {"a.yaml"},
                                             {"--bus", "can:vcan0"},
                                             {"a.yaml", "--bus", "sim:"},
                                             {"a.yaml", "--bus", "can:"},
                                             {"a.yaml", "--bus", "can:vcan0", "--fault", "rust"},
                                             {"a.yaml", "--bus", "can:vcan0", "--seed", "-1"},
                                             {"a.yaml", "--bus", "can:vcan0", "--node-bus", "can:vcan1"},
                                             {"a.yaml", "--bus", "can:vcan0", "--node-bus", "15=can:vcan1"},
                                             {"a.yaml", "--bus", "can:vcan0", "--node-bus", "2=vcan1"},
                                             {"a.yaml", "--bus", "can:vcan0", "--frobnicate"}}) {
    const auto asked = read(arguments);
    ASSERT_TRUE(std::holds_alternative<Ended>(asked)) << ::testing::PrintToString(arguments);
    EXPECT_EQ(std::get<Ended>(asked).code, ExitCode::Usage);
  }
}

TEST(Options, help_and_version_end_with_0) {
  for (const char* argument : {"--help", "--version"}) {
    const auto asked = read({argument});
    ASSERT_TRUE(std::holds_alternative<Ended>(asked));
    EXPECT_EQ(std::get<Ended>(asked).code, ExitCode::Done);
  }
}

TEST(Options, the_bus_of_a_single_command_is_refused_with_the_way_out) {
  EXPECT_THAT(parse_bus("sim:").error(), HasSubstr("pinjaw run"));
  EXPECT_THAT(parse_bus("sim:").error(), HasSubstr("can:IFACE"));
  EXPECT_THAT(parse_bus("vcan0").error(), HasSubstr("no such bus"));
  EXPECT_EQ(parse_bus("can:vcan0"), "vcan0");
}

TEST(Options, a_bad_fault_is_told_with_what_is_wrong) {
  EXPECT_THAT(parse_timed_fault("leak=1").error(), HasSubstr("expected NODE:FAULT"));
  EXPECT_THAT(parse_timed_fault("0:leak=1").error(), HasSubstr("a node from 1 to 14"));
  EXPECT_THAT(parse_timed_fault("15:leak=1").error(), HasSubstr("a node from 1 to 14"));
  EXPECT_THAT(parse_timed_fault("2:").error(), HasSubstr("no such fault"));
  EXPECT_THAT(parse_timed_fault("2:leak").error(), HasSubstr("leak needs a number"));
  EXPECT_THAT(parse_timed_fault("2:leak=1@soon").error(), HasSubstr("seconds"));
  EXPECT_THAT(parse_timed_fault("2:leak=1@-1").error(), HasSubstr("seconds"));
}

}  // namespace
}  // namespace pinjaw::jaw_app

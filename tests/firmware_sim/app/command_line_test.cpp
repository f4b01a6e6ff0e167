// Promises: SIM.
// The program itself: what it prints where, and its exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <string>

#include "tests/firmware_sim/app/arm_files.hpp"
#include "tests/support/places.hpp"

namespace {

using ::testing::HasSubstr;

struct Ran {
  int code = -1;
  std::string text;  ///< stdout and stderr
};

Ran run(const std::string& arguments) {
  const std::string command = pinjaw::test::program("pinjaw-jaw") + " " + arguments + " 2>&1";
  Ran ran;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return ran;
  char buffer[512];
  while (std::fgets(buffer, sizeof(buffer), pipe) != nullptr) ran.text += buffer;
  const int status = pclose(pipe);
  ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

TEST(JawProgram, help_shows_examples) {
  const Ran ran = run("--help");
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.text, HasSubstr("Examples:"));
  EXPECT_THAT(ran.text, HasSubstr("--fault"));
}

TEST(JawProgram, version_names_the_program) {
  const Ran ran = run("--version");
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.text, HasSubstr("pinjaw-jaw 0."));
}

TEST(JawProgram, wrong_usage_exits_2) {
  EXPECT_EQ(run("").code, 2);
  const Ran ran = run("a.yaml --bus sim:");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.text, HasSubstr("can:IFACE"));
}

TEST(JawProgram, a_missing_file_exits_3_and_is_named) {
  const Ran ran = run("/nowhere/arm.yaml --bus can:vcan0");
  EXPECT_EQ(ran.code, 3);
  EXPECT_THAT(ran.text, HasSubstr("/nowhere/arm.yaml"));
  EXPECT_THAT(ran.text, HasSubstr("nothing was simulated"));
}

TEST(JawProgram, a_fault_for_a_node_that_is_not_there_exits_2) {
  const pinjaw::jaw_app::ArmFiles files;
  const Ran ran = run(files.controller() + " --bus can:vcan0 --fault 5:spool_stuck");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.text, HasSubstr("no controller file is of node 5"));
}

TEST(JawProgram, a_bus_that_is_not_there_exits_5_with_one_sentence) {
  const pinjaw::jaw_app::ArmFiles files;
  const Ran ran = run(files.controller() + " --bus can:nosuchcan9");
  EXPECT_EQ(ran.code, 5);
  EXPECT_THAT(ran.text, HasSubstr("pinjaw-jaw: "));
}

}  // namespace

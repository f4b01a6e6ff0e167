#include <gmock/gmock.h>

#include "tests/host/app/child.hpp"

namespace pinjaw::app_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Help : public testing::TestWithParam<const char*> {};

TEST_P(Help, tells_what_the_command_does_its_options_and_an_example_on_stdout) {
  const std::string command = GetParam();
  const Ran ran = Bench().pinjaw(command + " --help");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.err, "");
  EXPECT_THAT(ran.out, HasSubstr("Usage: pinjaw " + command));
  EXPECT_THAT(ran.out, HasSubstr("Example:\n  pinjaw " + command));
  EXPECT_THAT(ran.out, Not(HasSubstr("->")));  // no word of the parser's own
  EXPECT_THAT(ran.out, Not(HasSubstr("TEXT")));
  EXPECT_THAT(ran.out, Not(HasSubstr("INT")));
}

INSTANTIATE_TEST_SUITE_P(Commands, Help,
                         testing::Values("plan", "planar", "features", "why", "check", "cell", "sheet", "kit",
                                         "kit list", "kit show", "kit check", "send", "jaw", "jaw hold",
                                         "jaw close", "jaw squeeze", "jaw offer", "jaw accept", "jaw abort",
                                         "jaw release", "jaw clear", "jaw status", "run", "dbc", "explain"),
                         [](const auto& command) {
                           std::string name = command.param;
                           for (char& c : name) c = c == ' ' ? '_' : c;
                           return name;
                         });

TEST(Help, of_the_program_names_the_commands_the_exit_codes_and_the_globals) {
  const Ran ran = Bench().pinjaw("--help");
  EXPECT_EQ(ran.exit_code, 0);
  for (const char* part :
       {"plan", "explain", "130 interrupted", "--bus", "PINJAW_BUS", "--progress auto|none|json"}) {
    EXPECT_THAT(ran.out, HasSubstr(part));
  }
}

TEST(Help, of_the_version_is_one_line) {
  EXPECT_THAT(Bench().pinjaw("--version").out, testing::MatchesRegex("pinjaw [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(Explain, tells_a_fault_by_name_in_any_case_and_by_number) {
  const Bench bench;
  for (const char* code : {"OVER_FORCE", "over_force", "over-force", "0x7020", "7020"}) {
    const Ran ran = bench.pinjaw(std::string("explain ") + code);
    EXPECT_EQ(ran.exit_code, 0) << code;
    EXPECT_THAT(ran.out, HasSubstr("OVER_FORCE (0x7020): ")) << code;
    EXPECT_THAT(ran.out, HasSubstr("what to do:")) << code;
  }
}

TEST(Explain, names_the_nearest_of_an_unknown_fault) {
  const Ran ran = Bench().pinjaw("explain overforce");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("there is no fault overforce; did you mean OVER_FORCE?"));
}

}  // namespace
}  // namespace pinjaw::app_test

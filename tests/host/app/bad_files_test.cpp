#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/host/app/child.hpp"
#include "tests/support/places.hpp"

/// Each kind of file with mistakes, through the program: exit code 3, places, keys, a count, and nothing
/// written.
namespace pinjaw::app_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string bad(const std::string& name) {
  return shipped("tests/bad_files/" + name);
}

struct Kind {
  const char* name;
  const char* command;  ///< before the file
  const char* file;
  const char* options;  ///< after it
  const char* told;     ///< place, key path and message of one of its mistakes
};

class BadInput : public testing::TestWithParam<Kind> {};

TEST_P(BadInput, exits_3_with_place_key_and_count_and_leaves_the_output_as_it_was) {
  const Bench bench;
  const std::string before = "what stood here before";
  bench.write("out.json", before);
  const Ran ran =
      bench.pinjaw(std::string(GetParam().command) + " " + bad(GetParam().file) + " " + GetParam().options);
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr(bad(GetParam().told)));
  EXPECT_THAT(ran.err, testing::ContainsRegex("\n[0-9]+ mistakes?; [^\n]+\n$"));
  EXPECT_EQ(bench.read("out.json"), before);
  EXPECT_THAT(bench.names(), testing::ElementsAre("out.json"));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BadInput,
    testing::Values(Kind{"kit", "kit check", "kit/misspelt_and_missing.yaml", "",
                         "kit/misspelt_and_missing.yaml:"},
                    Kind{"task", "plan", "task/nested_mistakes.yaml", "-o out.json", "task/"},
                    Kind{"task_without_anything", "plan", "task/lacks_everything.yaml", "-o out.json",
                         "task/lacks_everything.yaml:"},
                    Kind{"task_of_features", "features", "task/disturbances.yaml", "-o out.json",
                         "task/disturbances.yaml:"},
                    Kind{"task_of_why", "why", "task/friction_table.yaml", "", "task/friction_table.yaml:"},
                    Kind{"profile", "planar --kit configs/kits/acc-arm.yaml", "profile/crossing.yaml",
                         "-o out.json", "profile/crossing.yaml:"},
                    Kind{"cell", "cell", "cell/stations_and_handoffs.yaml", "-o out.json", "cell/"},
                    Kind{"sequence", "run", "sequence/steps_and_faults.yaml", "--report out.json",
                         "sequence/steps_and_faults.yaml:"}),
    [](const auto& kind) { return kind.param.name; });

TEST(BadInput, of_a_controller_file_is_told_by_pinjaw_jaw) {
  const Ran ran = Bench().run("pinjaw-jaw", bad("controller/wrong.yaml") + " --bus can:nosuch0");
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("controller/wrong.yaml:"), HasSubstr("nothing was simulated")));
}

TEST(BadInput, of_a_table_of_materials_is_told_with_its_own_place) {
  const Bench bench;
  bench.write("task.yaml", "task: t\npart: {file: " + shipped("configs/parts/cam.yaml") +
                               ", material: steel}\nkit: " + shipped("configs/kits/acc-pedestal.yaml") +
                               "\nfriction: {table: " + bad("materials/wrong.yaml") +
                               ", pins: steel}\ndisturbances: []\n");
  const Ran ran = bench.pinjaw("plan task.yaml -o out.json");
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_THAT(ran.err, HasSubstr("materials/wrong.yaml:"));
  EXPECT_THAT(ran.err, HasSubstr("nothing was planned"));
  EXPECT_FALSE(bench.has("out.json"));
}

class BadPlan : public testing::Test {
 protected:
  Bench bench_;
};

TEST_F(BadPlan, tells_line_column_and_path_of_every_wrong_field) {
  bench_.write("plan.json",
               "{\"format\": \"pinjaw-plan/1\",\n \"task\": 3,\n \"part\": {\"file\": \"x\",\n  \"mass_kg\": "
               "\"heavy\"}}\n");
  for (const char* command : {"check plan.json", "sheet plan.json -o out.svg", "send plan.json --node 1"}) {
    const Ran ran = bench_.pinjaw(command);
    EXPECT_EQ(ran.exit_code, 3) << command;
    EXPECT_THAT(ran.err, HasSubstr("plan.json:2:10: error: task: expected a text, found 3")) << command;
    EXPECT_THAT(ran.err, HasSubstr("plan.json:4:14: error: part.mass_kg: expected a mass from 0 to 1e6 kg"))
        << command;
    EXPECT_THAT(ran.err, HasSubstr("plan.json:3:10: error: part.sha256: missing")) << command;
    EXPECT_THAT(ran.err, testing::ContainsRegex("\n[0-9]+ mistakes; nothing was ")) << command;
  }
  EXPECT_FALSE(bench_.has("out.svg"));
}

TEST_F(BadPlan, tells_where_a_file_that_is_no_json_breaks_off) {
  bench_.write("plan.json", "{\"format\": \"pinjaw-plan/1\",\n \"task\": \"unfin");
  const Ran ran = bench_.pinjaw("check plan.json");
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_THAT(ran.err, HasSubstr("plan.json:2:"));
  EXPECT_THAT(ran.err, HasSubstr("not JSON"));
}

TEST_F(BadPlan, names_the_format_of_another_document) {
  bench_.write("plan.json", "{\n \"format\": \"pinjaw-planar/1\"}");
  EXPECT_THAT(bench_.pinjaw("check plan.json").err,
              HasSubstr("plan.json:2:12: error: format: expected pinjaw-plan/1"));
}

class Unreadable : public testing::TestWithParam<const char*> {};

TEST_P(Unreadable, files_are_told_as_what_they_are) {
  const Bench bench;
  const std::string command = GetParam();
  const auto told = [&](const std::string& file) {
    const Ran ran = bench.pinjaw(command + " " + file + (command == "sheet" ? " -o out.svg" : ""));
    EXPECT_EQ(ran.exit_code, 3) << ran.err;
    EXPECT_EQ(ran.out, "");
    return ran.err;
  };
  EXPECT_THAT(told("missing.file"),
              HasSubstr("missing.file: error: cannot be read: No such file or directory"));
  EXPECT_THAT(told("/"), HasSubstr("/: error: is a folder, not a file"));
  EXPECT_THAT(told("/dev/zero"), HasSubstr("/dev/zero: error: is not a regular file"));
  EXPECT_THAT(told(test::program("pinjaw")), HasSubstr("error: "));
  bench.write("empty", "");
  EXPECT_THAT(told("empty"), HasSubstr("empty"));
}

INSTANTIATE_TEST_SUITE_P(Commands, Unreadable,
                         testing::Values("plan", "why", "features", "cell", "run", "kit check", "check",
                                         "sheet"),
                         [](const auto& command) {
                           std::string name = command.param;
                           for (char& c : name) c = c == ' ' ? '_' : c;
                           return name;
                         });

TEST(Parts, that_are_no_step_files_are_refused_with_their_name) {
  const Bench bench;
  const std::string rest = ", mass_kg: 0.1}\nkit: " + shipped("configs/kits/acc-pedestal.yaml") +
                           "\nfriction: 0.2\ndisturbances: []\n";
  bench.write("task.yaml", "task: t\npart: {file: part.step" + rest);
  for (const std::string_view bytes : {"", "hello", "ISO-10303-21;\nHEADER;\n"}) {
    bench.write("part.step", bytes);
    const Ran ran = bench.pinjaw("plan task.yaml -o out.json");
    EXPECT_EQ(ran.exit_code, 3) << bytes;
    EXPECT_THAT(ran.err, HasSubstr("part.step")) << bytes;
    EXPECT_EQ(ran.out, "") << bytes;
    EXPECT_FALSE(bench.has("out.json"));
  }
}

}  // namespace
}  // namespace pinjaw::app_test

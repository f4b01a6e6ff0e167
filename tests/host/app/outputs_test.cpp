#include <gmock/gmock.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/host/app/child.hpp"
#include "tests/support/places.hpp"

/// Where results, remarks and errors go, and that files appear whole or not.
namespace pinjaw::app_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kTask = shipped("configs/tasks/l-plate.yaml");
const std::string kSlowTask = shipped("configs/tasks/valve-pedestal.yaml");

TEST(Output, of_plan_without_a_file_is_json_alone_on_stdout_and_the_summary_a_remark) {
  const Ran ran = Bench().pinjaw("plan " + kTask);
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(json::parse(ran.out).at("format"), "pinjaw-plan/1");
  EXPECT_THAT(ran.err, HasSubstr("planar fixtures in form closure"));
}

TEST(Output, of_plan_with_a_file_is_the_summary_and_with_json_the_document) {
  const Bench bench;
  const Ran text = bench.pinjaw("plan " + kTask + " -o plan.json");
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out, HasSubstr("squeeze N"));
  const Ran document = bench.pinjaw("plan " + kTask + " -o plan.json --json");
  EXPECT_EQ(document.out, bench.read("plan.json"));
  EXPECT_THAT(bench.names(), ElementsAre("plan.json"));
}

TEST(Output, with_quiet_keeps_remarks_and_progress_but_not_errors_to_itself) {
  const Bench bench;
  EXPECT_EQ(bench.pinjaw("plan " + kTask + " --quiet --progress json").err, "");
  EXPECT_THAT(bench.pinjaw("--quiet plan missing.yaml").err, HasSubstr("missing.yaml"));
}

TEST(Output, of_progress_as_json_is_one_object_a_line) {
  const Bench bench;
  const Ran ran = bench.pinjaw("plan " + kTask + " -o plan.json --progress json");
  std::istringstream lines(ran.err);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const json at = json::parse(line);
    EXPECT_LE(at.at("done").get<int>(), std::max(at.at("total").get<int>(), at.at("done").get<int>()));
    EXPECT_FALSE(at.at("phase").get<std::string>().empty());
  }
  EXPECT_GE(count, 4);
  EXPECT_LT(count, 100);  // a line for every fixture would drown its reader
  EXPECT_EQ(bench.pinjaw("plan " + kTask + " -o plan.json --progress none").err, "");
}

TEST(Output, has_no_escape_sequences_where_nobody_looks_and_none_with_no_color) {
  Bench bench;
  bench.set("NO_COLOR=1");
  const Ran ran = bench.pinjaw("plan missing.yaml");
  EXPECT_EQ(ran.err.find('\033'), std::string::npos);
  EXPECT_EQ(Bench().pinjaw("plan missing.yaml --bus can:x").err.find('\033'), std::string::npos);
}

TEST(Output, that_cannot_be_written_is_told_before_the_work_and_leaves_nothing) {
  const Bench bench;
  bench.write("folder/kept", "");
  for (const auto& [path, why] :
       {std::pair("nowhere/plan.json", "there is no folder nowhere"), std::pair("folder", "it is a folder"),
        std::pair("/proc/plan.json", "cannot write")}) {
    const Ran ran = bench.pinjaw("plan " + kTask + " -o " + path);
    EXPECT_EQ(ran.exit_code, 3) << path;
    EXPECT_EQ(ran.out, "") << path;
    EXPECT_THAT(ran.err, HasSubstr(why)) << path;
  }
  EXPECT_THAT(bench.names(), ElementsAre("folder"));
}

TEST(Output, of_a_run_is_tried_before_anything_moves) {
  const Bench bench;
  for (const char* option : {"--report", "--log"}) {
    const Ran ran =
        bench.pinjaw("run " + shipped("configs/sequences/acc-cleaning.yaml") + " " + option + " nowhere/x");
    EXPECT_EQ(ran.exit_code, 3);
    EXPECT_THAT(ran.err, HasSubstr("there is no folder nowhere"));
  }
}

TEST(Output, that_would_replace_what_is_read_is_refused) {
  const Bench bench;
  bench.write("plan.svg", "{}");
  const Ran ran = bench.pinjaw("sheet plan.svg -o ./plan.svg");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("is what is read"));
  EXPECT_EQ(bench.read("plan.svg"), "{}");
}

TEST(Output, that_stdout_does_not_take_is_told) {
  const Bench bench;
  bench.write("full.sh", "exec " + test::program("pinjaw") + " plan " + kTask + " > /dev/full\n");
  const Ran full = bench.run("/bin/sh", "full.sh");
  EXPECT_EQ(full.exit_code, 3);
  EXPECT_THAT(full.err, HasSubstr("cannot write the result to stdout: No space left on device"));
}

TEST(Output, that_a_full_disk_does_not_take_whole_is_absent_or_the_old_one) {
  const Bench bench;
  const std::string limited = "--fsize=1000 " + test::program("pinjaw") + " plan " + kTask + " -o ";
  const Ran fresh = bench.run("/usr/bin/prlimit", limited + "plan.json");
  EXPECT_EQ(fresh.exit_code, 3);
  EXPECT_THAT(fresh.err, HasSubstr("cannot write plan.json: File too large"));
  EXPECT_TRUE(bench.names().empty());
  bench.write("plan.json", "old");
  EXPECT_EQ(bench.run("/usr/bin/prlimit", limited + "plan.json").exit_code, 3);
  EXPECT_EQ(bench.read("plan.json"), "old");
  EXPECT_THAT(bench.names(), ElementsAre("plan.json"));
  EXPECT_EQ(bench.pinjaw("plan " + kTask + " -o /dev/full").exit_code, 3);
}

TEST(Interrupt, at_any_moment_of_a_plan_ends_it_with_130_and_leaves_a_whole_file_or_none) {
  constexpr int kMoments = 24;
  int ended = 0;
  for (int i = 0; i < kMoments; ++i) {
    const Bench bench;
    const int signal = i % 3 == 0 ? SIGTERM : i % 3 == 1 ? SIGINT : SIGHUP;
    const Ran ran =
        bench.interrupted("plan " + kTask + " --top all -o plan.json --progress json", signal, 0.02 * i);
    EXPECT_THAT(ran.exit_code, testing::AnyOf(130, 0));
    ended += ran.exit_code == 130 ? 1 : 0;
    EXPECT_TRUE(ran.exit_code != 0 || bench.has("plan.json"));
    for (const std::string& name : bench.names()) {
      EXPECT_EQ(name, "plan.json");
      EXPECT_TRUE(json::accept(bench.read(name))) << "after " << 0.02 * i << " s";
    }
  }
  EXPECT_GT(ended, 0);
}

TEST(Interrupt, that_the_caller_ignores_stays_ignored) {
  const Bench bench;
  bench.write("deaf.sh", "trap '' INT\n(sleep 0.1; kill -INT $$) &\nexec " + test::program("pinjaw") +
                             " plan " + kTask + " -o plan.json\n");
  const Ran ran = bench.run("/bin/sh", "deaf.sh");
  EXPECT_EQ(ran.exit_code, 0);
}

TEST(Interrupt, ends_a_plan_with_130_and_leaves_no_file) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Bench bench;
    const Ran ran = bench.interrupted("plan " + kSlowTask + " -o plan.json --progress json", signal, 0.1);
    EXPECT_EQ(ran.exit_code, 130);
    EXPECT_TRUE(bench.names().empty());
  }
}

}  // namespace
}  // namespace pinjaw::app_test

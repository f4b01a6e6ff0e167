#include "host/app/progress.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "tests/host/app/child.hpp"

/// What is shown of how far a plan has come: the lines by themselves, with a clock of the test's own, then on
/// a real terminal.
namespace pinjaw::app_test {
namespace {

using app::duration_text;
using app::finished_line;
using app::JsonDisplay;
using app::live_line;
using app::LiveDisplay;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr int kWide = 200;

TEST(Duration, is_told_in_the_units_that_a_person_waits_in) {
  EXPECT_EQ(duration_text(-1), "0 s");
  EXPECT_EQ(duration_text(0.04), "0.0 s");
  EXPECT_EQ(duration_text(9.94), "9.9 s");
  EXPECT_EQ(duration_text(9.96), "10 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(59.6), "1 min 0 s");
  EXPECT_EQ(duration_text(3599.4), "59 min 59 s");
  EXPECT_EQ(duration_text(3600), "1 h 0 min");
  EXPECT_EQ(duration_text(1e300), "1000 h 0 min");
}

TEST(LiveLine, tells_count_share_rate_and_time_left) {
  EXPECT_EQ(live_line({"heights", 300, 1200}, 10, kWide),
            "heights            300 of 1200   25 %   30/s   30 s left");
}

TEST(LiveLine, gives_no_rate_before_there_is_one) {
  EXPECT_EQ(live_line({"features", 0, 0}, 5, kWide), "features     ...");
  EXPECT_EQ(live_line({"heights", 0, 1200}, 5, kWide), "heights              0 of 1200   0 % ...");
  EXPECT_EQ(live_line({"heights", 900, 1200}, 1e-9, kWide), "heights            900 of 1200   75 % ...");
}

TEST(LiveLine, tells_a_rate_alone_where_the_total_is_unknown) {
  EXPECT_EQ(live_line({"join", 5000, 0}, 2, kWide), "join              5000   2500/s");
}

TEST(LiveLine, is_never_wider_than_the_terminal_and_counts_characters_not_bytes) {
  for (int columns = 2; columns < 60; ++columns) {
    const std::string line = live_line({"Halterung für Gehäuse: planar", 300, 1200}, 10, columns);
    const auto width =
        std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
    EXPECT_LT(width, columns);
  }
}

TEST(LiveLine, lets_no_name_command_the_terminal) {
  const std::string line = live_line({"\033[2Jarm\n", 1, 2}, 10, kWide);
  EXPECT_EQ(line.find_first_of("\033\n"), std::string::npos);
  EXPECT_THAT(line, StartsWith("?[2Jarm?"));
}

TEST(LiveLine, stays_sane_where_more_is_done_than_there_is) {
  EXPECT_THAT(live_line({"x", 30, 20}, 10, kWide), HasSubstr("100 %"));
  EXPECT_THAT(live_line({"x", 30, 20}, 10, kWide), Not(HasSubstr("left")));
}

TEST(FinishedLine, tells_count_and_time_and_how_far_a_stopped_phase_came) {
  EXPECT_EQ(finished_line({"planar", 5000, 5000}, 16.2, kWide), "planar            5000   16 s");
  EXPECT_EQ(finished_line({"planar", 300, 1200}, 2, kWide), "planar       300 of 1200   2.0 s");
  EXPECT_EQ(finished_line({"features", 0, 0}, 0.31, kWide), "features                 0.3 s");
}

TEST(LiveDisplay, writes_over_its_line_a_few_times_a_second_and_leaves_finished_phases_behind) {
  LiveDisplay display(true);
  EXPECT_EQ(display.show({"features", 0, 0}, 100, kWide), "\rfeatures     ...\033[K");
  EXPECT_EQ(display.show({"features", 1, 2}, 100.05, kWide), "");  // too early
  EXPECT_THAT(display.show({"features", 2, 2}, 100.2, kWide), HasSubstr("2 of 2"));
  const std::string next = display.show({"planar", 0, 50}, 101, kWide);
  EXPECT_EQ(next, "\r\033[Kfeatures             2   1.0 s\n\rplanar               0 of 50   0 % ...\033[K");
  EXPECT_EQ(display.finish(103, kWide), "\r\033[Kplanar                   2.0 s\n");
  EXPECT_EQ(display.finish(104, kWide), "");
}

TEST(LiveDisplay, counts_from_the_start_of_each_phase) {
  LiveDisplay display(true);
  display.show({"a", 0, 100}, 0, kWide);
  display.show({"b", 0, 100}, 50, kWide);
  EXPECT_THAT(display.show({"b", 50, 100}, 60, kWide), EndsWith("50 of 100   50 %   5/s   10 s left\033[K"));
}

TEST(LiveDisplay, shows_a_terminal_that_cannot_erase_the_finished_phases_alone) {
  LiveDisplay display(false);
  EXPECT_EQ(display.show({"features", 3, 3}, 0, kWide), "");
  EXPECT_EQ(display.show({"planar", 0, 50}, 1, kWide), "features             3   1.0 s\n");
}

TEST(JsonDisplay, is_one_object_a_line_with_the_first_and_the_last_of_each_phase) {
  JsonDisplay display;
  EXPECT_EQ(display.show({"planar", 0, 50}, 7),
            "{\"phase\":\"planar\",\"done\":0,\"total\":50,\"elapsed_s\":0.0}\n");
  EXPECT_EQ(display.show({"planar", 20, 50}, 7.01), "");
  EXPECT_EQ(display.show({"planar", 50, 50}, 7.02),
            "{\"phase\":\"planar\",\"done\":50,\"total\":50,\"elapsed_s\":0.02}\n");
  EXPECT_THAT(display.show({"heights", 0, 3}, 7.03), HasSubstr("\"elapsed_s\":0.0"));
}

/// What a screen shows of what it was sent, line by line.
std::vector<std::string> shown_by(const std::string& sent) {
  std::vector<std::string> lines(1);
  std::size_t column = 0;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    std::string& line = lines.back();
    if (sent[i] == '\r') {
      column = 0;
    } else if (sent[i] == '\n') {
      lines.emplace_back();
      column = 0;
    } else if (sent.substr(i, 3) == "\033[K") {
      line.resize(std::min(line.size(), column));
      i += 2;
    } else {
      line.resize(std::max(line.size(), column + 1), ' ');
      line[column++] = sent[i];
    }
  }
  return lines;
}

TEST(Terminal, shows_live_lines_and_keeps_each_finished_phase) {
  const Bench bench;
  const Ran ran = bench.on_terminal("plan " + kTask + " -o plan.json", 80);
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_THAT(ran.out, HasSubstr("\r"));
  std::vector<std::string> phases;
  for (const std::string& line : shown_by(ran.out)) {
    if (std::regex_search(line, std::regex("^[a-z]+ +[0-9]* +[0-9.]+ s$")))
      phases.push_back(line.substr(0, line.find(' ')));
  }
  EXPECT_THAT(phases, testing::IsSupersetOf({"features", "planar", "designs"})) << ran.out;
  EXPECT_TRUE(bench.has("plan.json"));
}

TEST(Terminal, of_few_columns_is_never_overrun_by_progress) {
  const Ran ran = Bench().on_terminal("plan " + kTask + " -o plan.json", 20);
  for (const std::string& line : shown_by(ran.out)) {
    if (line.starts_with("gripper") || line.find("   ") == std::string::npos) continue;
    if (std::regex_search(line, std::regex("^(planar|designs|features) .*( s|\\.\\.\\.)$"))) {
      EXPECT_LT(line.size(), 20U) << line;
    }
  }
}

TEST(Terminal, that_is_dumb_or_told_to_be_quiet_gets_no_live_line) {
  Bench dumb;
  dumb.set("TERM=dumb");
  EXPECT_THAT(dumb.on_terminal("plan " + kTask + " -o plan.json", 80).out, Not(HasSubstr("\033")));
  const std::string quiet = Bench().on_terminal("--quiet plan " + kTask + " -o plan.json", 80).out;
  EXPECT_THAT(quiet, Not(HasSubstr("\033")));
}

TEST(Terminal, loses_its_live_line_to_an_interrupt_that_is_typed) {
  const Bench bench;
  const Ran ran = bench.on_terminal("plan " + kSlowTask + " -o plan.json", 80, "\x03", 0.3);
  EXPECT_EQ(ran.exit_code, 130);
  EXPECT_TRUE(bench.names().empty());
  const auto lines = shown_by(ran.out);
  EXPECT_THAT(lines.back(), Not(HasSubstr("..."))) << ran.out;
  EXPECT_THAT(lines.back(), Not(HasSubstr("%"))) << ran.out;
}

}  // namespace
}  // namespace pinjaw::app_test

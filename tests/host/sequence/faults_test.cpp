#include <gtest/gtest.h>

#include "tests/host/sequence/small_cell.hpp"

/// Runs in which the host dies or frames are lost: whatever happens, the part is held.
namespace pinjaw::sequence {
namespace {

using testing::cleaning;
using testing::play;
using testing::Played;

model::ScriptedFault kill_at_step(int step) {
  model::ScriptedFault fault;
  fault.at_step = step;
  fault.kill_host = true;
  return fault;
}
model::ScriptedFault kill_at(double at_s) {
  model::ScriptedFault fault;
  fault.at_s = at_s;
  fault.kill_host = true;
  return fault;
}
model::ScriptedFault lose(int at_step, double share, double seconds) {
  model::ScriptedFault fault;
  fault.at_step = at_step;
  fault.drop_share = share;
  fault.seconds = seconds;
  return fault;
}
model::Sequence cleaning_with(const model::ScriptedFault& fault) {
  model::Sequence sequence = cleaning();
  sequence.faults = {fault};
  return sequence;
}

void expect_held(const Played& played, const std::string& when) {
  EXPECT_FALSE(played.report.plant->dropped) << when;
  EXPECT_EQ(played.report.plant->slip_mm, 0) << when;
  EXPECT_FALSE(played.report.plant->holders.empty()) << when;
}

/// The times between which a step of an undisturbed run is played.
std::pair<double, double> times_of(std::size_t step) {
  static const RunReport kUndisturbed = play(cleaning()).report;
  return {kUndisturbed.steps.at(step).from_s, kUndisturbed.steps.at(step).to_s};
}

TEST(KilledHost, at_the_start_of_any_step_leaves_the_part_held) {
  for (int step = 2; step <= static_cast<int>(cleaning().steps.size()); ++step) {
    const Played played = play(cleaning_with(kill_at_step(step)));
    EXPECT_EQ(played.report.result, RunResult::Aborted);
    EXPECT_FALSE(played.trouble);
    EXPECT_EQ(played.report.steps.back().result, "the host was killed");
    EXPECT_EQ(played.report.steps.size(), static_cast<std::size_t>(step) + 1);
    expect_held(played, "killed at step " + std::to_string(step));
  }
}

TEST(KilledHost, at_any_time_within_a_handoff_leaves_the_part_held) {
  for (const std::size_t handoff : {2U, 4U, 6U, 10U}) {
    const auto [from_s, to_s] = times_of(handoff);
    for (double at_s = from_s + 0.01; at_s < to_s + 0.1; at_s += 0.1) {
      const Played played = play(cleaning_with(kill_at(at_s)));
      EXPECT_EQ(played.report.result, RunResult::Aborted) << at_s;
      expect_held(played, "killed at " + std::to_string(at_s) + " s");
    }
  }
}

TEST(KilledHost, before_the_part_is_there_ends_the_run) {
  const Played played = play(cleaning_with(kill_at(0.1)));
  EXPECT_EQ(played.report.result, RunResult::Aborted);
  EXPECT_FALSE(played.report.plant->placed);
}

TEST(KilledHost, says_nothing_any_more) {
  const Played played = play(cleaning_with(kill_at_step(3)));
  const double killed_s = played.report.steps.back().to_s;
  const std::string heartbeat = " sim0 0F0#";
  const std::size_t last = played.log.rfind("\n", played.log.rfind(heartbeat)) + 1;
  ASSERT_NE(played.log.rfind(heartbeat), std::string::npos);
  EXPECT_LE(std::stod(played.log.substr(last + 1)), killed_s + 0.01);
}

TEST(LostFrames, one_in_five_for_a_second_does_not_stop_a_handoff_and_never_drops_the_part) {
  for (const int step : {2, 4, 6, 10}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Played played = play(cleaning_with(lose(step, 0.2, 1)), {.seed = seed});
      EXPECT_EQ(played.report.result, RunResult::Done) << step << " " << seed << played.json;
      EXPECT_FALSE(played.report.plant->dropped);
      EXPECT_GE(played.report.plant->min_holders.value_or(0), 1);
    }
  }
}

TEST(LostFrames, all_of_them_for_two_seconds_cost_a_try_but_not_the_part) {
  const Played played = play(cleaning_with(lose(4, 1, 2)));
  EXPECT_EQ(played.report.result, RunResult::Done) << played.json;
  EXPECT_GT(played.report.steps.at(4).tries, 1);
  EXPECT_FALSE(played.report.plant->dropped);
}

TEST(LostFrames, all_of_them_for_good_end_the_run_after_three_tries_with_the_part_held) {
  const Played played = play(cleaning_with(lose(4, 1, 1000)));
  EXPECT_EQ(played.report.result, RunResult::Aborted);
  EXPECT_EQ(played.trouble, Trouble::Silent);
  EXPECT_EQ(played.report.steps.back().tries, 3);
  expect_held(played, "a dead bus");
}

TEST(LostFrames, all_for_long_enough_to_end_the_session_do_not_stop_placing) {
  const Played undisturbed = play(cleaning());
  const StepReport& placing = undisturbed.report.steps.at(1);
  for (double at_s = placing.from_s; at_s < placing.to_s; at_s += 0.01) {
    model::ScriptedFault fault;
    fault.at_s = at_s;
    fault.drop_share = 1;
    fault.seconds = 0.25;
    const Played played = play(cleaning_with(fault));
    EXPECT_EQ(played.report.steps.at(1).result, "done") << at_s;
    EXPECT_FALSE(played.report.plant->dropped);
  }
}

TEST(LostFrames, half_of_them_all_the_time_never_drop_the_part) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Played played = play(cleaning_with(lose(2, 0.5, 1000)), {.seed = seed});
    EXPECT_FALSE(played.report.plant->dropped) << seed;
    if (played.report.result == RunResult::Aborted) expect_held(played, "half of all frames lost");
  }
}

TEST(LostFrames, begin_with_their_step) {
  const Played played = play(cleaning_with(lose(4, 1, 1000)));
  for (std::size_t step = 0; step < 4; ++step) EXPECT_EQ(played.report.steps.at(step).result, "done");
  EXPECT_EQ(played.report.steps.size(), 5U);
}

}  // namespace
}  // namespace pinjaw::sequence

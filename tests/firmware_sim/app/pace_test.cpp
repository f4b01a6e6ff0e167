// Promises: SIM.
#include "firmware_sim/app/pace.hpp"

#include <gtest/gtest.h>

namespace pinjaw::jaw_app {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Pace, one_step_is_due_each_millisecond) {
  Pace pace(0);
  EXPECT_EQ(pace.due(0), 1);
  EXPECT_EQ(pace.due(0), 0);
  EXPECT_EQ(pace.due(kMs - 1), 0);
  EXPECT_EQ(pace.due(kMs), 1);
  EXPECT_EQ(pace.next_ns(), 2 * kMs);
}

TEST(Pace, a_late_wake_up_is_caught_up_and_no_millisecond_is_lost) {
  Pace pace(0);
  int steps = 0;
  for (const std::int64_t now : {0L, 7 * kMs, 7 * kMs + 1, 500 * kMs}) steps += pace.due(now);
  EXPECT_EQ(steps, 501);
  EXPECT_EQ(pace.given_up_ms(), 0);
}

TEST(Pace, a_sleep_of_a_minute_is_given_up) {
  Pace pace(0);
  EXPECT_EQ(pace.due(60'000 * kMs), Pace::kMost_ms);
  EXPECT_EQ(pace.given_up_ms(), 60'001 - Pace::kMost_ms);
  EXPECT_EQ(pace.due(60'000 * kMs), 0);
  EXPECT_EQ(pace.due(60'001 * kMs), 1);
}

}  // namespace
}  // namespace pinjaw::jaw_app

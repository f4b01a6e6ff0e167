// Promises: WORLD.
#include "firmware_sim/world/force_record.hpp"

#include <gtest/gtest.h>

namespace pinjaw::world {
namespace {

void observe_for(ForceRecord& record, int duration_ms, double force_n) {
  for (int i = 0; i < duration_ms; ++i) record.observe(force_n, force_n, 100);
}

TEST(ForceRecord, a_peak_of_20_ms_is_not_steady) {
  ForceRecord record;
  observe_for(record, 30, 90);
  observe_for(record, 20, 104);
  observe_for(record, 30, 90);
  EXPECT_EQ(record.max_n(), 104);
  EXPECT_EQ(record.max_steady_n(), 90);
  EXPECT_NEAR(record.over_limit_s(), 0.020, 1e-9);
}

TEST(ForceRecord, one_of_21_ms_is) {
  ForceRecord record;
  observe_for(record, 21, 104);
  EXPECT_EQ(record.max_steady_n(), 104);
}

TEST(ForceRecord, at_the_limit_is_not_over_it) {
  ForceRecord record;
  observe_for(record, 50, 100);
  EXPECT_EQ(record.over_limit_s(), 0.0);
}

}  // namespace
}  // namespace pinjaw::world

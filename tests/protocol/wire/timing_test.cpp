// Promises: I5.
#include "protocol/wire/timing.hpp"

#include <gtest/gtest.h>

#include "protocol/wire/reception.hpp"

namespace pinjaw::wire {
namespace {

TEST(Countdown, runs_until_its_time_has_passed_and_never_below) {
  Countdown countdown;
  EXPECT_FALSE(countdown.running());
  EXPECT_EQ(countdown.left_ms(), 0);
  countdown.start(3);
  countdown.advance(2);
  EXPECT_TRUE(countdown.running());
  EXPECT_EQ(countdown.left_ms(), 1);
  countdown.advance(2);
  EXPECT_FALSE(countdown.running());
  EXPECT_EQ(countdown.left_ms(), 0);
  countdown.start(60000);
  EXPECT_NE(countdown, Countdown{});
  countdown.stop();
  EXPECT_FALSE(countdown.running());
  EXPECT_EQ(countdown, Countdown{});
}

TEST(Times, are_those_of_the_specification) {
  EXPECT_EQ(kPeerFresh_ms, 70);
  EXPECT_EQ(kHostFresh_ms, 200);
  EXPECT_EQ(kHostHeartbeat_ms, 50);
  EXPECT_EQ(kAcknowledge_ms, 50);
  EXPECT_EQ(kStatePeriod_ms, 20);
  EXPECT_EQ(kForceOffset_ms, 10);
  EXPECT_EQ(kCustodyHandoff_ms, 20);
  EXPECT_EQ(kCustodyIdle_ms, 100);
  EXPECT_EQ(kFaultPeriod_ms, 100);
  EXPECT_EQ(kPneumaticsPeriod_ms, 100);
  EXPECT_EQ(kLayoutStatusPeriod_ms, 500);
  EXPECT_EQ(kIdentityPeriod_ms, 1000);
  EXPECT_EQ(kGlobalHoldSpacing_ms, 5);
  EXPECT_EQ(kGlobalHoldRepeats, 3);
  EXPECT_EQ(kCounterModulus, 15);
}

}  // namespace
}  // namespace pinjaw::wire

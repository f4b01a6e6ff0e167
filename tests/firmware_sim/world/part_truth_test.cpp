// Promises: WORLD, SLIP.
#include "firmware_sim/world/part_truth.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace pinjaw::world {
namespace {

Touch jaw(int node, double least_n, double needed_n) {
  return {.node = node, .least_n = least_n, .needed_n = needed_n};
}

Touch pallet(int node, bool seated) {
  return {.node = node, .passive = true, .seated = seated};
}

void observe_for(PartTruth& part, int duration_ms, const std::vector<Touch>& touched) {
  for (int i = 0; i < duration_ms; ++i) part.observe(touched, i * 1e-3);
}

TEST(PartTruth, before_a_part_is_placed_there_is_nothing_to_say) {
  PartTruth part;
  part.observe({jaw(1, 0, 10)}, 0);
  EXPECT_FALSE(part.min_holders());
  EXPECT_FALSE(part.dropped());
}

TEST(PartTruth, exactly_the_needed_squeeze_holds) {
  EXPECT_TRUE(holds(jaw(1, 77.1, 77.1)));
  EXPECT_FALSE(holds(jaw(1, 77.0, 77.1)));
}

TEST(PartTruth, no_squeeze_holds_nothing_even_where_none_is_needed) {
  EXPECT_FALSE(holds(jaw(1, 0, 0)));
}

TEST(PartTruth, what_cannot_be_resisted_is_not_held) {
  EXPECT_FALSE(holds(jaw(1, 1e6, std::numeric_limits<double>::infinity())));
}

TEST(PartTruth, a_pallet_holds_what_rests_on_it) {
  PartTruth part;
  part.place();
  observe_for(part, 10, {pallet(3, true), jaw(1, 0, 60)});
  EXPECT_EQ(part.holders(), std::vector{3});
  EXPECT_EQ(part.min_holders(), 1);
}

TEST(PartTruth, the_least_number_of_holders_is_kept) {
  PartTruth part;
  part.place();
  observe_for(part, 1, {jaw(1, 70, 60), jaw(2, 50, 40)});
  EXPECT_EQ(part.min_holders(), 2);
  observe_for(part, 1, {jaw(1, 50, 60), jaw(2, 50, 40)});
  observe_for(part, 1, {jaw(1, 70, 60), jaw(2, 50, 40)});
  EXPECT_EQ(part.min_holders(), 1);
  EXPECT_FALSE(part.slipped());
}

TEST(PartTruth, held_by_nobody_it_falls_at_once) {
  PartTruth part;
  part.place();
  observe_for(part, 5, {jaw(1, 70, 60)});
  part.observe({jaw(1, 0, 60)}, 0.005);
  EXPECT_TRUE(part.dropped());
  EXPECT_EQ(part.min_holders(), 0);
  EXPECT_DOUBLE_EQ(part.dropped_at_s(), 0.005);
}

TEST(PartTruth, a_fall_is_latched) {
  PartTruth part;
  part.place();
  part.observe({jaw(1, 0, 60)}, 0);
  observe_for(part, 5, {jaw(1, 70, 60)});
  EXPECT_TRUE(part.dropped());
  EXPECT_TRUE(part.holders().empty());
}

TEST(PartTruth, too_little_squeeze_lets_it_slide_and_then_fall) {
  PartTruth part;
  part.place();
  observe_for(part, 5, {jaw(1, 59, 60)});
  EXPECT_TRUE(part.slipped());
  EXPECT_FALSE(part.dropped());
  EXPECT_GT(part.slip_mm(), 0);
  observe_for(part, 500, {jaw(1, 59, 60)});
  EXPECT_TRUE(part.dropped());
}

TEST(PartTruth, half_the_squeeze_slides_faster) {
  PartTruth slow;
  PartTruth fast;
  slow.place();
  fast.place();
  observe_for(slow, 10, {jaw(1, 54, 60)});
  observe_for(fast, 10, {jaw(1, 30, 60)});
  EXPECT_NEAR(fast.slip_mm() / slow.slip_mm(), 5.0, 1e-6);
}

TEST(PartTruth, a_slide_that_is_stopped_stays_known) {
  PartTruth part;
  part.place();
  observe_for(part, 5, {jaw(1, 59, 60)});
  observe_for(part, 1000, {jaw(1, 61, 60)});
  EXPECT_TRUE(part.slipped());
  EXPECT_FALSE(part.dropped());
}

TEST(PartTruth, a_hand_keeps_it_from_falling_and_is_no_holder) {
  PartTruth part;
  part.place();
  part.set_hand(true);
  observe_for(part, 100, {jaw(1, 0, 60)});
  EXPECT_FALSE(part.dropped());
  EXPECT_FALSE(part.min_holders());
  part.set_hand(false);
  observe_for(part, 1, {jaw(1, 0, 60)});
  EXPECT_TRUE(part.dropped());
}

}  // namespace
}  // namespace pinjaw::world

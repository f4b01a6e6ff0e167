// Promises: I4.
#include "protocol/wire/reception.hpp"

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>

namespace pinjaw::wire {
namespace {

CounterCheck after(std::initializer_list<int> counters) {
  CounterCheck check;
  for (const int counter : counters) check.accept(static_cast<std::uint8_t>(counter));
  return check;
}

TEST(CounterCheck, needs_three_in_a_row_at_the_start) {
  EXPECT_FALSE(after({}).qualified());
  EXPECT_FALSE(after({4}).qualified());
  EXPECT_FALSE(after({4, 5}).qualified());
  EXPECT_TRUE(after({4, 5, 6}).qualified());
}

TEST(CounterCheck, forgives_two_losses_and_the_wrap) {
  for (std::uint8_t last = 0; last < kCounterModulus; ++last) {
    for (unsigned step = 0; step < kCounterModulus; ++step) {
      CounterCheck check;
      auto counter = static_cast<std::uint8_t>((last + kCounterModulus - 2U) % kCounterModulus);
      for (int i = 0; i < 3; ++i, counter = next_counter(counter)) check.accept(counter);
      ASSERT_TRUE(check.qualified());
      const auto verdict = check.accept(static_cast<std::uint8_t>((last + step) % kCounterModulus));
      EXPECT_EQ(verdict, step >= 1 && step <= 3 ? CounterVerdict::Qualified : CounterVerdict::Discarded)
          << int{last} << " + " << step;
    }
  }
}

TEST(CounterCheck, starts_over_after_a_repeat_or_a_jump) {
  for (const int odd : {6, 10}) {
    CounterCheck check = after({4, 5, 6});
    EXPECT_EQ(check.accept(static_cast<std::uint8_t>(odd)), CounterVerdict::Discarded);
    EXPECT_EQ(check.accept(static_cast<std::uint8_t>(odd + 1)), CounterVerdict::Qualifying);
    EXPECT_EQ(check.accept(static_cast<std::uint8_t>(odd + 2)), CounterVerdict::Qualifying);
    EXPECT_EQ(check.accept(static_cast<std::uint8_t>(odd + 3)), CounterVerdict::Qualified);
  }
}

TEST(CounterCheck, is_in_order_again_with_the_third_frame_after_one_stray) {
  for (std::uint8_t stray = 0; stray < kCounterModulus; ++stray) {
    if (stray >= 7 && stray <= 9) continue;  // it would be next
    CounterCheck check = after({4, 5, 6});
    EXPECT_EQ(check.accept(stray), CounterVerdict::Discarded) << int{stray};
    EXPECT_EQ(check.accept(7), CounterVerdict::Qualifying) << int{stray};
    EXPECT_EQ(check.accept(8), CounterVerdict::Qualifying) << int{stray};
    EXPECT_EQ(check.accept(9), CounterVerdict::Qualified) << int{stray};
  }
}

TEST(CounterCheck, takes_a_second_stray_for_a_new_row_only_where_it_goes_on_from_the_first) {
  for (std::uint8_t second = 0; second < kCounterModulus; ++second) {
    if (second >= 7 && second <= 9) continue;  // it would be next after 6
    CounterCheck check = after({4, 5, 6});
    ASSERT_EQ(check.accept(11), CounterVerdict::Discarded);
    EXPECT_EQ(check.accept(second), second >= 12 ? CounterVerdict::Qualifying : CounterVerdict::Discarded)
        << int{second};
  }
}

TEST(CounterCheck, forgets_a_stray_once_the_row_goes_on) {
  for (const int stray : {0, 1, 2, 3, 4, 5, 6, 10, 11, 12, 13, 14}) {
    EXPECT_EQ(after({4, 5, 6, stray, 7, 8, 9}), after({4, 5, 6, 7, 8, 9})) << stray;
  }
  CounterCheck check = after({4, 5, 6, 13, 7, 8, 9});
  EXPECT_EQ(check.accept(0), CounterVerdict::Discarded) << "13 is no longer where a row may begin";
}

TEST(CounterCheck, differs_from_another_in_each_thing_it_keeps) {
  EXPECT_NE(after({4}), after({5})) << "the last counter";
  EXPECT_NE(after({4, 11}), after({4, 12})) << "the stray";
  EXPECT_NE(after({4, 5}), after({5})) << "how many in a row";
  EXPECT_NE(after({0, 0}), after({})) << "whether one was heard";
}

TEST(CounterCheck, begins_with_any_counter_and_has_heard_nothing_before) {
  CounterCheck check;
  EXPECT_FALSE(check.heard());
  EXPECT_FALSE(check.qualified());
  EXPECT_EQ(check.accept(9), CounterVerdict::Qualifying);
  EXPECT_TRUE(check.heard());
  EXPECT_EQ(check.accept(10), CounterVerdict::Qualifying);
  EXPECT_EQ(check.accept(11), CounterVerdict::Qualified);
  EXPECT_EQ(next_counter(13), 14);
  EXPECT_EQ(next_counter(14), 0);
}

}  // namespace
}  // namespace pinjaw::wire

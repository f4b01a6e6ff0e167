// Promises: CODEC.
#include <gtest/gtest.h>

#include "tests/protocol/wire/constant_checks.hpp"

/// What the compiler has checked holds for what runs, too.
namespace pinjaw::wire {
namespace {

using testing::kKnown;
using testing::kNamed;
using testing::kNibble;
using testing::kUnknown;

TEST(Constants, of_the_tables_hold_at_run_time_too) {
  for (const FieldSpec* field : {&kNibble, &kKnown, &kUnknown, &kNamed}) {
    const detail::FieldRule rule(*field);
    EXPECT_EQ(rule.start(), field->start);
    EXPECT_EQ(rule.mask() << rule.start(), field->mask());
    for (std::uint64_t raw = 0; raw < 256; ++raw) {
      if (field == &kNibble) continue;  // a bound that is CTR's alone
      EXPECT_EQ(rule.admits(raw), field->admits(raw)) << field->name << ' ' << raw;
    }
  }
  EXPECT_EQ(kNibble.largest(), 9U);
  EXPECT_EQ(kKnown.largest(), 255U);
  EXPECT_EQ(kUnknown.largest(), 254U);
  EXPECT_FALSE(kUnknown.admits(256));
  EXPECT_FALSE(kKnown.admits(256));
}

}  // namespace
}  // namespace pinjaw::wire

// Promises: I7.
#include "firmware_sim/node/nvm.hpp"

#include <gtest/gtest.h>

namespace pinjaw::node {
namespace {

core::NvmWrite record_write(std::uint16_t sequence, std::uint16_t token) {
  core::NvmWrite write;
  write.sequence = sequence;
  write.record = core::NvmRecord{.custody = core::Custody::Sole, .token = token};
  return write;
}

TEST(Nvm, a_fresh_memory_holds_nothing) {
  const Nvm memory;
  EXPECT_FALSE(memory.image().record);
  EXPECT_EQ(memory.image().layout.size, 0);
  EXPECT_EQ(memory.status().done, 0);
}

TEST(Nvm, a_write_takes_its_time) {
  Nvm memory;
  memory.store(record_write(1, 7));
  memory.advance_ms(Nvm::kWrite_ms - 1);
  EXPECT_EQ(memory.status().done, 0);
  EXPECT_FALSE(memory.image().record);
  memory.advance_ms(1);
  EXPECT_EQ(memory.status().done, 1);
  EXPECT_EQ(memory.image().record->token, 7);
}

TEST(Nvm, a_record_survives_a_power_cut_one_under_way_may_and_one_that_waits_does_not) {
  Nvm memory;
  memory.store(record_write(1, 7));
  memory.advance_ms(Nvm::kWrite_ms);
  memory.store(record_write(2, 8));
  memory.store(record_write(3, 9));
  memory.advance_ms(Nvm::kWrite_ms - 1);
  memory.cut_power();
  memory.advance_ms(100);
  EXPECT_TRUE(memory.image().record->token == 7 || memory.image().record->token == 8);
  EXPECT_EQ(memory.status().done, 0);
  memory.store(record_write(1, 10));
  memory.advance_ms(Nvm::kWrite_ms);
  EXPECT_EQ(memory.image().record->token, 10) << "stores anew over what was cut short";
}

TEST(Nvm, writes_that_wait_are_stored_in_turn_and_lose_neither_part) {
  Nvm memory;
  memory.store(record_write(1, 7));
  memory.store(record_write(2, 8));
  core::NvmWrite layout;
  layout.sequence = 3;
  layout.layout = core::LayoutBlob{.bytes = {1}, .size = 1};
  memory.store(layout);
  memory.advance_ms(Nvm::kWrite_ms);
  EXPECT_EQ(memory.status().done, 1);
  memory.advance_ms(Nvm::kWrite_ms);
  EXPECT_EQ(memory.status().done, 3);
  EXPECT_EQ(memory.image().record->token, 8);
  EXPECT_EQ(memory.image().layout.size, 1);
}

TEST(Nvm, a_failed_memory_says_so_and_keeps_what_it_had) {
  Nvm memory;
  memory.store(record_write(1, 7));
  memory.advance_ms(Nvm::kWrite_ms);
  memory.fail();
  memory.store(record_write(2, 8));
  memory.advance_ms(10);
  EXPECT_TRUE(memory.status().failed);
  EXPECT_EQ(memory.status().done, 1);
  EXPECT_EQ(memory.image().record->token, 7);
}

}  // namespace
}  // namespace pinjaw::node

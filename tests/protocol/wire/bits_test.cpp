// Promises: CODEC, TRANSFER.
#include "protocol/wire/bits.hpp"

#include <gtest/gtest.h>

#include <array>

#include "protocol/wire/identification.hpp"
#include "protocol/wire/services.hpp"

namespace pinjaw::wire {
namespace {

TEST(Bits, ones_fill_as_many_low_bits_as_asked) {
  EXPECT_EQ(ones(0), 0U);
  EXPECT_EQ(ones(1), 1U);
  EXPECT_EQ(ones(12), 0xFFFU);
  EXPECT_EQ(ones(63), 0x7FFFFFFFFFFFFFFFU);
  EXPECT_EQ(ones(64), 0xFFFFFFFFFFFFFFFFU);
  EXPECT_EQ(ones(65), 0xFFFFFFFFFFFFFFFFU);
}

TEST(Bits, of_byte_n_stand_at_8n) {
  const Payload payload{0x01, 0x23, 0x45, 0x67, 0x89, 0xAB, 0xCD, 0xEF};
  EXPECT_EQ(to_word(payload), 0xEFCDAB8967452301U);
  EXPECT_EQ(to_payload(0xEFCDAB8967452301U), payload);
}

TEST(ByteWriter, writes_the_low_byte_first_and_says_how_far_it_came) {
  std::array<std::uint8_t, 6> bytes{};
  ByteWriter out(bytes);
  EXPECT_EQ(out.used(), 0U);
  out.put(0x0102030405U, 4);
  out.put(0xAAU, 1);
  EXPECT_EQ(bytes, (std::array<std::uint8_t, 6>{0x05, 0x04, 0x03, 0x02, 0xAA, 0}));
  EXPECT_EQ(out.used(), 5U);
  EXPECT_FALSE(out.overflowed());
}

TEST(ByteWriter, fills_its_room_to_the_last_byte_and_drops_the_rest) {
  std::array<std::uint8_t, 4> bytes{1, 2, 3, 4};
  const std::span<std::uint8_t> room(bytes);
  ByteWriter out(room.first(2));
  out.put(0x2211U, 2);
  EXPECT_FALSE(out.overflowed()) << "exactly full";
  out.put(0x33U, 1);
  EXPECT_TRUE(out.overflowed());
  EXPECT_EQ(out.used(), 2U);
  EXPECT_EQ(bytes, (std::array<std::uint8_t, 4>{0x11, 0x22, 3, 4}));
}

TEST(ByteReader, gives_what_a_writer_wrote_and_counts_what_is_left) {
  constexpr std::array<std::uint8_t, 7> kBytes{0x78, 0x56, 0x34, 0x12, 0xCD, 0xAB, 0xEE};
  ByteReader in(kBytes);
  EXPECT_EQ(in.left(), 7U);
  EXPECT_EQ(in.take(4), 0x12345678U);
  EXPECT_EQ(in.take(2), 0xABCDU);
  EXPECT_EQ(in.used(), 6U);
  EXPECT_EQ(in.left(), 1U);
  EXPECT_EQ(in.take(1), 0xEEU);
  EXPECT_FALSE(in.truncated()) << "read to the end, not past it";
}

TEST(ByteReader, past_the_end_gives_nothing_of_a_number_and_nothing_after_it) {
  constexpr std::array<std::uint8_t, 3> kBytes{1, 2, 3};
  ByteReader in(kBytes);
  EXPECT_EQ(in.take(4), 0U) << "three of four bytes are no number";
  EXPECT_TRUE(in.truncated());
  EXPECT_EQ(in.take(1), 0U);
  EXPECT_TRUE(in.truncated());
  EXPECT_EQ(in.left(), 0U);
}

constexpr Identification kSomeone{.node = 5,
                                  .node_class = NodeClass::Passive,
                                  .kit_id = 0xACC1,
                                  .f_hardware_dn = 1400,
                                  .f_uncertainty_dn = 120,
                                  .layout_crc = 0xDEADBEEF,
                                  .layout_committed = true};

std::array<std::uint8_t, Identification::kBytes> answer_of(const Identification& who) {
  std::array<std::uint8_t, Identification::kBytes> bytes{};
  ByteWriter out(bytes);
  who.put(out);
  EXPECT_EQ(out.used(), bytes.size());
  EXPECT_FALSE(out.overflowed());
  return bytes;
}

TEST(Identification, of_a_controller_that_said_nothing_is_all_zero) {
  std::array<std::uint8_t, 13> nothing{};
  nothing[1] = static_cast<std::uint8_t>(NodeClass::Gripper);
  EXPECT_EQ(answer_of({}), nothing);
}

TEST(Identification, travels_in_thirteen_bytes_in_this_order) {
  EXPECT_EQ(answer_of(kSomeone),
            (std::array<std::uint8_t, 13>{5, 2, 0xC1, 0xAC, 0x78, 0x05, 120, 0, 0xEF, 0xBE, 0xAD, 0xDE, 1}));
}

TEST(Identification, comes_back_as_it_was_sent) {
  Identification other = kSomeone;
  other.node_class = NodeClass::Gripper;
  other.layout_committed = false;
  for (const Identification& who : {kSomeone, other}) {
    const auto bytes = answer_of(who);
    const auto back = Identification::read(bytes);
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(*back, who);
  }
}

TEST(Identification, of_another_length_or_class_is_none) {
  auto bytes = answer_of(kSomeone);
  EXPECT_FALSE(Identification::read(std::span(bytes).first(12)).has_value());
  std::array<std::uint8_t, 14> longer{};
  std::copy(bytes.begin(), bytes.end(), longer.begin());
  EXPECT_FALSE(Identification::read(longer).has_value());
  EXPECT_FALSE(Identification::read({}).has_value());
  for (const std::uint8_t strange : {std::uint8_t{0}, std::uint8_t{3}, std::uint8_t{255}}) {
    bytes[1] = strange;
    EXPECT_FALSE(Identification::read(bytes).has_value()) << int{strange};
  }
}

TEST(Identification, of_a_committed_flag_that_is_no_truth_value_commits_nothing) {
  auto bytes = answer_of(kSomeone);
  bytes[12] = 2;
  EXPECT_FALSE(Identification::read(bytes)->layout_committed);
}

TEST(TransferStatus, has_a_name_or_a_question_mark) {
  EXPECT_STREQ(to_string(TransferStatus::Ok), "OK");
  EXPECT_STREQ(to_string(TransferStatus::Memory), "MEMORY");
  EXPECT_STREQ(to_string(static_cast<TransferStatus>(kTransferStatusCount)), "?");
}

TEST(TransferStatus, of_force_is_told_from_the_others) {
  for (std::size_t i = 0; i < kTransferStatusCount; ++i) {
    const auto status = static_cast<TransferStatus>(i);
    const bool force = status == TransferStatus::ForceWindow || status == TransferStatus::LightForce ||
                       status == TransferStatus::ForceOverHardware;
    EXPECT_EQ(is_force_refusal(status), force) << to_string(status);
  }
}

}  // namespace
}  // namespace pinjaw::wire

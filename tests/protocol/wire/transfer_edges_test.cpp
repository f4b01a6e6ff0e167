// Promises: TRANSFER.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "protocol/wire/transfer.hpp"

/// Each byte and millisecond of a layout transfer (ISO 15765-2), seen from outside.
namespace pinjaw::wire {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes numbered(std::size_t size) {
  Bytes bytes(size);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  return bytes;
}

Payload flow(unsigned status, unsigned block, unsigned gap) {
  return {static_cast<std::uint8_t>(0x30U | status), static_cast<std::uint8_t>(block),
          static_cast<std::uint8_t>(gap)};
}

constexpr std::uint16_t kGap_ms = kSegmentGap_ms + kSegmentOnBus_ms;  ///< from segment to segment

TransferSender sending(std::size_t size) {
  TransferSender sender;
  EXPECT_TRUE(sender.start(numbered(size)));
  return sender;
}

TEST(SegmentKinds, are_told_by_the_high_half_of_the_first_byte) {
  for (unsigned byte = 0; byte < 256; ++byte) {
    const SegmentKind kind = kind_of({static_cast<std::uint8_t>(byte)});
    EXPECT_EQ(kind, byte < 0x40 ? static_cast<SegmentKind>(byte >> 4) : SegmentKind::Unknown) << byte;
  }
}

TEST(TransferSender, says_a_message_of_up_to_seven_bytes_in_one_segment) {
  for (std::size_t size = 1; size <= 7; ++size) {
    TransferSender sender = sending(size);
    EXPECT_TRUE(sender.busy());
    const auto segment = sender.advance(0);
    ASSERT_TRUE(segment.has_value());
    EXPECT_EQ((*segment)[0], size);
    for (std::size_t i = 1; i < 8; ++i) EXPECT_EQ((*segment)[i], i <= size ? i : 0xCCU) << size << ' ' << i;
    EXPECT_FALSE(sender.busy());
    EXPECT_EQ(sender.last_end(), TransferEnd::Done);
    EXPECT_FALSE(sender.advance(1000).has_value());
  }
}

TEST(TransferSender, announces_a_longer_one_and_waits_for_leave) {
  for (const std::size_t size : {std::size_t{8}, std::size_t{255}, std::size_t{256}}) {
    TransferSender sender = sending(size);
    const auto segment = sender.advance(0);
    ASSERT_TRUE(segment.has_value());
    EXPECT_EQ((*segment)[0], 0x10U | size >> 8);
    EXPECT_EQ((*segment)[1], size & 0xFFU);
    for (std::size_t i = 2; i < 8; ++i) EXPECT_EQ((*segment)[i], i - 1);
    EXPECT_FALSE(sender.advance(199).has_value());
    EXPECT_TRUE(sender.busy());
  }
}

TEST(TransferSender, numbers_its_segments_from_1_to_15_and_round_to_0) {
  TransferSender sender = sending(200);
  sender.advance(0);
  sender.accept(flow(0, 0, 0));
  for (unsigned i = 1; i <= 27; ++i) {
    const auto segment = sender.advance(i == 1 ? 0 : kGap_ms);
    ASSERT_TRUE(segment.has_value()) << i;
    EXPECT_EQ((*segment)[0], 0x20U | (i & 0xFU));
    EXPECT_EQ((*segment)[1], 7 * i);
  }
  EXPECT_TRUE(sender.busy());
  const auto last = sender.advance(kGap_ms);
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ((*last)[5], 200);
  EXPECT_EQ((*last)[6], 0xCC);
  EXPECT_EQ(sender.last_end(), TransferEnd::Done);
}

TEST(TransferSender, stops_after_each_block_and_goes_on_when_told_to) {
  TransferSender sender = sending(100);
  sender.advance(0);
  for (const unsigned block : {3U, 1U, 2U}) {
    sender.accept(flow(0, block, 5));
    for (unsigned i = 0; i < block; ++i)
      ASSERT_TRUE(sender.advance(i == 0 ? 0 : kGap_ms).has_value()) << block << ' ' << i;
    EXPECT_FALSE(sender.advance(5).has_value()) << "after a block of " << block;
    EXPECT_FALSE(sender.advance(194).has_value());
    EXPECT_TRUE(sender.busy()) << "199 ms after the block";
  }
  sender.advance(1);
  EXPECT_EQ(sender.last_end(), TransferEnd::Silence);
}

TEST(TransferSender, keeps_the_gap_that_it_was_asked_for_but_five_milliseconds_at_least) {
  const std::vector<std::pair<unsigned, int>> gaps = {{0x00, 5},   {0x01, 5},   {0x05, 5},   {0x06, 6},
                                                      {0x7E, 126}, {0x7F, 127}, {0x80, 127}, {0xF0, 127},
                                                      {0xF1, 5},   {0xF5, 5},   {0xF9, 5},   {0xFA, 127}};
  for (const auto& [asked, kept_ms] : gaps) {
    TransferSender sender = sending(100);
    sender.advance(0);
    sender.accept(flow(0, 0, asked));
    ASSERT_TRUE(sender.advance(0).has_value());
    EXPECT_FALSE(sender.advance(static_cast<std::uint16_t>(kept_ms)).has_value())
        << asked << ", and the frame";
    EXPECT_TRUE(sender.advance(1).has_value()) << asked;
  }
}

TEST(TransferSender, waits_200_ms_after_each_wait_and_forgets_old_waits_when_it_goes_on) {
  TransferSender sender = sending(100);
  sender.advance(0);
  for (int i = 0; i < 3; ++i) {
    sender.advance(199);
    sender.accept(flow(1, 0, 0));
    ASSERT_TRUE(sender.busy()) << i;
  }
  sender.advance(199);
  ASSERT_TRUE(sender.busy());
  sender.accept(flow(0, 1, 0));
  ASSERT_TRUE(sender.advance(0).has_value());
  for (int i = 0; i < 3; ++i) {
    sender.accept(flow(1, 0, 0));
    ASSERT_TRUE(sender.busy()) << "three more after a go-ahead";
  }
  sender.advance(200);
  EXPECT_EQ(sender.last_end(), TransferEnd::Silence);
}

TEST(TransferSender, takes_no_leave_while_it_streams_nor_from_what_is_no_flow_control) {
  TransferSender sender = sending(100);
  sender.advance(0);
  sender.accept({0x20});
  EXPECT_FALSE(sender.advance(0).has_value());
  sender.accept(flow(0, 0, 20));
  ASSERT_TRUE(sender.advance(0).has_value());
  sender.accept(flow(2, 0, 0));
  EXPECT_TRUE(sender.busy()) << "streaming";
  sender.accept(flow(0, 0, 0));
  EXPECT_FALSE(sender.advance(20).has_value()) << "the gap is still the first one's";
  EXPECT_TRUE(sender.advance(1).has_value());
}

TEST(TransferSender, says_how_the_last_one_ended_until_the_next_begins) {
  TransferSender sender;
  EXPECT_EQ(sender.last_end(), TransferEnd::None);
  EXPECT_FALSE(sender.busy());
  EXPECT_FALSE(sender.advance(0).has_value());
  ASSERT_TRUE(sender.start(numbered(50)));
  sender.advance(0);
  sender.accept(flow(2, 0, 0));
  EXPECT_EQ(sender.last_end(), TransferEnd::Refused);
  ASSERT_TRUE(sender.start(numbered(3)));
  EXPECT_EQ(sender.last_end(), TransferEnd::None);
  sender.cancel();
  EXPECT_FALSE(sender.busy());
  EXPECT_FALSE(sender.advance(0).has_value());
}

TEST(TransferSender, says_a_message_that_was_composed_in_its_own_room) {
  TransferSender sender = sending(50);
  const auto room = sender.compose();
  EXPECT_FALSE(sender.busy()) << "what was under way is dropped";
  ASSERT_EQ(room.size(), 256U);
  room[0] = 42;
  EXPECT_FALSE(sender.start(std::size_t{0}));
  EXPECT_FALSE(sender.start(std::size_t{257}));
  EXPECT_FALSE(sender.busy());
  EXPECT_TRUE(sender.start(std::size_t{256}));
  EXPECT_TRUE(sender.start(std::size_t{1}));
  const auto segment = sender.advance(0);
  ASSERT_TRUE(segment.has_value());
  EXPECT_EQ((*segment)[0], 1);
  EXPECT_EQ((*segment)[1], 42);
  EXPECT_FALSE(sender.start(numbered(257)));
  EXPECT_TRUE(sender.start(numbered(256)));
}

TEST(TransferSender, begins_a_second_message_with_its_first_byte_and_a_clean_count_of_waits) {
  TransferSender sender = sending(50);
  sender.advance(0);
  for (int i = 0; i < 3; ++i) sender.accept(flow(1, 0, 0));
  ASSERT_TRUE(sender.start(numbered(20)));
  const auto first = sender.advance(0);
  EXPECT_EQ((*first)[2], 1);
  sender.accept(flow(1, 0, 0));
  EXPECT_TRUE(sender.busy());
  sender.accept(flow(0, 0, 0));
  EXPECT_EQ((*sender.advance(0))[0], 0x21);
}

Payload first_of(unsigned length) {
  return {
      static_cast<std::uint8_t>(0x10U | length >> 8), static_cast<std::uint8_t>(length), 1, 2, 3, 4, 5, 6};
}
Payload next_of(unsigned number) {
  const auto n = static_cast<std::uint8_t>(number * 7);
  return {static_cast<std::uint8_t>(0x20U | (number & 0xFU)),
          n,
          std::uint8_t(n + 1),
          std::uint8_t(n + 2),
          std::uint8_t(n + 3),
          std::uint8_t(n + 4),
          std::uint8_t(n + 5),
          std::uint8_t(n + 6)};
}

TEST(TransferReceiver, at_first_has_nothing_and_waits_for_nothing) {
  TransferReceiver receiver;
  EXPECT_FALSE(receiver.busy());
  EXPECT_EQ(receiver.last_end(), TransferEnd::None);
  EXPECT_EQ(receiver.ignored(), 0U);
  EXPECT_FALSE(receiver.take().has_value());
  receiver.advance(1000);
  EXPECT_EQ(receiver.last_end(), TransferEnd::None);
}

TEST(TransferReceiver, gives_leave_at_the_start_and_after_every_eight_segments) {
  constexpr Payload kLeave{0x30, 8, 5, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC};
  TransferReceiver receiver;
  EXPECT_EQ(receiver.accept(first_of(256)), kLeave);
  EXPECT_TRUE(receiver.busy());
  for (unsigned number = 1; number <= 36; ++number) {
    const auto answer = receiver.accept(next_of(number));
    const bool last = number == 36;
    EXPECT_EQ(answer.has_value(), number % 8 == 0 && !last) << number;
    if (answer) {
      EXPECT_EQ(*answer, kLeave);
    }
    EXPECT_EQ(receiver.busy(), !last) << number;
  }
  const auto message = receiver.take();
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(Bytes(message->begin(), message->end()), numbered(256));
  EXPECT_FALSE(receiver.take().has_value()) << "once";
  EXPECT_EQ(receiver.last_end(), TransferEnd::Done);
  EXPECT_EQ(receiver.ignored(), 0U);
}

TEST(TransferReceiver, whose_last_segment_ends_a_block_gives_no_leave) {
  TransferReceiver receiver;
  receiver.accept(first_of(6 + 7 * 8));
  for (unsigned number = 1; number <= 8; ++number) EXPECT_FALSE(receiver.accept(next_of(number)).has_value());
  EXPECT_TRUE(receiver.take().has_value());
}

TEST(TransferReceiver, refuses_257_bytes_and_takes_256_and_8) {
  constexpr Payload kRefusal{0x32, 8, 5, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC};
  TransferReceiver receiver;
  EXPECT_EQ(receiver.accept(first_of(257)), kRefusal);
  EXPECT_EQ(receiver.ignored(), 1U);
  EXPECT_TRUE(receiver.accept(first_of(256)).has_value());
  EXPECT_EQ(receiver.last_end(), TransferEnd::None) << "the first one replaces nothing";
  EXPECT_TRUE(receiver.accept(first_of(8)).has_value());
  EXPECT_EQ(receiver.last_end(), TransferEnd::Replaced);
  receiver.accept(next_of(1));
  EXPECT_EQ(receiver.take()->size(), 8U);
}

TEST(TransferReceiver, gives_up_200_ms_after_the_last_segment) {
  TransferReceiver receiver;
  receiver.accept(first_of(50));
  receiver.advance(199);
  EXPECT_TRUE(receiver.busy());
  receiver.accept(next_of(1));
  receiver.advance(199);
  EXPECT_TRUE(receiver.busy());
  receiver.advance(1);
  EXPECT_FALSE(receiver.busy());
  EXPECT_EQ(receiver.last_end(), TransferEnd::Silence);
  EXPECT_FALSE(receiver.accept(next_of(2)).has_value());
  EXPECT_EQ(receiver.ignored(), 1U);
  receiver.accept({0x01, 9});
  receiver.advance(500);
  EXPECT_EQ(receiver.last_end(), TransferEnd::Done) << "a message that is whole waits for nothing more";
}

TEST(TransferReceiver, counts_what_makes_no_sense_where_it_comes) {
  TransferReceiver receiver;
  std::uint32_t ignored = 0;
  for (const Payload& segment :
       {Payload{0x00}, Payload{0x08}, Payload{0x0F}, Payload{0x10, 7}, Payload{0x10, 0}, Payload{0x20},
        Payload{0x30}, Payload{0x40}, first_of(300)}) {
    receiver.accept(segment);
    EXPECT_EQ(receiver.ignored(), ++ignored) << int{segment[0]};
  }
  receiver.accept(first_of(20));
  receiver.accept(next_of(2));
  EXPECT_EQ(receiver.ignored(), ++ignored) << "out of order";
  EXPECT_EQ(receiver.last_end(), TransferEnd::OutOfOrder);
}

TEST(TransferReceiver, takes_single_segments_of_one_to_seven_bytes) {
  for (unsigned size = 1; size <= 7; ++size) {
    TransferReceiver receiver;
    EXPECT_FALSE(receiver.accept({static_cast<std::uint8_t>(size), 1, 2, 3, 4, 5, 6, 7}).has_value());
    const auto message = receiver.take();
    ASSERT_TRUE(message.has_value());
    EXPECT_EQ(Bytes(message->begin(), message->end()), numbered(size));
    EXPECT_EQ(receiver.last_end(), TransferEnd::Done);
  }
}

TEST(TransferReceiver, drops_a_whole_message_that_nobody_took_when_another_begins) {
  TransferReceiver receiver;
  receiver.accept({0x01, 9});
  receiver.accept(first_of(20));
  EXPECT_FALSE(receiver.take().has_value());
  EXPECT_TRUE(receiver.busy());
}

TEST(TransferReceiver, that_lost_its_place_gives_nothing_out_and_begins_anew) {
  TransferReceiver receiver;
  receiver.accept(first_of(13));
  receiver.accept(next_of(2));
  EXPECT_FALSE(receiver.take().has_value());
  receiver.accept(first_of(13));
  receiver.accept(next_of(1));
  EXPECT_EQ(receiver.take()->size(), 13U);
}

TEST(TransferLimits, are_those_of_the_specification) {
  EXPECT_EQ(kMaxTransferBytes, 256U);
  EXPECT_EQ(kTransferTimeout_ms, 200);
  EXPECT_EQ(kSegmentGap_ms, 5);
  EXPECT_EQ(kSegmentOnBus_ms, 1);
  EXPECT_EQ(kBlockSize, 8);
  EXPECT_EQ(kMaxWaits, 3);
}

}  // namespace
}  // namespace pinjaw::wire

// Promises: TRANSFER.
#include "protocol/wire/transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <numeric>
#include <random>
#include <vector>

namespace pinjaw::wire {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes message_of(std::size_t size) {
  Bytes bytes(size);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  return bytes;
}

Payload segment(std::initializer_list<unsigned> bytes) {
  Payload payload{};
  std::transform(bytes.begin(), bytes.end(), payload.begin(),
                 [](unsigned b) { return static_cast<std::uint8_t>(b); });
  return payload;
}

/// Runs both machines on a perfect line, 1 ms a turn; gives what arrived.
Bytes carried(const Bytes& message, int* turns = nullptr) {
  TransferSender sender;
  TransferReceiver receiver;
  EXPECT_TRUE(sender.start(message));
  for (int turn = 0; turn < 2000; ++turn) {
    receiver.advance(1);
    if (const auto out = sender.advance(1)) {
      if (const auto flow = receiver.accept(*out)) sender.accept(*flow);
    }
    if (const auto arrived = receiver.take()) {
      if (turns != nullptr) *turns = turn;
      EXPECT_EQ(sender.last_end(), TransferEnd::Done);
      return {arrived->begin(), arrived->end()};
    }
  }
  return {};
}

TEST(Transfer, carries_every_length_from_1_to_256) {
  for (std::size_t size = 1; size <= kMaxTransferBytes; ++size)
    ASSERT_EQ(carried(message_of(size)), message_of(size));
}

TEST(Transfer, of_no_bytes_or_too_many_does_not_begin) {
  TransferSender sender;
  EXPECT_FALSE(sender.start({}));
  EXPECT_FALSE(sender.start(message_of(257)));
  EXPECT_FALSE(sender.busy());
}

TEST(Transfer, keeps_five_milliseconds_between_segments) {
  int turns = 0;
  carried(message_of(6 + 7 * 8), &turns);  // one whole block after the first segment
  EXPECT_GE(turns, 7 * kSegmentGap_ms);
}

TEST(Transfer, keeps_the_longest_gap_where_the_receiver_asks_nonsense) {
  for (const unsigned stmin : {0x7FU, 0x80U, 0xF0U, 0xFAU, 0xFFU}) {
    TransferSender sender;
    ASSERT_TRUE(sender.start(message_of(100)));
    ASSERT_TRUE(sender.advance(0).has_value());
    sender.accept(segment({0x30, 0, stmin}));
    ASSERT_TRUE(sender.advance(0).has_value());
    EXPECT_FALSE(sender.advance(126 + kSegmentOnBus_ms).has_value()) << stmin;
    EXPECT_TRUE(sender.advance(1).has_value()) << stmin;
  }
}

TEST(Transfer, gives_up_after_200_ms_of_silence_on_either_side) {
  TransferSender sender;
  ASSERT_TRUE(sender.start(message_of(50)));
  const auto first = sender.advance(0);
  TransferReceiver receiver;
  ASSERT_TRUE(receiver.accept(*first).has_value());
  sender.advance(199);
  receiver.advance(199);
  EXPECT_TRUE(sender.busy());
  EXPECT_TRUE(receiver.busy());
  sender.advance(1);
  receiver.advance(1);
  EXPECT_FALSE(sender.busy());
  EXPECT_FALSE(receiver.busy());
  EXPECT_EQ(sender.last_end(), TransferEnd::Silence);
  EXPECT_EQ(receiver.last_end(), TransferEnd::Silence);
}

TEST(TransferSender, waits_three_times_and_no_more) {
  TransferSender sender;
  ASSERT_TRUE(sender.start(message_of(50)));
  sender.advance(0);
  for (int i = 0; i < kMaxWaits; ++i) {
    sender.advance(150);
    sender.accept(segment({0x31}));
    EXPECT_TRUE(sender.busy());
  }
  sender.accept(segment({0x31}));
  EXPECT_EQ(sender.last_end(), TransferEnd::TooManyWaits);
}

TEST(TransferSender, stops_when_refused_or_answered_nonsense) {
  for (const unsigned status : {2U, 3U, 9U, 15U}) {
    TransferSender sender;
    ASSERT_TRUE(sender.start(message_of(50)));
    sender.advance(0);
    sender.accept(segment({0x30U | status}));
    EXPECT_FALSE(sender.busy());
    EXPECT_EQ(sender.last_end(), status == 2 ? TransferEnd::Refused : TransferEnd::BadFlow);
  }
}

TEST(TransferSender, ignores_flow_control_nobody_waits_for) {
  TransferSender sender;
  sender.accept(segment({0x30}));
  EXPECT_FALSE(sender.advance(1).has_value());
  ASSERT_TRUE(sender.start(message_of(50)));
  sender.accept(segment({0x32}));
  EXPECT_TRUE(sender.busy()) << "before the first segment";
}

TEST(TransferReceiver, drops_segments_whose_length_lies) {
  TransferReceiver receiver;
  for (const Payload& bad :
       {segment({0x00}), segment({0x08}), segment({0x0F}),                       // single: 0 and over 7
        segment({0x10, 0, 0, 0, 1, 0}), segment({0x10, 5}), segment({0x10, 7}),  // first: under 8
        segment({0x40}), segment({0xF1})}) {
    EXPECT_FALSE(receiver.accept(bad).has_value());
    EXPECT_FALSE(receiver.take().has_value());
    EXPECT_FALSE(receiver.busy());
  }
  EXPECT_EQ(receiver.ignored(), 8U);
}

TEST(TransferReceiver, refuses_what_has_no_room) {
  TransferReceiver receiver;
  for (const unsigned length : {257U, 300U, 4095U}) {
    const auto flow = receiver.accept(segment({0x10U | length >> 8, length & 0xFFU}));
    ASSERT_TRUE(flow.has_value());
    EXPECT_EQ((*flow)[0], 0x32);
    EXPECT_FALSE(receiver.busy());
  }
}

TEST(TransferReceiver, drops_consecutive_segments_out_of_the_blue) {
  TransferReceiver receiver;
  for (unsigned number = 0; number < 16; ++number) {
    EXPECT_FALSE(receiver.accept(segment({0x20U | number, 1, 2})).has_value());
  }
  EXPECT_FALSE(receiver.take().has_value());
}

TEST(TransferReceiver, begins_anew_with_a_new_first_or_single_segment) {
  TransferReceiver receiver;
  receiver.accept(segment({0x10, 20, 1, 2, 3, 4, 5, 6}));
  receiver.accept(segment({0x03, 7, 8, 9}));
  const auto got = receiver.take();
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(Bytes(got->begin(), got->end()), (Bytes{7, 8, 9}));
  EXPECT_FALSE(receiver.accept(segment({0x21, 1})).has_value());
  EXPECT_FALSE(receiver.take().has_value()) << "the old one is gone";
}

TEST(TransferReceiver, drops_a_transfer_with_a_segment_missing_or_doubled) {
  for (const unsigned number : {0U, 1U, 3U, 15U}) {
    TransferReceiver receiver;
    receiver.accept(segment({0x10, 30, 1, 2, 3, 4, 5, 6}));
    receiver.accept(segment({0x21}));
    EXPECT_FALSE(receiver.accept(segment({0x20U | number})).has_value());
    EXPECT_FALSE(receiver.busy());
    EXPECT_EQ(receiver.last_end(), TransferEnd::OutOfOrder);
  }
}

/// A line that loses, doubles and swaps segments.
struct BadLine {
  std::mt19937_64& engine;
  std::deque<Payload> queue;

  void put(const Payload& payload) {
    const auto dice = engine() % 100;
    if (dice < 8) return;
    queue.push_back(payload);
    if (dice < 14) queue.push_back(payload);
    if (dice < 20 && queue.size() > 1) std::swap(queue.front(), queue.back());
  }
  std::optional<Payload> get() {
    if (queue.empty() || engine() % 3 == 0) return std::nullopt;
    const Payload front = queue.front();
    queue.pop_front();
    return front;
  }
};

TEST(Transfer, over_a_bad_line_arrives_whole_or_not_at_all) {
  std::mt19937_64 engine(21);
  int arrivals = 0;
  for (int run = 0; run < 3000; ++run) {
    TransferSender sender;
    TransferReceiver receiver;
    BadLine there{engine, {}};
    BadLine back{engine, {}};
    const Bytes message = message_of(1 + engine() % kMaxTransferBytes);
    ASSERT_TRUE(sender.start(message));
    for (int turn = 0; turn < 900; ++turn) {
      if (const auto out = sender.advance(1)) there.put(*out);
      receiver.advance(1);
      if (const auto in = there.get()) {
        if (const auto flow = receiver.accept(*in)) back.put(*flow);
      }
      if (const auto flow = back.get()) sender.accept(*flow);
      if (const auto got = receiver.take()) {
        ASSERT_EQ(Bytes(got->begin(), got->end()), message);
        ++arrivals;
      }
    }
    ASSERT_FALSE(sender.busy());
    ASSERT_FALSE(receiver.busy());
  }
  EXPECT_GT(arrivals, 100);
}

TEST(Transfer, survives_random_segments) {
  std::mt19937_64 engine(22);
  TransferReceiver receiver;
  TransferSender sender;
  for (int i = 0; i < 1'000'000; ++i) {
    Payload noise = to_payload(engine());
    if (engine() % 2 == 0) noise[0] = static_cast<std::uint8_t>(0x20U | engine() % 16);
    if (engine() % 50 == 0)
      noise = segment({0x10U | static_cast<unsigned>(engine() % 2), unsigned(engine() % 256)});
    receiver.accept(noise);
    if (const auto got = receiver.take()) {
      ASSERT_LE(got->size(), kMaxTransferBytes);
    }
    if (engine() % 100 == 0) sender.start(message_of(1 + engine() % 256));
    sender.accept(noise);
    sender.advance(static_cast<std::uint16_t>(engine() % 10));
    receiver.advance(static_cast<std::uint16_t>(engine() % 10));
  }
}

}  // namespace
}  // namespace pinjaw::wire

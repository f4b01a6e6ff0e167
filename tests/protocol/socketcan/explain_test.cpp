#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <vector>

#include "protocol/socketcan/send_queue.hpp"
#include "protocol/socketcan/socket_bus.hpp"

namespace pinjaw::socketcan {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Explain, tells_the_way_out_without_can_in_the_kernel) {
  for (const int error : {EAFNOSUPPORT, EPROTONOSUPPORT}) {
    const bus::Failure failure = explain(error, "can0");
    EXPECT_EQ(failure.kind, bus::FailureKind::Unavailable);
    EXPECT_THAT(failure.message, AllOf(HasSubstr("no CAN"), HasSubstr("modprobe"),
                                       HasSubstr("tools/vcan-run"), HasSubstr("--bus sim:")));
    EXPECT_EQ(failure.message.find('\n'), std::string::npos) << "one sentence";
  }
}

TEST(Explain, names_the_interface_and_the_command_that_helps) {
  EXPECT_THAT(explain(ENODEV, "can7").message, AllOf(HasSubstr("can7"), HasSubstr("ip link add")));
  EXPECT_EQ(explain(ENETDOWN, "can7").kind, bus::FailureKind::Down);
  EXPECT_THAT(explain(ENETDOWN, "can7").message, HasSubstr("ip link set can7 up"));
  EXPECT_EQ(explain(ENOBUFS, "can7").kind, bus::FailureKind::Overflow);
  EXPECT_THAT(explain(EIO, "can7").message, AllOf(HasSubstr("can7"), HasSubstr("Input/output error")));
}

TEST(SocketBus, without_kernel_or_interface_says_so_in_a_sentence) {
  const auto opened = SocketBus::open("nosuchcan0", {});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().kind, bus::FailureKind::Unavailable);
  EXPECT_THAT(opened.error().message,
              AnyOf(HasSubstr("no CAN: load it"), HasSubstr("no CAN interface nosuchcan0")));
}

wire::Frame frame_of(std::uint32_t id, std::uint8_t mark) {
  wire::Frame frame{.id = id};
  frame.data[0] = mark;
  return frame;
}

/// A driver with room for a few frames.
struct Driver {
  int room = 0;
  std::vector<std::pair<std::uint32_t, int>> taken{};
  WriteResult write(const wire::Frame& frame) {
    if (room == 0) return WriteResult::Full;
    --room;
    taken.emplace_back(frame.id, frame.data[0]);
    return WriteResult::Taken;
  }
  SendQueue::Writer writer() {
    return [this](const wire::Frame& frame) { return write(frame); };
  }
};

TEST(SendQueue, sends_the_lowest_id_first_and_one_id_in_its_order) {
  SendQueue queue;
  Driver driver;
  for (const auto& [id, mark] : {std::pair{0x100, 1}, {0x010, 2}, {0x100, 3}, {0x060, 4}, {0x010, 5}}) {
    ASSERT_TRUE(queue.push(frame_of(static_cast<std::uint32_t>(id), static_cast<std::uint8_t>(mark)), 0));
  }
  EXPECT_EQ(queue.flush(0, driver.writer()), WriteResult::Full);
  driver.room = 3;
  EXPECT_EQ(queue.flush(0, driver.writer()), WriteResult::Full);
  driver.room = 9;
  EXPECT_EQ(queue.flush(0, driver.writer()), WriteResult::Taken);
  EXPECT_THAT(driver.taken, ElementsAre(std::pair{0x010U, 2}, std::pair{0x010U, 5}, std::pair{0x060U, 4},
                                        std::pair{0x100U, 1}, std::pair{0x100U, 3}));
}

TEST(SendQueue, drops_what_has_become_stale_and_counts_it) {
  SendQueue queue;
  Driver driver;
  ASSERT_TRUE(queue.push(frame_of(0x060, 1), 0));
  ASSERT_TRUE(queue.push(frame_of(0x060, 2), 1000));
  driver.room = 9;
  queue.flush(SendQueue::kStale_us + 1, driver.writer());
  EXPECT_THAT(driver.taken, ElementsAre(std::pair{0x060U, 2}));
  EXPECT_EQ(queue.dropped(), 1U);
}

TEST(SendQueue, is_bounded) {
  SendQueue queue;
  for (std::size_t i = 0; i < SendQueue::kMostFrames; ++i) ASSERT_TRUE(queue.push(frame_of(1, 0), 0));
  EXPECT_FALSE(queue.push(frame_of(1, 0), 0));
}

TEST(SendQueue, full_of_stale_frames_has_room_for_a_fresh_one) {
  SendQueue queue;
  for (std::size_t i = 0; i < SendQueue::kMostFrames; ++i) ASSERT_TRUE(queue.push(frame_of(1, 0), 0));
  EXPECT_TRUE(queue.push(frame_of(2, 0), SendQueue::kStale_us + 1));
  EXPECT_EQ(queue.dropped(), SendQueue::kMostFrames);
}

TEST(SendQueue, reports_a_driver_that_takes_nothing_any_more) {
  SendQueue queue;
  ASSERT_TRUE(queue.push(frame_of(1, 0), 0));
  EXPECT_EQ(queue.flush(0, [](const wire::Frame&) { return WriteResult::Failed; }), WriteResult::Failed);
}

}  // namespace
}  // namespace pinjaw::socketcan

// Promises: BUS-STRESS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "protocol/socketcan/lasting_bus.hpp"
#include "tests/protocol/socketcan/vcan.hpp"

/// What goes wrong on a CAN interface, made to go wrong on vcan: a full transmit queue (a queueing discipline
/// that is plugged, as a bus on which nobody acknowledges), a full receive buffer, error frames, and an
/// interface that goes down, away, and comes back. Each is counted and survived.
namespace pinjaw::socketcan {
namespace {

using ::testing::ElementsAreArray;

/// Whether we are root of the machine, who may have a receive buffer past net.core.rmem_max; not of a
/// namespace only.
bool is_true_root() {
  std::ifstream map("/proc/self/uid_map");
  std::uint64_t inside = 1;
  std::uint64_t outside = 1;
  std::uint64_t count = 0;
  map >> inside >> outside >> count;
  return ::geteuid() == 0 && outside == 0 && count > 1;
}

TEST(UnderStress, a_second_of_a_full_bus_waits_for_a_program_that_sleeps) {
  const auto sender = opened();
  const auto sleeper = opened();
  ASSERT_NE(sender, nullptr);
  ASSERT_NE(sleeper, nullptr);
  const std::uint64_t second =
      is_true_root() ? 500'000 / 135 : 370;  // an ordinary user has less room, but some
  for (std::uint64_t i = 0; i < second; ++i)
    ASSERT_TRUE(sender->send(frame_of(0x100, {1, 2, 3})).has_value());
  EXPECT_EQ(sleeper->statistics().lost_receiving, 0U);
  std::uint64_t kept = 0;
  while (next(*sleeper, 0).has_value()) ++kept;
  EXPECT_EQ(kept, second);
}

TEST(UnderStress, what_finds_the_receive_buffer_full_is_counted_before_the_next_frame_comes) {
  const auto sender = opened();
  const auto sleeper = opened({.receive_buffer_bytes = 20'000});
  ASSERT_NE(sender, nullptr);
  ASSERT_NE(sleeper, nullptr);
  constexpr std::uint64_t kFrames = 300;
  for (std::uint64_t i = 0; i < kFrames; ++i)
    ASSERT_TRUE(sender->send(frame_of(0x100, {1, 2, 3})).has_value());
  std::uint64_t kept = 0;
  while (next(*sleeper, 0).has_value()) ++kept;
  EXPECT_GT(kept, 0U);
  EXPECT_LT(kept, kFrames);
  EXPECT_EQ(sleeper->statistics().lost_receiving, kFrames - kept);
  EXPECT_EQ(sleeper->statistics().received, kept);
}

/// A queue before vcan0 with room for six frames that lets none through until it is opened.
class Plug {
 public:
  Plug() { run("tc qdisc add dev vcan0 root plug limit 100"); }
  ~Plug() { run("tc qdisc del dev vcan0 root"); }
  Plug(const Plug&) = delete;
  Plug& operator=(const Plug&) = delete;
  Plug(Plug&&) = delete;
  Plug& operator=(Plug&&) = delete;
  static void open() { run("tc qdisc change dev vcan0 root plug release_indefinite"); }
};

/// Ids of what comes until nothing does for a while; `sender` is called on meanwhile.
std::vector<std::uint32_t> ids_of(bus::Bus& listener, bus::Bus& sender, std::size_t count) {
  std::vector<std::uint32_t> ids;
  for (int tries = 0; tries < 2000 && ids.size() < count; ++tries) {
    EXPECT_TRUE(sender.receive().has_value());
    while (const auto received = next(listener, 0)) ids.push_back(received->frame.id);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return ids;
}

TEST(UnderStress, what_finds_the_transmit_queue_full_waits_and_leaves_the_most_urgent_first) {
  const auto bus = opened({.now_us = [] { return 0; }});  // however long this machine takes
  const auto listener = opened();
  ASSERT_NE(bus, nullptr);
  ASSERT_NE(listener, nullptr);
  std::vector<std::uint32_t> sent_first;
  {
    const Plug plug;
    for (std::uint32_t id = 0x300; bus->statistics().stalls == 0; ++id) {  // until the kernel has no room
      ASSERT_LT(id, 0x340U);
      ASSERT_TRUE(bus->send(frame_of(id, {1})).has_value());
      sent_first.push_back(id);
    }
    const std::uint32_t waits = sent_first.back();
    sent_first.pop_back();
    for (const std::uint32_t id : {0x100U, 0x010U, 0x060U})
      ASSERT_TRUE(bus->send(frame_of(id, {2})).has_value());
    EXPECT_EQ(bus->statistics().sent, sent_first.size());
    Plug::open();
    std::vector<std::uint32_t> expected = sent_first;
    expected.insert(expected.end(), {0x010, 0x060, 0x100, waits});
    EXPECT_THAT(ids_of(*listener, *bus, expected.size()), ElementsAreArray(expected));
  }
  const bus::Statistics statistics = bus->statistics();
  EXPECT_GE(statistics.stalls, 4U);
  EXPECT_EQ(statistics.sent, sent_first.size() + 4);
  EXPECT_EQ(statistics.lost_sending, 0U);
}

TEST(UnderStress, frames_that_waited_too_long_are_never_sent_and_every_loss_is_counted) {
  std::int64_t now_us = 0;
  const auto bus = opened({.now_us = [&now_us] { return now_us; }});
  const auto listener = opened();
  ASSERT_NE(bus, nullptr);
  ASSERT_NE(listener, nullptr);
  constexpr std::uint64_t kFrames = 200;
  std::uint64_t refused = 0;
  {
    const Plug plug;
    for (std::uint64_t i = 0; i < kFrames; ++i)
      refused += bus->send(frame_of(0x300, {1})).has_value() ? 0 : 1;
    EXPECT_GT(refused, 0U) << "it waits with 128 at most";
    now_us += SendQueue::kStale_us + 1;
    Plug::open();
    ASSERT_TRUE(bus->send(frame_of(0x301, {})).has_value());
  }
  std::vector<std::uint32_t> heard;
  while (const auto received = next(*listener, 100'000)) heard.push_back(received->frame.id);
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard.back(), 0x301U);
  const bus::Statistics statistics = bus->statistics();
  EXPECT_EQ(statistics.sent, heard.size());
  EXPECT_EQ(statistics.lost_sending, kFrames + 1 - heard.size());
  EXPECT_GT(statistics.lost_sending, refused);
}

TEST(UnderStress, a_controller_that_is_bus_off_says_nothing_until_it_is_restarted) {
  const auto bus = opened();
  const auto listener = opened();
  ASSERT_NE(bus, nullptr);
  ASSERT_NE(listener, nullptr);
  run("cansend vcan0 20000004#0010000000000000");  // passive
  run("cansend vcan0 20000040#0000000000000000");  // bus-off
  while (bus->statistics().error_frames < 2) ASSERT_TRUE(next(*bus).has_value());
  ASSERT_TRUE(bus->send(frame_of(0x060, {1})).has_value());
  EXPECT_EQ(bus->statistics().sent, 0U);
  run("cansend vcan0 20000100#0000000000000000");  // restarted
  while (bus->statistics().error_frames < 3) ASSERT_TRUE(next(*bus).has_value());
  ASSERT_TRUE(bus->send(frame_of(0x060, {2})).has_value());
  std::optional<bus::Received> heard;
  do {
    heard = next(*listener);
    ASSERT_TRUE(heard.has_value());
  } while (heard->frame.kind == wire::FrameKind::Error);
  EXPECT_EQ(heard->frame.id, 0x060U);
  const bus::Statistics statistics = bus->statistics();
  EXPECT_EQ(statistics.passive, 1U);
  EXPECT_EQ(statistics.bus_off, 1U);
  EXPECT_EQ(statistics.restarts, 1U);
}

TEST(UnderStress, an_interface_that_went_down_or_away_is_used_again_when_it_is_back) {
  run("ip link add dev vcan9 type vcan && ip link set vcan9 up");
  auto lasting = LastingBus::open("vcan9", {});
  ASSERT_TRUE(lasting.has_value()) << lasting.error().message;
  bus::Bus& bus = **lasting;
  const auto works = [&bus] {
    for (int tries = 0; tries < 1000; ++tries) {
      if (bus.send(frame_of(0x060, {}))) return bus.receive().has_value();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  };
  EXPECT_TRUE(works());
  run("ip link set vcan9 down");
  EXPECT_EQ(bus.send(frame_of(0x060, {})).error().kind, bus::FailureKind::Down);
  EXPECT_FALSE(bus.receive().has_value()) << "for as long as it is down";
  run("ip link set vcan9 up");
  EXPECT_TRUE(works());
  run("ip link del vcan9");
  EXPECT_FALSE(bus.receive().has_value());
  EXPECT_FALSE(bus.send(frame_of(0x060, {})).has_value());
  run("ip link add dev vcan9 type vcan && ip link set vcan9 up");
  EXPECT_TRUE(works());
  EXPECT_EQ(bus.statistics().outages, 2U);
  EXPECT_EQ(bus.statistics().sent, 3U);
  EXPECT_GE(bus.statistics().lost_sending, 2U);
  run("ip link del vcan9");
}

}  // namespace
}  // namespace pinjaw::socketcan

#include "protocol/bus/sim_bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <vector>

#include "protocol/bus/candump.hpp"
#include "protocol/bus/frame_bits.hpp"

namespace pinjaw::bus {
namespace {

using ::testing::ElementsAre;
using wire::Frame;
using wire::FrameKind;

Frame frame_of(std::uint32_t id, unsigned mark = 0) {
  Frame frame{.id = id};
  frame.data = {
      static_cast<std::uint8_t>(mark), static_cast<std::uint8_t>(mark >> 8), 0x55, 0xAA, 0x55, 0xAA, 0x55};
  return frame;
}

std::vector<Received> drained(Bus& end) {
  std::vector<Received> all;
  while (true) {
    const auto next = end.receive();
    if (!next || !*next) return all;
    all.push_back(**next);
  }
}

std::vector<std::uint32_t> ids(const std::vector<Received>& all) {
  std::vector<std::uint32_t> result;
  for (const Received& received : all) result.push_back(received.frame.id);
  return result;
}

TEST(FrameBits, are_those_of_the_standard) {
  // 47 bits without data or stuffing; an alternating pattern needs the fewest stuff bits, all zeros most.
  const Frame empty{.id = 0x555, .length = 0};
  EXPECT_GE(bits_on_bus(empty), 47);
  EXPECT_LE(bits_on_bus(empty), 47 + 8);
  Frame full{.id = 0x2AA};
  for (std::uint8_t& byte : full.data) byte = 0x55;
  EXPECT_GE(bits_on_bus(full), 111);
  for (const std::uint8_t fill : {std::uint8_t{0x00}, std::uint8_t{0xFF}}) {
    Frame worst{.id = fill == 0 ? 0U : 0x7FFU};
    worst.data.fill(fill);
    EXPECT_GT(bits_on_bus(worst), 111 + 12);
    EXPECT_LE(bits_on_bus(worst), 135) << "Davis et al. 2007: 8 bytes are at most 135 bits";
  }
}

TEST(FrameBits, never_pass_the_known_bounds) {
  std::mt19937_64 engine(1);
  for (int i = 0; i < 20'000; ++i) {
    Frame frame{.id = static_cast<std::uint32_t>(engine() & 0x7FFU),
                .length = static_cast<std::uint8_t>(engine() % 9)};
    const bool biased = engine() % 2 == 0;  // long runs need more stuff bits
    for (std::uint8_t& byte : frame.data)
      byte = static_cast<std::uint8_t>(biased ? (engine() % 2) * 0xFF : engine());
    const int plain = 47 + 8 * frame.length;
    EXPECT_GE(bits_on_bus(frame), plain);
    EXPECT_LE(bits_on_bus(frame), plain + (34 + 8 * frame.length - 1) / 4);
  }
}

TEST(SimBus, gives_a_frame_to_every_end_but_its_sender) {
  SimBus bus;
  const auto a = bus.open();
  const auto b = bus.open();
  const auto c = bus.open();
  ASSERT_TRUE(a->send(frame_of(0x100, 7)).has_value());
  bus.advance_to(1000);
  EXPECT_TRUE(drained(*a).empty());
  ASSERT_EQ(drained(*b).size(), 1U);
  const auto at_c = drained(*c);
  ASSERT_EQ(at_c.size(), 1U);
  EXPECT_EQ(at_c[0].frame, frame_of(0x100, 7));
  EXPECT_EQ(at_c[0].time_us, bits_on_bus(frame_of(0x100, 7)) * 2) << "2 us a bit at 500 kbit/s";
}

TEST(SimBus, delivers_nothing_before_its_last_bit) {
  SimBus bus;
  const auto a = bus.open();
  const auto b = bus.open();
  ASSERT_TRUE(a->send(frame_of(0x100)).has_value());
  const int end_us = bits_on_bus(frame_of(0x100)) * 2;
  bus.advance_to(end_us - 1);
  EXPECT_TRUE(drained(*b).empty());
  bus.advance_to(end_us);
  EXPECT_EQ(drained(*b).size(), 1U);
}

TEST(SimBus, lets_the_lowest_id_go_first_whoever_sends_it) {
  SimBus bus;
  const auto a = bus.open();
  const auto b = bus.open();
  const auto listener = bus.open();
  for (const std::uint32_t id : {0x300U, 0x100U}) ASSERT_TRUE(a->send(frame_of(id)).has_value());
  for (const std::uint32_t id : {0x200U, 0x010U}) ASSERT_TRUE(b->send(frame_of(id)).has_value());
  bus.advance_to(10'000);
  EXPECT_THAT(ids(drained(*listener)), ElementsAre(0x010U, 0x100U, 0x200U, 0x300U));
}

TEST(SimBus, does_not_interrupt_a_frame_under_way) {
  SimBus bus;
  const auto a = bus.open();
  const auto b = bus.open();
  const auto listener = bus.open();
  ASSERT_TRUE(a->send(frame_of(0x700)).has_value());
  bus.advance_to(50);
  ASSERT_TRUE(b->send(frame_of(0x001)).has_value());
  bus.advance_to(10'000);
  EXPECT_THAT(ids(drained(*listener)), ElementsAre(0x700U, 0x001U));
}

TEST(SimBus, puts_a_standard_id_before_the_extended_one_that_begins_alike) {
  SimBus bus;
  const auto a = bus.open();
  const auto listener = bus.open();
  Frame extended = frame_of(0x100U << 18);
  extended.extended = true;
  ASSERT_TRUE(a->send(extended).has_value());
  ASSERT_TRUE(a->send(frame_of(0x100)).has_value());
  bus.advance_to(10'000);
  const auto heard = drained(*listener);
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_FALSE(heard[0].frame.extended);
}

TEST(SimBus, keeps_the_order_of_one_id) {
  SimBus bus;
  const auto a = bus.open();
  const auto listener = bus.open();
  for (unsigned i = 0; i < 200; ++i) ASSERT_TRUE(a->send(frame_of(0x100 + i % 3, i)).has_value());
  bus.advance_to(1'000'000);
  std::map<std::uint32_t, int> last;
  const auto heard = drained(*listener);
  ASSERT_EQ(heard.size(), 200U);
  for (const Received& received : heard) {
    const int mark = received.frame.data[0];
    if (last.contains(received.frame.id)) {
      EXPECT_GT(mark, last[received.frame.id]);
    }
    last[received.frame.id] = mark;
  }
}

TEST(SimBus, refuses_more_than_its_queue_and_counts_it) {
  SimBus bus;
  const auto a = bus.open();
  int taken = 0;
  while (a->send(frame_of(0x100)).has_value()) ++taken;
  EXPECT_GE(taken, 128);
  EXPECT_EQ(a->send(frame_of(0x100)).error().kind, FailureKind::Overflow);
  EXPECT_EQ(a->statistics().lost_sending, 2U);
}

TEST(SimBus, filters_as_socketcan_does) {
  SimBus bus;
  const auto a = bus.open();
  const auto b = bus.open({{0x060, 0x7F0}});
  Frame extended = frame_of(0x061);
  extended.extended = true;
  Frame remote = frame_of(0x061);
  remote.kind = FrameKind::Remote;
  for (const Frame& frame : {frame_of(0x05F), frame_of(0x06F), extended, remote}) {
    ASSERT_TRUE(a->send(frame).has_value());
  }
  bus.inject_error(Frame{.id = 0x40, .kind = FrameKind::Error});
  bus.advance_to(10'000);
  const auto heard = drained(*b);
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_EQ(heard[0].frame.kind, FrameKind::Error);
  EXPECT_EQ(heard[1].frame.id, 0x06FU);
}

TEST(SimBus, is_silent_for_an_end_that_is_gone) {
  SimBus bus;
  auto a = bus.open();
  const auto b = bus.open();
  const auto listener = bus.open();
  ASSERT_TRUE(a->send(frame_of(0x100)).has_value());
  a.reset();
  ASSERT_TRUE(b->send(frame_of(0x101)).has_value());
  bus.advance_to(10'000);
  EXPECT_TRUE(drained(*b).empty());
  EXPECT_EQ(bus.load().frames, 1U);
}

TEST(SimBus, knows_its_load) {
  SimBus bus;
  const auto a = bus.open();
  const auto b = bus.open();
  for (int ms = 0; ms < 1000; ++ms) {
    if (ms % 2 == 0 && ms < 500) (void)a->send(frame_of(0x100));
    bus.advance_to(1000 * (ms + 1));
  }
  const double frame_us = bits_on_bus(frame_of(0x100)) * 2;
  EXPECT_NEAR(bus.load().percent(), 100 * 250 * frame_us / 1e6, 0.01);
  EXPECT_NEAR(bus.load().worst_window_percent, 2 * bus.load().percent(), 0.3);
  EXPECT_EQ(bus.load().frames, 250U);
}

struct FaultRun {
  std::vector<Received> heard;
  std::vector<std::string> log;
};

FaultRun run_with(const std::vector<Fault>& faults, std::uint64_t seed) {
  SimBus bus({.seed = seed});
  const auto a = bus.open();
  const auto b = bus.open();
  FaultRun result;
  bus.on_frame([&result](const Received& received) {
    result.log.push_back(to_log_line({received.time_us, "sim0", received.frame}));
  });
  for (const Fault& fault : faults) bus.add_fault(fault);
  for (unsigned i = 0; i < 2000; ++i) {
    (void)a->send(frame_of(0x060 + i % 2, i));
    bus.advance_to((i + 1) * 1000);
  }
  bus.advance_to(3'000'000);
  result.heard = drained(*b);
  return result;
}

TEST(SimBus, drops_its_share_in_its_window_only) {
  const FaultRun run =
      run_with({{.kind = FaultKind::Drop, .from_us = 500'000, .to_us = 1'500'000, .share = 0.2}}, 3);
  const auto lost = 2000 - run.heard.size();
  EXPECT_GT(lost, 150U);
  EXPECT_LT(lost, 250U);
  std::size_t before = 0;
  for (const Received& received : run.heard) before += received.time_us < 500'000 ? 1 : 0;
  EXPECT_EQ(before, 500U);
}

TEST(SimBus, disturbs_matching_ids_only) {
  const FaultRun run = run_with({{.kind = FaultKind::Drop, .id = 0x061, .mask = 0x7FF}}, 3);
  EXPECT_EQ(run.heard.size(), 1000U);
  for (const Received& received : run.heard) EXPECT_EQ(received.frame.id, 0x060U);
}

TEST(SimBus, doubles_corrupts_and_delays) {
  EXPECT_EQ(run_with({{.kind = FaultKind::Duplicate}}, 3).heard.size(), 4000U);
  int changed = 0;
  unsigned i = 0;
  for (const Received& received : run_with({{.kind = FaultKind::Corrupt}}, 3).heard) {
    changed += received.frame == frame_of(0x060 + i % 2, i) ? 0 : 1;
    ++i;
  }
  EXPECT_GT(changed, 1900) << "two flips may undo each other";
  const auto late = run_with({{.kind = FaultKind::Delay, .share = 0.3, .delay_us = 5000}}, 3).heard;
  EXPECT_EQ(late.size(), 2000U);
  int overtaken = 0;
  for (std::size_t k = 1; k < late.size(); ++k) {
    overtaken += late[k].frame.data[0] + 256 * late[k].frame.data[1] <
                         late[k - 1].frame.data[0] + 256 * late[k - 1].frame.data[1]
                     ? 1
                     : 0;
    EXPECT_GE(late[k].time_us, late[k - 1].time_us);
  }
  EXPECT_GT(overtaken, 100);
}

TEST(SimBus, repeats_itself_to_the_byte_for_one_seed_and_not_for_another) {
  const std::vector<Fault> faults = {{.kind = FaultKind::Drop, .share = 0.1},
                                     {.kind = FaultKind::Duplicate, .share = 0.1},
                                     {.kind = FaultKind::Corrupt, .share = 0.1},
                                     {.kind = FaultKind::Delay, .share = 0.1, .delay_us = 3000}};
  EXPECT_EQ(run_with(faults, 7).log, run_with(faults, 7).log);
  EXPECT_NE(run_with(faults, 7).log, run_with(faults, 8).log);
}

TEST(SimBus, runs_alike_however_its_time_is_cut) {
  const auto run = [](std::int64_t step_us) {
    SimBus bus;
    const auto a = bus.open();
    const auto b = bus.open();
    for (unsigned i = 0; i < 100; ++i) (void)a->send(frame_of(0x100 + i % 7, i));
    for (std::int64_t t = step_us; t <= 100'000; t += step_us) bus.advance_to(t);
    std::vector<std::string> lines;
    for (const Received& received : drained(*b))
      lines.push_back(to_log_line({received.time_us, "", received.frame}));
    return lines;
  };
  EXPECT_EQ(run(1), run(1000));
  EXPECT_EQ(run(1), run(100'000));
}

TEST(SimBus, a_frame_of_can_fd_arrives_whole_and_takes_the_time_of_a_classic_one_at_most) {
  // ISO 11898-1: 17 + 13 bits at the slow rate, 5 + 96 + 4 + 17 + 6 at four times that, and stuff bits
  wire::Frame frame{.id = 0x155, .kind = wire::FrameKind::Fd, .length = wire::kFdLength};
  frame.data.fill(0x55);
  frame.tail.fill(0x55);
  const int bits = bits_on_bus(frame);
  EXPECT_GE(bits, 30 + 32);
  EXPECT_LE(bits, 30 + 32 + 3 + (1 + 4) / 4 + 4);
  SimBus bus;
  const auto sender = bus.open();
  const auto receiver = bus.open({{.id = 0x155, .mask = 0x7FF}});
  ASSERT_TRUE(sender->send(frame));
  bus.advance_to(1000);
  const auto received = receiver->receive();
  ASSERT_TRUE(received && *received);
  EXPECT_EQ((*received)->frame, frame);
  EXPECT_NEAR(static_cast<double>((*received)->time_us), bits * 2.0, 2.0);
}

}  // namespace
}  // namespace pinjaw::bus

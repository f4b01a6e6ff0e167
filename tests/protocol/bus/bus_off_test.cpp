// Promises: BUS-OFF.
#include <gtest/gtest.h>

#include <memory>

#include "protocol/bus/error_counters.hpp"
#include "protocol/bus/frame_bits.hpp"
#include "protocol/bus/sim_bus.hpp"

namespace pinjaw::bus {
namespace {

constexpr std::uint32_t kBroken = 0x123;  // whoever sends this id is disturbed

wire::Frame plain(std::uint32_t id) {
  return {.id = id, .data = {1, 2, 3, 4, 5, 6, 7, 8}};
}

std::size_t waiting_at(Bus& end) {
  std::size_t count = 0;
  for (auto next = end.receive(); next && *next; next = end.receive()) ++count;
  return count;
}

/// A bus on which every frame of one id is destroyed until `to_us`.
struct BrokenBus {
  explicit BrokenBus(std::int64_t to_us) {
    bus.add_fault({.kind = FaultKind::Destroy, .to_us = to_us, .id = kBroken, .mask = 0x7FF});
  }
  SimBus bus;
  std::unique_ptr<Bus> a = bus.open();
  std::unique_ptr<Bus> b = bus.open();
};

TEST(ErrorCounters, follow_the_standard) {
  ErrorCounters counters;
  for (int i = 0; i < 15; ++i) counters.sending_failed();
  EXPECT_FALSE(counters.passive());
  counters.sending_failed();
  EXPECT_TRUE(counters.passive()) << "128";
  counters.sent();
  EXPECT_FALSE(counters.passive()) << "127";
  for (int i = 0; i < 16; ++i) counters.sending_failed();
  EXPECT_FALSE(counters.off()) << "255";
  counters.sending_failed();
  EXPECT_TRUE(counters.off());
  EXPECT_FALSE(counters.passive()) << "off is neither";
}

TEST(ErrorCounters, of_a_receiver_lead_to_passive_and_never_off) {
  ErrorCounters counters;
  for (int i = 0; i < 1000; ++i) counters.receiving_failed();
  EXPECT_TRUE(counters.passive());
  EXPECT_FALSE(counters.off());
  counters.received();
  EXPECT_FALSE(counters.passive());
  EXPECT_EQ(counters.receiving(), 127);
}

TEST(BusOff, a_lone_sender_waits_for_company_and_stays_on_the_bus) {
  SimBus bus;
  const auto alone = bus.open();
  ASSERT_TRUE(alone->send(plain(0x100)).has_value());
  bus.advance_to(1'000'000);
  EXPECT_TRUE(alone->health().passive);
  EXPECT_FALSE(alone->health().off);
  EXPECT_EQ(alone->statistics().sent, 0U);
  EXPECT_GT(alone->statistics().unacknowledged, 1000U);
  const auto company = bus.open();
  bus.advance_to(1'001'000);
  EXPECT_EQ(waiting_at(*company), 1U);
  EXPECT_EQ(alone->statistics().sent, 1U);
}

TEST(BusOff, comes_with_the_32nd_frame_that_an_error_destroys) {
  BrokenBus broken(1'000'000);
  ASSERT_TRUE(broken.a->send(plain(kBroken)).has_value());
  const std::int64_t try_us = (bits_on_bus(plain(kBroken)) + 20) * 2;
  broken.bus.advance_to(15 * try_us);
  EXPECT_FALSE(broken.a->health().passive);
  broken.bus.advance_to(16 * try_us + 20);
  EXPECT_TRUE(broken.a->health().passive);
  broken.bus.advance_to(31 * try_us);
  EXPECT_FALSE(broken.a->health().off);
  broken.bus.advance_to(34 * try_us);
  EXPECT_TRUE(broken.a->health().off);
  EXPECT_FALSE(broken.b->health().off);
  EXPECT_FALSE(broken.b->health().passive) << "who only listens has counted 32";
  EXPECT_EQ(broken.a->statistics().bus_off, 1U);
  EXPECT_EQ(broken.a->statistics().lost_sending, 1U);
}

TEST(BusOff, sends_and_hears_nothing_and_lasts_without_a_restart) {
  BrokenBus broken(20'000);
  ASSERT_TRUE(broken.a->send(plain(kBroken)).has_value());
  broken.bus.advance_to(20'000);
  ASSERT_TRUE(broken.a->health().off);
  EXPECT_FALSE(broken.a->send(plain(0x100)).has_value());
  const auto c = broken.bus.open();
  ASSERT_TRUE(broken.b->send(plain(0x200)).has_value());
  broken.bus.advance_to(1'000'000);
  EXPECT_EQ(waiting_at(*broken.a), 0U);
  EXPECT_EQ(waiting_at(*c), 1U);
  EXPECT_TRUE(broken.a->health().off);
}

TEST(BusOff, ends_after_128_times_11_recessive_bits) {
  BrokenBus broken(20'000);
  ASSERT_TRUE(broken.a->send(plain(kBroken)).has_value());
  broken.bus.advance_to(20'000);
  ASSERT_TRUE(broken.a->health().off);
  broken.a->restart();
  constexpr std::int64_t kRecovery_us = 128 * 11 * 2;
  broken.bus.advance_to(20'000 + kRecovery_us - 1);
  EXPECT_TRUE(broken.a->health().off);
  broken.bus.advance_to(20'000 + kRecovery_us);
  EXPECT_FALSE(broken.a->health().off);
  EXPECT_FALSE(broken.a->health().passive);
  ASSERT_TRUE(broken.a->send(plain(kBroken)).has_value());
  broken.bus.advance_to(30'000);
  EXPECT_EQ(waiting_at(*broken.b), 1U);
  EXPECT_EQ(broken.a->statistics().restarts, 1U);
}

TEST(BusOff, takes_as_many_frames_to_end_on_a_bus_that_is_never_idle) {
  BrokenBus broken(20'000);
  const auto c = broken.bus.open();
  ASSERT_TRUE(broken.a->send(plain(kBroken)).has_value());
  broken.bus.advance_to(20'000);
  for (int i = 0; i < 250; ++i) ASSERT_TRUE(broken.b->send(plain(0x200)).has_value());
  broken.bus.advance_to(20'001);
  broken.a->restart();
  const std::int64_t frame_us = bits_on_bus(plain(0x200)) * 2;
  broken.bus.advance_to(20'000 + 126 * frame_us);
  EXPECT_TRUE(broken.a->health().off);
  broken.bus.advance_to(20'000 + 131 * frame_us);
  EXPECT_FALSE(broken.a->health().off);
}

TEST(BusOff, is_the_same_however_time_is_cut) {
  const auto recovered_at_us = [](std::int64_t step_us) {
    BrokenBus broken(20'000);
    (void)broken.a->send(plain(kBroken));
    std::int64_t now_us = 0;
    for (; now_us < 20'000; now_us += step_us) broken.bus.advance_to(now_us + step_us);
    broken.a->restart();
    for (int i = 0; i < 20; ++i) (void)broken.b->send(plain(0x200));
    while (broken.a->health().off && now_us < 100'000) broken.bus.advance_to(now_us += step_us);
    return now_us;
  };
  const std::int64_t fine_us = recovered_at_us(1);
  const std::int64_t coarse_us = recovered_at_us(1000);
  EXPECT_GE(coarse_us, fine_us);
  EXPECT_LT(coarse_us, fine_us + 1000);
}

TEST(BusOff, spares_who_sends_other_frames) {
  BrokenBus broken(1'000'000);
  ASSERT_TRUE(broken.a->send(plain(kBroken)).has_value());
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(broken.b->send(plain(0x100)).has_value());
  const auto c = broken.bus.open();
  broken.bus.advance_to(100'000);
  EXPECT_TRUE(broken.a->health().off);
  EXPECT_EQ(waiting_at(*c), 5U);
}

}  // namespace
}  // namespace pinjaw::bus

// Promises: BUS-STRESS.
#include "protocol/socketcan/lasting_bus.hpp"

#include <gtest/gtest.h>

namespace pinjaw::socketcan {
namespace {

using bus::FailureKind;

/// An interface that the test takes away and gives back, and the time.
struct Interface {
  bool up = true;
  bool full = false;
  int opened = 0;
  int tried = 0;
  std::int64_t now_us = 0;

  [[nodiscard]] bus::Failure why() const { return {FailureKind::Down, "it is down"}; }
};

class InterfaceBus final : public bus::Bus {
 public:
  explicit InterfaceBus(Interface& interface) : interface_(&interface) { ++interface_->opened; }
  bus::Expected<void> send(const wire::Frame& /*frame*/) override {
    if (interface_->full) return tl::unexpected(bus::Failure{FailureKind::Overflow, "full"});
    if (!interface_->up) return tl::unexpected(interface_->why());
    ++statistics_.sent;
    return {};
  }
  bus::Expected<std::optional<bus::Received>> receive() override {
    if (!interface_->up) return tl::unexpected(interface_->why());
    return std::nullopt;
  }
  [[nodiscard]] bus::Statistics statistics() const override { return statistics_; }

 private:
  Interface* interface_;
  bus::Statistics statistics_;
};

std::unique_ptr<LastingBus> lasting(Interface& interface) {
  const auto open = [&interface]() -> bus::Expected<std::unique_ptr<bus::Bus>> {
    ++interface.tried;
    if (!interface.up) return tl::unexpected(interface.why());
    return std::make_unique<InterfaceBus>(interface);
  };
  return std::make_unique<LastingBus>(*open(), open, [&interface] { return interface.now_us; });
}

TEST(LastingBus, is_the_bus_it_has_while_that_works) {
  Interface interface;
  const auto bus = lasting(interface);
  EXPECT_TRUE(bus->send({}).has_value());
  EXPECT_TRUE(bus->receive().has_value());
  EXPECT_EQ(interface.opened, 1);
  EXPECT_EQ(bus->statistics().sent, 1U);
  EXPECT_EQ(bus->statistics().outages, 0U);
}

TEST(LastingBus, a_full_queue_is_no_outage) {
  Interface interface;
  const auto bus = lasting(interface);
  interface.full = true;
  EXPECT_EQ(bus->send({}).error().kind, FailureKind::Overflow);
  EXPECT_EQ(bus->statistics().outages, 0U);
}

TEST(LastingBus, opens_anew_when_the_interface_is_back_and_counts_what_was_lost_meanwhile) {
  Interface interface;
  const auto bus = lasting(interface);
  ASSERT_TRUE(bus->send({}).has_value());
  interface.up = false;
  EXPECT_FALSE(bus->receive().has_value());
  EXPECT_FALSE(bus->send({}).has_value());
  EXPECT_EQ(bus->send({}).error().message, "it is down");
  EXPECT_TRUE(bus->health().off);
  interface.up = true;
  EXPECT_FALSE(bus->receive().has_value()) << "not before the next try";
  interface.now_us += LastingBus::kRetry_us;
  EXPECT_TRUE(bus->send({}).has_value());
  EXPECT_EQ(interface.opened, 2);
  EXPECT_FALSE(bus->health().off);
  const bus::Statistics statistics = bus->statistics();
  EXPECT_EQ(statistics.sent, 2U) << "those of the first bus too";
  EXPECT_EQ(statistics.lost_sending, 2U);
  EXPECT_EQ(statistics.outages, 1U);
}

TEST(LastingBus, tries_ten_times_a_second_however_often_it_is_asked) {
  Interface interface;
  const auto bus = lasting(interface);
  interface.up = false;
  const int before = interface.tried;
  for (int ms = 0; ms < 1000; ++ms, interface.now_us += 1000) EXPECT_FALSE(bus->receive().has_value());
  EXPECT_EQ(interface.tried - before, 9) << "the first after 100 ms";
  EXPECT_EQ(bus->statistics().outages, 1U) << "an interface that stays away is gone once";
}

}  // namespace
}  // namespace pinjaw::socketcan

// Promises: TELEMETRY, I9.
#include <gtest/gtest.h>

#include <map>

#include "tests/firmware_sim/core/bench.hpp"

namespace pinjaw::core::test {
namespace {

/// Times at which the arm said each message.
std::map<wire::MessageType, std::vector<int>> said_in(Bench& bench, int ms) {
  std::map<wire::MessageType, std::vector<int>> said;
  bench.after_step = [&] {
    for (const wire::Frame& frame : bench.heard) {
      const auto identifier = wire::identify(frame);
      if (identifier && identifier->node == kArm) said[identifier->type].push_back(bench.now_ms);
    }
  };
  bench.run(ms);
  bench.after_step = nullptr;
  return said;
}

TEST(Telemetry, keeps_every_period) {
  Bench bench;
  bench.load_all();
  auto said = said_in(bench, 2000);
  EXPECT_EQ(said[wire::MessageType::State].size(), 100U);
  EXPECT_EQ(said[wire::MessageType::Force].size(), 100U);
  EXPECT_EQ(said[wire::MessageType::Custody].size(), 20U);
  EXPECT_EQ(said[wire::MessageType::Pneumatics].size(), 20U);
  EXPECT_EQ(said[wire::MessageType::LayoutStatus].size(), 4U);
  EXPECT_EQ(said[wire::MessageType::Identity].size(), 2U);
  EXPECT_EQ(said[wire::MessageType::Fault].size(), 0U);
}

TEST(Telemetry, puts_force_half_a_period_after_state) {
  Bench bench;
  bench.load_all();
  auto said = said_in(bench, 100);
  EXPECT_EQ((said[wire::MessageType::Force][0] - said[wire::MessageType::State][0] + 20) % 20, 10);
}

TEST(Telemetry, says_custody_faster_in_a_handoff) {
  Bench bench;
  bench.load_all();
  bench.load_gripper(kArm);
  bench.command(kArm, wire::offer_command(kPedestal));
  EXPECT_GE(said_in(bench, 200)[wire::MessageType::Custody].size(), 10U);
}

TEST(Telemetry, identifies_itself_at_boot) {
  Bench bench;
  EXPECT_EQ(said_in(bench, 120)[wire::MessageType::Identity].size(), 5U);
}

TEST(Telemetry, reports_a_fault_at_once_then_every_100_ms_then_its_end) {
  Bench bench;
  bench.load_all();
  bench.arm().jaw.supply_mbar = 3000;
  bench.run(49);
  const auto said = said_in(bench, 300);
  const auto fault = said.find(wire::MessageType::Fault);
  ASSERT_NE(fault, said.end());
  EXPECT_GE(fault->second.size(), 3U);
  bench.arm().jaw.supply_mbar = 6000;
  bool ended = false;
  bench.after_step = [&] {
    for (const wire::Frame& frame : bench.heard) {
      const auto report = wire::parse<wire::FaultReport>(frame);
      ended = ended || (report && report->label.node == kArm && !report->message.active &&
                        report->message.code == wire::FaultCode::SupplyAirLow);
    }
  };
  bench.run(100);
  EXPECT_TRUE(ended);
}

TEST(Telemetry, says_force_as_an_interval) {
  Bench bench;
  bench.load_all();
  bench.load_gripper(kArm);
  std::optional<wire::Force> force;
  std::optional<wire::NodeState> status;
  bench.after_step = [&] {
    for (const wire::Frame& frame : bench.heard) {
      if (const auto said = wire::parse<wire::Force>(frame); said && said->label.node == kArm)
        force = said->message;
      if (const auto said = wire::parse<wire::NodeState>(frame); said && said->label.node == kArm) {
        status = said->message;
      }
    }
  };
  bench.run(60);
  ASSERT_TRUE(force && status);
  EXPECT_EQ(*force->f_high_dn - *force->f_measured_dn, 120);
  EXPECT_EQ(*force->f_measured_dn - *status->f_low_dn, 120);
  EXPECT_EQ(force->f_limit_effective_dn, 1400);
  EXPECT_TRUE(status->hold_stable);
  EXPECT_TRUE(status->part);
  EXPECT_EQ(status->custody, wire::Fact::Sole);
}

TEST(Telemetry, counts_without_gaps) {
  Bench bench;
  bench.load_all();
  std::optional<std::uint8_t> last;
  bench.after_step = [&] {
    for (const wire::Frame& frame : bench.heard) {
      const auto said = wire::parse<wire::NodeState>(frame);
      if (!said || said->label.node != kArm) continue;
      ASSERT_EQ(said->label.counter, (last.value_or((said->label.counter + 14) % 15) + 1) % 15);
      last = said->label.counter;
    }
  };
  bench.run(1000);
}

TEST(Telemetry, of_another_node_with_its_own_id_is_noticed) {
  Bench bench;
  bench.load_all();
  Station& arm = bench.arm();
  arm.step({wire::pack(wire::NodeState{}, {.node = kArm, .counter = 1})});
  EXPECT_TRUE(arm.core.faults.active(wire::FaultCode::OwnIdSeen));
}

TEST(Telemetry, state_fits_in_a_microcontroller) {
  RecordProperty("state_bytes", static_cast<int>(sizeof(State)));
  EXPECT_LE(sizeof(State), 4096U);
  EXPECT_LE(sizeof(Outputs), 2048U);
}

}  // namespace
}  // namespace pinjaw::core::test

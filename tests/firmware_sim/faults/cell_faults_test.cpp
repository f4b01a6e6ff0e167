// Promises: HANDOFFS, BABBLE, BUS-OFF.
//
// The whole cell, with its pneumatics and its bus of arbitration and error counters, under what goes wrong on
// a bus. The oracle is the world's truth of the part.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "protocol/wire/names.hpp"
#include "tests/firmware_sim/faults/by_hold.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/nightly.hpp"

namespace pinjaw::world {
namespace {

using test::by_hold;
using test::TestCell;
using wire::CommandResult;
using wire::State;

constexpr double kLimit_n = 100;    // of every layout, under what the grippers can do
constexpr double kDynamic = 1.05;   // I1
constexpr int kRelaxed_ms = 150;    // of 200: there is something to squeeze again
constexpr int kHandoff_ms = 10000;  // chosen: far longer than it takes

std::vector<test::TestGrip> limited_grips() {
  std::vector<test::TestGrip> grips = test::arm_pedestal_pallet();
  for (test::TestGrip& grip : grips) grip.limit_n = kLimit_n;
  return grips;
}

/// A node in a state of a handoff from the arm to the pedestal.
struct Point {
  int node = 1;
  State state = State::Hold;
};
constexpr Point kPoints[] = {
    {1, State::Hold},  {1, State::Offered}, {1, State::Relax},  {1, State::Resqueeze}, {1, State::Opening},
    {2, State::Ready}, {2, State::Seating}, {2, State::Seated}, {2, State::Squeezing}, {2, State::Taken}};

/// A cell whose arm holds the part.
class HoldingCell {
 public:
  explicit HoldingCell(std::uint64_t seed = 1) : cell(limited_grips(), seed) {
    EXPECT_TRUE(cell.commission()) << cell.event_log();
    EXPECT_TRUE(cell.load(1)) << cell.event_log();
    listener_ = cell.bus().open();
  }

  const core::State& firmware(int node) { return cell.world().find(node)->firmware(); }
  bool is(int node, State state) { return firmware(node).id == state; }
  bool asks(int node, const wire::Command& command) {
    return cell.command(node, command).result == CommandResult::Ok;
  }

  void expect_held(const std::string& when) {
    const bench::Truth truth = cell.truth();
    EXPECT_FALSE(truth.dropped) << when;
    EXPECT_FALSE(truth.slipped) << when;
    EXPECT_GE(truth.min_holders.value_or(0), 1) << when;
    for (const bench::NodeTruth& node : truth.nodes) {
      EXPECT_LE(node.max_steady_n, kLimit_n) << when << ", node " << node.node;
      EXPECT_LE(node.max_squeeze_n, kDynamic * kLimit_n) << when << ", node " << node.node;
    }
  }

  /// What crossed the bus since the last call.
  std::vector<bus::Received> heard() {
    std::vector<bus::Received> all;
    for (auto next = listener_->receive(); next && *next; next = listener_->receive()) all.push_back(**next);
    return all;
  }

  /// From the arm to the pedestal, until `done` says so.
  bool hand_over_until(const std::function<bool()>& done) {
    if (done()) return true;
    cell.ask(bench::Meet{{1, 2}});
    if (!asks(1, wire::offer_command(2))) return false;
    if (done() || cell.run_until(done, 100)) return true;
    if (!asks(2, wire::accept_command(1))) return false;
    if (!cell.run_until([&] { return done() || is(2, State::Seated); }, 3000)) return false;
    if (done()) return true;
    return cell.squeeze(2) && cell.run_until(done, kHandoff_ms);
  }

  /// The same, as far as `point`.
  bool hand_over_to(const Point& point) {
    const auto there = [&] { return is(point.node, point.state); };
    if (point.state != State::Resqueeze) return hand_over_until(there);
    if (!hand_over_until([&] { return is(1, State::Relax); })) return false;
    cell.run_ms(kRelaxed_ms);
    return asks(1, wire::plain_command(wire::Op::Abort)) && there();
  }

  TestCell cell;

 private:
  std::unique_ptr<bus::Bus> listener_;
};

/// A node that sends frames of one id without end.
class Babbler {
 public:
  Babbler(HoldingCell& holding, std::uint32_t id)
      : holding_(holding), end_(holding.cell.bus().open()), id_(id) {}

  /// As many as the bus takes: a frame of 8 bytes lasts 0.22 ms at least.
  void run_ms(int duration_ms) {
    for (int i = 0; i < duration_ms; ++i) step();
  }
  void step() {
    top_up();
    holding_.cell.advance();
  }
  void top_up() {
    const auto sent = end_->statistics().sent;
    while (given_ < sent + 8) {
      (void)end_->send({.id = id_, .data = {0x55, 0xAA, 0x55, 0xAA, 0x55, 0xAA, 0x55, 0xAA}});
      ++given_;
    }
    while (*end_->receive()) {
    }
  }

 private:
  HoldingCell& holding_;
  std::unique_ptr<bus::Bus> end_;
  std::uint32_t id_;
  std::uint64_t given_ = 0;
};

TEST(Babbler, with_the_highest_priority_takes_the_whole_bus_and_the_part_stays_held) {
  HoldingCell holding;
  {
    Babbler babbler(holding, 0x000);
    babbler.run_ms(10);
    holding.heard();
    babbler.run_ms(1500);
    const auto others = holding.heard();
    EXPECT_TRUE(std::ranges::all_of(others, [](const auto& each) { return each.frame.id == 0; }));
    EXPECT_GT(others.size(), 1500U * 4) << "the bus was full";
    EXPECT_TRUE(holding.is(1, State::Hold));
    holding.expect_held("while it babbles");
  }
  holding.cell.run_ms(1000);
  std::map<std::uint32_t, int> reports;
  for (const auto& each : holding.heard()) ++reports[each.frame.id];
  for (const std::uint32_t node : {1U, 2U, 3U}) {
    EXPECT_GT(reports[0x060 + node], 20) << "STATE of " << node << " within 1 s";
    EXPECT_GT(reports[0x040 + node], 4) << "CUSTODY of " << node << " within 1 s";
    EXPECT_TRUE(holding.firmware(static_cast<int>(node)).host.alive());
  }
  holding.expect_held("after it");
  EXPECT_TRUE(holding.cell.arm(1) && holding.cell.arm(2) && holding.cell.hand_over(1, 2)) << "work goes on";
  holding.expect_held("in the end");
}

TEST(Babbler, with_the_highest_priority_at_any_point_of_a_handoff_drops_nothing) {
  for (const Point& point : kPoints) {
    HoldingCell holding;
    ASSERT_TRUE(holding.hand_over_to(point)) << wire::to_string(point.state);
    {
      Babbler babbler(holding, 0x000);
      babbler.run_ms(600);
    }
    holding.cell.run_ms(1500);
    holding.expect_held(wire::to_string(point.state));
    EXPECT_TRUE(core::holds(holding.firmware(1).id) || core::holds(holding.firmware(2).id))
        << wire::to_string(point.state);
  }
}

TEST(Babbler, with_the_lowest_priority_makes_no_deadline_late) {
  HoldingCell holding;
  Babbler babbler(holding, 0x7FF);
  babbler.run_ms(50);
  holding.heard();
  ASSERT_TRUE(holding.hand_over_until([&] {
    babbler.top_up();
    return holding.is(2, State::Hold) && holding.is(1, State::Ready);
  }));
  babbler.run_ms(500);
  std::map<std::uint32_t, std::int64_t> last_us;
  std::map<std::uint32_t, std::int64_t> longest_us;
  for (const auto& each : holding.heard()) {
    const std::uint32_t id = each.frame.id;
    if (last_us.contains(id)) longest_us[id] = std::max(longest_us[id], each.time_us - last_us[id]);
    last_us[id] = each.time_us;
    const auto fault = wire::parse<wire::FaultReport>(each.frame);
    const bool late = fault && fault->message.active &&
                      (fault->message.code == wire::FaultCode::HostLost ||
                       fault->message.code == wire::FaultCode::PeerLost);
    EXPECT_FALSE(late) << "node " << int{fault->label.node};
  }
  constexpr std::int64_t kSlack_us = 4000;  // the worst response time of STATE among three nodes, section 2.3
  for (const std::uint32_t node : {1U, 2U, 3U}) EXPECT_LE(longest_us[0x060 + node], 20'000 + kSlack_us);
  EXPECT_LE(longest_us[0x0F0], 50'000 + 5100);
  EXPECT_GT(holding.cell.bus().load().worst_window_percent, 97);
  holding.expect_held("all the time");
  pinjaw::test::figure("BABBLE", "longest gap between two STATE frames at 100 % load of id 0x7FF",
                       static_cast<double>(longest_us[0x061]) * 1e-3, "ms");
}

TEST(Flood, of_valid_commands_loosens_nothing_and_silences_nobody) {
  HoldingCell holding;
  const auto host = holding.cell.bus().open();
  holding.heard();
  int given = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    const core::State& arm = holding.firmware(1);
    for (int i = 0; i < 3; ++i, ++given) {
      const auto sequence = static_cast<std::uint8_t>(arm.gate.next_sequence() + i);
      wire::Command command = given % 2 == 0 ? wire::offer_command(2) : wire::plain_command(wire::Op::Abort);
      command.session = arm.gate.session();
      command.sequence = sequence;
      if (!arm.gate.armed() || sequence > 250) {
        command = wire::arm_command(arm.layouts.crc, 0x1234);
        command.sequence = static_cast<std::uint8_t>(given);
      }
      (void)host->send(wire::pack(command, {.node = 1}));
    }
    holding.cell.advance();
  }
  std::int64_t last_us = 0;
  std::int64_t longest_us = 0;
  for (const auto& each : holding.heard()) {
    if (each.frame.id != 0x061) continue;
    if (last_us != 0) longest_us = std::max(longest_us, each.time_us - last_us);
    last_us = each.time_us;
  }
  EXPECT_LE(longest_us, 24'000) << "STATE comes before commands";
  EXPECT_TRUE(core::grips(holding.firmware(1).id));
  holding.cell.run_ms(1000);
  holding.expect_held("through the flood");
}

/// Every frame of a node is destroyed until its controller is off the bus; false where it never is.
bool drive_off(HoldingCell& holding, std::uint32_t node) {
  constexpr int kMost_ms = 100;
  for (int ms = 0; ms < kMost_ms; ++ms) {
    const std::int64_t now_us = std::int64_t{1000} * holding.cell.now_ms();
    holding.cell.bus().add_fault({.kind = bus::FaultKind::Destroy,
                                  .from_us = now_us,
                                  .to_us = now_us + 1000,
                                  .id = node,
                                  .mask = 0x60F});
    holding.cell.advance();
    if (holding.firmware(static_cast<int>(node)).bus.off()) return true;
  }
  return false;
}

bool says_fault(const std::vector<bus::Received>& heard, int node, wire::FaultCode code) {
  return std::ranges::any_of(heard, [&](const bus::Received& each) {
    const auto fault = wire::parse<wire::FaultReport>(each.frame);
    return fault && fault->label.node == node && fault->message.code == code;
  });
}

TEST(BusOff, of_a_holder_holds_and_is_told_after_recovery) {
  HoldingCell holding;
  ASSERT_TRUE(drive_off(holding, 1));
  EXPECT_TRUE(holding.is(1, State::Hold));
  holding.heard();
  holding.cell.run_ms(1000);
  EXPECT_FALSE(holding.firmware(1).bus.off());
  const auto heard = holding.heard();
  EXPECT_TRUE(says_fault(heard, 1, wire::FaultCode::BusOffRecovered));
  EXPECT_TRUE(std::ranges::any_of(heard, [](const auto& each) { return each.frame.id == 0x061; }));
  EXPECT_TRUE(holding.firmware(1).host.alive()) << "qualified anew";
  holding.expect_held("through bus-off");
}

TEST(BusOff, of_either_at_any_point_of_a_handoff_drops_nothing) {
  for (const Point& point : kPoints) {
    for (const std::uint32_t broken : {1U, 2U}) {
      HoldingCell holding;
      const std::string when =
          std::string(wire::to_string(point.state)) + ", broken " + std::to_string(broken);
      ASSERT_TRUE(holding.hand_over_to(point)) << when;
      ASSERT_TRUE(drive_off(holding, broken)) << when;
      const bool itself = static_cast<int>(broken) == point.node;
      EXPECT_TRUE(holding.is(point.node, itself ? by_hold(point.state) : point.state))
          << when << ": the state was over before it fell off";
      holding.cell.run_ms(2500);
      holding.expect_held(when);
      EXPECT_TRUE(core::holds(holding.firmware(1).id) || core::holds(holding.firmware(2).id)) << when;
    }
  }
}

TEST(BusOff, for_the_fourth_time_in_ten_seconds_lasts_and_the_part_stays_held) {
  HoldingCell holding;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(drive_off(holding, 1));
    holding.cell.run_ms(500);
    EXPECT_FALSE(holding.firmware(1).bus.off()) << "recovery " << i;
  }
  ASSERT_TRUE(drive_off(holding, 1));
  holding.cell.run_ms(15'000);
  EXPECT_TRUE(holding.firmware(1).bus.off()) << "not even once the ten seconds are over";
  EXPECT_TRUE(holding.is(1, State::Hold));
  holding.expect_held("off the bus");
}

/// Handoffs to and fro between two grippers on a bus that loses, doubles and delays.
class BadLine {
 public:
  explicit BadLine(std::uint64_t seed) : holding_(seed) {
    auto& bus = holding_.cell.bus();
    bus.add_fault({.kind = bus::FaultKind::Drop, .share = 0.2});
    bus.add_fault({.kind = bus::FaultKind::Duplicate, .share = 0.02});
    bus.add_fault({.kind = bus::FaultKind::Delay, .share = 0.02, .delay_us = 30'000});
  }

  bool hand_over() {
    constexpr int kTries = 100;
    const int to = 3 - holder_;
    for (int i = 0; i < kTries && !over(to); ++i) attempt(to);
    if (!over(to)) return false;
    holder_ = to;
    return true;
  }
  HoldingCell& holding() { return holding_; }

 private:
  static bool is_free(State state) { return state == State::Ready || state == State::Loaded; }
  bool over(int to) { return holding_.is(to, State::Hold) && is_free(holding_.firmware(holder_).id); }

  void attempt(int to) {
    TestCell& cell = holding_.cell;
    settle(to);
    if (over(to) || !cell.arm(holder_) || !cell.arm(to)) return;
    cell.ask(bench::Meet{{holder_, to}});
    if (!holding_.asks(holder_, wire::offer_command(static_cast<std::uint8_t>(to)))) return;
    cell.run_ms(60);
    if (!holding_.asks(to, wire::accept_command(static_cast<std::uint8_t>(holder_)))) return;
    if (!cell.run_until([&] { return holding_.is(to, State::Seated); }, 3000) || !cell.squeeze(to)) return;
    cell.run_until([&] { return over(to); }, 4000);
  }

  void settle(int to) {
    TestCell& cell = holding_.cell;
    for (int i = 0; i < 20; ++i) {
      const State giver = holding_.firmware(holder_).id;
      const State receiver = holding_.firmware(to).id;
      const bool open = cell.truth_of(to).squeeze_n < 1;
      if (over(to) || (giver == State::Hold && is_free(receiver) && open)) return;
      if (giver == State::Offered) holding_.asks(holder_, wire::plain_command(wire::Op::Abort));
      if (receiver != State::Hold && receiver != State::Taken) {
        cell.arm(to);
        holding_.asks(to, wire::plain_command(wire::Op::Abort));
      }
      cell.run_ms(300);
    }
  }

  HoldingCell holding_;
  int holder_ = 1;
};

TEST(BadLine, drops_nothing_and_every_handoff_ends_on_the_true_plant) {
  const int handoffs = pinjaw::test::by_night(300, 3);
  BadLine line(11);
  for (int i = 0; i < handoffs; ++i) {
    ASSERT_TRUE(line.hand_over()) << "stuck in handoff " << i << "\n"
                                  << line.holding().cell.event_log().substr(0, 2000);
    line.holding().expect_held("handoff " + std::to_string(i));
    if (testing::Test::HasFailure()) return;
  }
  pinjaw::test::figure("HANDOFFS", "random handoffs on the true plant, none dropped or stuck", handoffs,
                       "handoffs");
}

}  // namespace
}  // namespace pinjaw::world

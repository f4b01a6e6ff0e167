// Promises: BUS-STRESS.
// A controller that holds a part while its bus goes wrong: the interface goes down, away and comes back, its
// CAN controller is bus-off, its transmit queue is plugged, it is stopped and overrun, another speaks under
// its number. It holds on, tells and counts it, and is there again afterwards.
#include "protocol/wire/codec.hpp"
#include "tests/firmware_sim/app/live_jaw.hpp"

namespace pinjaw::jaw_app {
namespace {

using test::shell;

class JawInTrouble : public Holding {
 protected:
  /// Frames of the node that come within a while.
  int frames_of_node(std::chrono::milliseconds duration) {
    int frames = 0;
    const auto until = Clock::now() + duration;
    while (Clock::now() < until) {
      const auto received = bus_->receive();
      if (!received) return frames;
      if (!*received) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (*received && (*received)->frame.id == kStateId) ++frames;
    }
    return frames;
  }

  bool tells(const std::string& text) {
    for (int tries = 0; tries < 1000; ++tries) {
      if (said().find(text) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ADD_FAILURE() << "no \"" << text << "\" in: " << said();
    return false;
  }

  static constexpr std::uint32_t kStateId = wire::id_of({wire::MessageType::State, 1});
};

TEST_F(JawInTrouble, holds_while_its_interface_is_down_or_gone_and_answers_again_when_it_is_back) {
  for (const std::string away : {"ip link set vcan0 down", "ip link del vcan0"}) {
    ASSERT_TRUE(shell(away));
    EXPECT_TRUE(tells("the CAN interface vcan0"));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    expect_held();
    ASSERT_TRUE(shell(
        "(ip link show vcan0 || ip link add dev vcan0 type vcan) >/dev/null 2>&1 && ip link set vcan0 up"));
    meet_host();
    EXPECT_TRUE(host_->in(wire::State::Hold)) << said();
    EXPECT_TRUE(host_->command(wire::hold_command()));
  }
  expect_held();
  EXPECT_EQ(end(SIGTERM), 0);
  EXPECT_NE(said().find("the bus is back"), std::string::npos) << said();
  EXPECT_NE(said().find("interface gone 2"), std::string::npos) << said();
}

TEST_F(JawInTrouble, says_nothing_while_bus_off_and_holds) {
  ASSERT_TRUE(shell("cansend vcan0 20000040#0000000000000000"));
  EXPECT_TRUE(tells("bus-off 1"));
  frames_of_node(std::chrono::milliseconds(50));  // those that had come before
  EXPECT_EQ(frames_of_node(std::chrono::milliseconds(500)), 0);
  expect_held();
  ASSERT_TRUE(shell("cansend vcan0 20000100#0000000000000000"));
  meet_host();
  EXPECT_TRUE(host_->in(wire::State::Hold)) << said();
  EXPECT_TRUE(tells("restarts 1"));
  expect_held();
}

TEST_F(JawInTrouble, holds_while_nothing_it_sends_leaves) {
  ASSERT_TRUE(shell("tc qdisc add dev vcan0 root plug limit 100"));
  EXPECT_TRUE(tells("full send queue"));
  EXPECT_TRUE(tells("lost sending"));
  expect_held();
  ASSERT_TRUE(shell("tc qdisc del dev vcan0 root"));
  meet_host();
  EXPECT_TRUE(host_->in(wire::State::Hold)) << said();
  expect_held();
}

/// Stopped by its system for a second while others say more than its socket can keep.
TEST_F(JawInTrouble, holds_though_it_could_not_read_all_that_came) {
  auto listener = socketcan::SocketBus::open(
      "vcan0", {.filters = {{.id = wire::id_of({wire::MessageType::Fault, 1}), .mask = 0x7FF}}});
  ASSERT_TRUE(listener) << listener.error().message;
  program_->signal(SIGSTOP);
  ASSERT_TRUE(shell("cangen vcan0 -g 0 -n 40000 -I 0F0 -L 8 -D 0000000000000000 -i"));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  program_->signal(SIGCONT);
  meet_host();
  EXPECT_TRUE(tells("lost receiving"));
  bool told_on_the_bus = false;
  for (auto next = (*listener)->receive(); next && *next; next = (*listener)->receive()) {
    const auto fault = wire::parse<wire::FaultReport>((*next)->frame);
    told_on_the_bus |=
        fault && fault->label.node == 1 && fault->message.code == wire::FaultCode::ReceiveOverrun;
  }
  EXPECT_TRUE(told_on_the_bus);
  expect_held();
  meet_host();
  EXPECT_TRUE(host_->in(wire::State::Hold)) << said();
}

TEST_F(JawInTrouble, tells_that_another_speaks_under_its_number) {
  const wire::Frame forged =
      wire::pack(wire::NodeState{.state = wire::State::Ready}, {.node = 1, .counter = 3});
  ASSERT_TRUE(bus_->send(forged).has_value());
  EXPECT_TRUE(host_->run_until(
      [&] { return host_->heard().state && host_->heard().state->fault == wire::FaultCode::OwnIdSeen; }));
  expect_held();
}

}  // namespace
}  // namespace pinjaw::jaw_app

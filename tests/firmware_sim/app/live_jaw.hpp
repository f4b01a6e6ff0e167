#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>

#include "firmware_sim/app/members.hpp"
#include "protocol/bench/unix_socket.hpp"
#include "protocol/socketcan/socket_bus.hpp"
#include "tests/firmware_sim/app/arm_files.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

/// pinjaw-jaw as a process on a real vcan0, and a host that takes it through a hold. Times are patience only.
namespace pinjaw::jaw_app {

using Clock = std::chrono::steady_clock;

/// The command that starts pinjaw-jaw with the controllers of one file.
inline std::vector<std::string> jaw_command(const std::string& controller, const std::string& world) {
  return {test::program("pinjaw-jaw"), controller, "--bus", "can:vcan0", "--world", world};
}

/// A host on a socket in real time.
class LiveHost {
 public:
  explicit LiveHost(bus::Bus& bus) : host_(bus, 0x4321) {}

  [[nodiscard]] const test::Heard& heard() const { return host_.heard(1); }

  bool run_until(const std::function<bool()>& condition,
                 std::chrono::seconds patience = std::chrono::seconds(20)) {
    const auto give_up = Clock::now() + patience;
    auto next = Clock::now();
    while (!condition()) {
      if (Clock::now() > give_up) return false;
      host_.step();
      next += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(next);
    }
    return true;
  }

  void run_for(std::chrono::milliseconds duration) {
    run_until([until = Clock::now() + duration] { return Clock::now() > until; });
  }

  bool in(wire::State state) {
    return run_until([&] { return host_.heard(1).state && host_.heard(1).state->state == state; });
  }

  bool service(const std::vector<std::uint8_t>& message) {
    host_.request(1, message);
    return run_until([this] { return host_.transferred(); }) && host_.heard(1).response.size() > 2 &&
           host_.heard(1).response[2] == 0;
  }

  bool command(const wire::Command& said) {
    host_.send(1, said);
    return run_until([this] { return host_.answered(); }) &&
           host_.heard(1).answer->result == wire::CommandResult::Ok;
  }

 private:
  test::ScriptedHost host_;
};

inline std::unique_ptr<bench::SocketWorld> world_at(const std::string& path) {
  for (int tries = 0; tries < 1000; ++tries) {
    if (auto world = bench::SocketWorld::connect(path)) return std::move(*world);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return nullptr;
}

/// A program whose node 1 holds the part with 60 N at least, as its world and its host know.
class Holding : public testing::Test {
 protected:
  static constexpr std::uint16_t kEpoch = 0x4321;

  void SetUp() override {
    const std::string controller = files_.controller();
    const auto members = read_members({controller});
    ASSERT_TRUE(members);
    program_.emplace(jaw_command(controller, path_), "", said_);
    world_ = world_at(path_);
    ASSERT_TRUE(world_);
    meet_host();
    take_part(members->front().kit_id);
  }

  /// Exit code of the program after `signal`.
  int end(int signal) {
    program_->signal(signal);
    return program_->wait();
  }

  /// A host on a socket of its own, from now on.
  void meet_host() {
    auto bus = socketcan::SocketBus::open("vcan0", {});
    ASSERT_TRUE(bus) << bus.error().message;
    host_.reset();
    bus_ = std::move(*bus);
    host_ = std::make_unique<LiveHost>(*bus_);
    host_->run_for(std::chrono::milliseconds(500));  // until its heartbeat is believed
  }

  bench::Truth truth() {
    const auto reply = world_->ask(bench::AskTruth{});
    if (reply) return std::get<bench::Truth>(*reply);
    ADD_FAILURE() << reply.error().message;
    return {};
  }
  void expect_held() {
    const bench::Truth now = truth();
    EXPECT_EQ(now.holders, std::vector{1});
    EXPECT_EQ(now.min_holders, 1);
    EXPECT_FALSE(now.dropped);
    ASSERT_FALSE(now.nodes.empty());
    EXPECT_LE(now.nodes.front().max_steady_n, 140);
  }
  /// What the program told on stderr so far.
  [[nodiscard]] std::string said() const {
    std::stringstream text;
    text << std::ifstream(said_).rdbuf();
    return text.str();
  }

  const ArmFiles files_;
  const std::string path_ = files_.path("world");
  const std::string said_ = files_.path("said");
  std::optional<test::Process> program_;
  std::unique_ptr<bench::SocketWorld> world_;
  std::unique_ptr<socketcan::SocketBus> bus_;
  std::unique_ptr<LiveHost> host_;

 private:
  void take_part(std::uint16_t kit_id) {
    const test::TestGrip grip{.node = 1, .separation_mm = 30, .needed_n = 60};
    const wire::Layout layout = test::bare_layout(grip, kit_id);
    tell(bench::Place{1, {{.node = 1, .separation_mm = 30, .needed_n = 60}}});
    tell(bench::Enable{1, true});
    constexpr int kMostTries = 100;
    for (int tries = 0; tries < kMostTries && !holds(); ++tries) next_step(layout);
    ASSERT_TRUE(holds()) << said();
  }

  void tell(const bench::Request& request) {
    const auto reply = world_->ask(request);
    ASSERT_TRUE(reply) << reply.error().message;
  }

  [[nodiscard]] bool holds() const {
    return host_->heard().state && host_->heard().state->state == wire::State::Hold;
  }

  /// What comes next in the state the node is in: on a busy machine the host may have lost its session
  /// anywhere.
  void next_step(const wire::Layout& layout) {
    const auto armed = [&] { return host_->command(wire::arm_command(wire::layout_crc_of(layout), kEpoch)); };
    if (host_->heard().state) {
      switch (host_->heard().state->state) {
        case wire::State::Unconfigured:
          host_->service(test::write_request(1, layout)) && host_->service(test::commit_request(2, layout));
          break;
        case wire::State::Loaded:
          armed();
          break;
        case wire::State::Ready:
          armed() && host_->command(wire::plain_command(wire::Op::CloseLight));
          break;
        case wire::State::Seated:
          armed() && host_->command(wire::squeeze_command({.set_dn = 720, .permit_dn = 1400}));
          break;
        default:
          break;
      }
    }
    host_->run_for(std::chrono::milliseconds(200));
  }
};

}  // namespace pinjaw::jaw_app

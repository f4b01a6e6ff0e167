// Promises: SIM.
// pinjaw-jaw as a process on a real vcan0: a host takes it through a hold over SocketCAN and dies, and the
// world's socket tells the truth. Times are never asserted.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <thread>

#include "firmware_sim/app/members.hpp"
#include "protocol/bench/unix_socket.hpp"
#include "protocol/socketcan/socket_bus.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"

namespace pinjaw::jaw_app {
namespace {

using Clock = std::chrono::steady_clock;

/// The program with the controllers of one file, started and ended.
class Running {
 public:
  Running(const std::string& program, const std::string& controller, const std::string& world)
      : child_(fork()) {
    if (child_ != 0) return;
    execl(program.c_str(), "pinjaw-jaw", controller.c_str(), "--bus", "can:vcan0", "--world", world.c_str(),
          nullptr);
    _exit(126);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    if (child_ > 0) kill(child_, SIGKILL);
  }

  /// Exit code after `signal`.
  int end(int signal) {
    kill(child_, signal);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t child_;
};

/// A host on a socket in real time.
class LiveHost {
 public:
  explicit LiveHost(bus::Bus& bus) : host_(bus, 0x4321) {}

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

std::string write_controller() {
  const std::string stem = testing::TempDir() + "pinjaw-vcan-" + std::to_string(getpid());
  std::ofstream(stem + "-kit.yaml")
      << "kit: test\n"
         "grid: {spacing_mm: 11.1125, columns: 2, rows: 9, edge_offset_mm: 5.55625}\n"
         "pins: {radius_mm: 2.38125, lengths_mm: any, min_engagement_mm: 1.0, protrusion_mm: 1.0}\n"
         "jaws: {separation_mm: [0, 60], plate_gap_mm: 2.0}\n"
         "actuator: {max_squeeze_n: 140, force_uncertainty_n: 12}\n";
  std::ofstream(stem + ".yaml") << "controller: arm\nnode: 1\nkit: " << stem
                                << "-kit.yaml\npassive: false\n"
                                   "hardware: {max_squeeze_n: 140, force_uncertainty_n: 12}\nplant: {}\n";
  return stem + ".yaml";
}

std::unique_ptr<bench::SocketWorld> world_at(const std::string& path) {
  for (int tries = 0; tries < 1000; ++tries) {
    if (auto world = bench::SocketWorld::connect(path)) return std::move(*world);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return nullptr;
}

TEST(JawOnVcan, holds_a_part_for_a_host_on_socketcan_and_keeps_it_when_the_host_dies) {
  const std::string controller = write_controller();
  const auto members = read_members({controller});
  ASSERT_TRUE(members);
  const std::string path = testing::TempDir() + "pinjaw-world-" + std::to_string(getpid());
  Running program(std::getenv("PINJAW_JAW"), controller, path);
  const auto world = world_at(path);
  ASSERT_TRUE(world);
  auto bus = socketcan::SocketBus::open("vcan0", {});
  ASSERT_TRUE(bus) << bus.error().message;
  LiveHost host(**bus);

  host.run_for(std::chrono::milliseconds(500));  // until its heartbeat is believed
  ASSERT_TRUE(host.in(wire::State::Unconfigured));
  const test::TestGrip grip{.node = 1, .separation_mm = 30, .needed_n = 60};
  const wire::Layout layout = test::bare_layout(grip, members->front().kit_id);
  ASSERT_TRUE(host.service(test::write_request(1, layout)));
  ASSERT_TRUE(host.service(test::commit_request(2, layout)));
  ASSERT_TRUE(host.in(wire::State::Loaded));
  ASSERT_TRUE(host.command(wire::arm_command(wire::layout_crc_of(layout), 0x4321)));
  ASSERT_TRUE(host.in(wire::State::Ready));
  ASSERT_TRUE(world->ask(bench::Place{1, {{.node = 1, .separation_mm = 30, .needed_n = 60}}}));
  ASSERT_TRUE(world->ask(bench::Enable{1, true}));
  host.run_for(std::chrono::milliseconds(200));  // the button is sampled
  ASSERT_TRUE(host.command(wire::plain_command(wire::Op::CloseLight)));
  ASSERT_TRUE(host.in(wire::State::Seated));
  ASSERT_TRUE(host.command(wire::squeeze_command({.set_dn = 720, .permit_dn = 1400})));
  ASSERT_TRUE(host.in(wire::State::Hold));

  std::this_thread::sleep_for(std::chrono::seconds(1));  // without its host
  const auto reply = world->ask(bench::AskTruth{});
  ASSERT_TRUE(reply) << reply.error().message;
  const auto& truth = std::get<bench::Truth>(*reply);
  EXPECT_EQ(truth.holders, std::vector{1});
  EXPECT_FALSE(truth.dropped);
  EXPECT_LE(truth.nodes.front().max_steady_n, 140);
  EXPECT_EQ(program.end(SIGTERM), 0);
  EXPECT_NE(access(path.c_str(), F_OK), 0);
}

TEST(JawOnVcan, an_interrupt_ends_it_cleanly) {
  const std::string path = testing::TempDir() + "pinjaw-interrupt-" + std::to_string(getpid());
  Running program(std::getenv("PINJAW_JAW"), write_controller(), path);
  ASSERT_TRUE(world_at(path));
  EXPECT_EQ(program.end(SIGINT), 0);
}

}  // namespace
}  // namespace pinjaw::jaw_app

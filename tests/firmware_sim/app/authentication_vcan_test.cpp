// Promises: AUTH-VCAN.
// pinjaw-jaw with a key as a process on a real vcan0, classic and CAN FD, and hosts with and without the key.
// Times are never asserted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "firmware_sim/app/members.hpp"
#include "host/config/key_file.hpp"
#include "host/jaw_client/client.hpp"
#include "protocol/bench/unix_socket.hpp"
#include "protocol/socketcan/socket_bus.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

namespace pinjaw::jaw_app {
namespace {

using Clock = std::chrono::steady_clock;
using testing::HasSubstr;

/// A controller's file with its kit and key, in a folder of its own.
class Files {
 public:
  explicit Files(bool can_fd) {
    std::string name = (std::filesystem::temp_directory_path() / "pinjaw-auth-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    std::ofstream(folder_ / "cell.key") << "00112233445566778899aabbccddeeff\n";
    std::filesystem::permissions(key(), std::filesystem::perms::owner_read);
    std::ofstream(folder_ / "kit.yaml")
        << "kit: test\n"
           "grid: {spacing_mm: 11.1125, columns: 2, rows: 9, edge_offset_mm: 5.55625}\n"
           "pins: {radius_mm: 2.38125, lengths_mm: any, min_engagement_mm: 1.0, protrusion_mm: 1.0}\n"
           "jaws: {separation_mm: [0, 60], plate_gap_mm: 2.0}\n"
           "actuator: {max_squeeze_n: 140, force_uncertainty_n: 12}\n";
    std::ofstream(controller()) << "controller: arm\nnode: 1\nkit: kit.yaml\npassive: false\n"
                                   "hardware: {max_squeeze_n: 140, force_uncertainty_n: 12}\nplant: {}\n"
                                   "authentication: {key_file: cell.key"
                                << (can_fd ? ", can_fd: true}\n" : "}\n");
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  [[nodiscard]] std::filesystem::path controller() const { return folder_ / "arm.yaml"; }
  [[nodiscard]] std::filesystem::path key() const { return folder_ / "cell.key"; }
  [[nodiscard]] std::string world() const { return (folder_ / "world").string(); }

 private:
  std::filesystem::path folder_;
};

/// pinjaw-jaw with these files, ended by SIGTERM; serves its world when it is ready.
class Simulated {
 public:
  explicit Simulated(const Files& files)
      : program_({test::program("pinjaw-jaw"), files.controller(), "--bus", "can:vcan0", "--world",
                  files.world()}) {}
  Simulated(const Simulated&) = delete;
  Simulated& operator=(const Simulated&) = delete;
  ~Simulated() {
    program_.signal(SIGTERM);
    program_.wait();
  }

 private:
  test::Process program_;
};

bool served(const std::string& path) {
  for (int tries = 0; tries < 1000; ++tries) {
    if (bench::SocketWorld::connect(path)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

/// A host in real time.
class LiveClient {
 public:
  explicit LiveClient(bus::Bus& bus, jaw_client::Client::Settings settings) : client_(bus, settings) {}

  bool run_until(const std::function<bool()>& condition) {
    const auto start = Clock::now();
    for (auto next = start; !condition(); next += std::chrono::milliseconds(1)) {
      if (Clock::now() - start > std::chrono::seconds(20)) return false;
      client_.step(std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start_).count());
      std::this_thread::sleep_until(next);
    }
    return true;
  }
  jaw_client::Outcome settled() {
    run_until([this] { return !client_.outcome(1).pending(); });
    return client_.outcome(1);
  }
  /// Brings the layout and arms.
  jaw_client::Outcome set_up(const wire::Layout& layout) {
    run_until([this] { return client_.alive(1); });
    client_.send_layout(1, layout);
    if (const auto sent = settled(); !sent.done()) return sent;
    client_.permit(1, true);
    client_.arm(1, wire::layout_crc_of(layout));
    return settled();
  }

 private:
  Clock::time_point start_ = Clock::now();
  jaw_client::Client client_;
};

class AuthenticationOnVcan : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Buses, AuthenticationOnVcan, testing::Bool(),
                         [](const auto& fd) { return fd.param ? "can_fd" : "classic"; });

TEST_P(AuthenticationOnVcan, arms_for_a_host_with_the_key_and_for_no_other) {
  const bool can_fd = GetParam();
  const Files files(can_fd);
  const auto members = read_members({files.controller()});
  ASSERT_TRUE(members);
  const Simulated program(files);
  ASSERT_TRUE(served(files.world()));
  const auto listener = socketcan::SocketBus::open("vcan0", {});
  ASSERT_TRUE(listener) << listener.error().message;
  const auto bus = socketcan::SocketBus::open("vcan0", {});
  ASSERT_TRUE(bus) << bus.error().message;
  const wire::Layout layout =
      test::bare_layout({.node = 1, .separation_mm = 30, .needed_n = 60}, members->front().kit_id);

  const auto key = config::read_key_file(files.key());
  ASSERT_TRUE(key) << key.error().message;
  LiveClient friendly(**bus, {.epoch = 0x4321, .key = *key, .can_fd = can_fd, .nonces = 99});
  const jaw_client::Outcome armed = friendly.set_up(layout);
  EXPECT_TRUE(armed.done()) << armed.sentence;

  int fd_frames = 0;
  int classic_frames = 0;
  for (auto heard = (*listener)->receive(); heard && *heard; heard = (*listener)->receive()) {
    const bool fd = (*heard)->frame.kind == wire::FrameKind::Fd;
    ++(fd ? fd_frames : classic_frames);
  }
  EXPECT_GT(can_fd ? fd_frames : classic_frames, 50);
  EXPECT_EQ(can_fd ? classic_frames : fd_frames, 0);

  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // the first host has gone
  LiveClient stranger(**bus, {.epoch = 0x4322});
  const jaw_client::Outcome refused = stranger.set_up(layout);
  EXPECT_FALSE(refused.done());
  if (!can_fd) {
    EXPECT_THAT(refused.sentence, HasSubstr("requires authentication"));
  }
}

}  // namespace
}  // namespace pinjaw::jaw_app

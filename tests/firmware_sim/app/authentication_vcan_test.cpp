// Promises: AUTH-VCAN.
// pinjaw-jaw with a key as a process on a real vcan0, classic and CAN FD, and hosts with and without the key.
// Times are never asserted.
#include <gmock/gmock.h>

#include <filesystem>

#include "host/config/key_file.hpp"
#include "host/jaw_client/client.hpp"
#include "tests/firmware_sim/app/live_jaw.hpp"

namespace pinjaw::jaw_app {
namespace {

using testing::HasSubstr;

/// The arm with a key.
struct KeyedArm {
  explicit KeyedArm(bool can_fd)
      : key(files.write("cell.key", "00112233445566778899aabbccddeeff\n")),
        controller(files.controller(
            "arm", 1,
            std::string("authentication: {key_file: cell.key") + (can_fd ? ", can_fd: true}\n" : "}\n"))) {
    std::filesystem::permissions(key, std::filesystem::perms::owner_read);
  }
  ArmFiles files;
  std::string key;
  std::string controller;
};

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
    if (auto sent = settled(); !sent.done()) return sent;
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
  const KeyedArm arm(can_fd);
  const auto members = read_members({arm.controller});
  ASSERT_TRUE(members);
  const std::string world = arm.files.path("world");
  const test::Process program(jaw_command(arm.controller, world));
  ASSERT_TRUE(world_at(world));
  const auto listener = socketcan::SocketBus::open("vcan0", {});
  ASSERT_TRUE(listener) << listener.error().message;
  const auto bus = socketcan::SocketBus::open("vcan0", {});
  ASSERT_TRUE(bus) << bus.error().message;
  const wire::Layout layout =
      test::bare_layout({.node = 1, .separation_mm = 30, .needed_n = 60}, members->front().kit_id);

  const auto key = config::read_key_file(arm.key);
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

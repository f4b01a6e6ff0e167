// Promises: SIM, I6.
// pinjaw-jaw as a process on a real vcan0: a host takes it through a hold over SocketCAN and dies, and the
// world's socket tells the truth. Times are never asserted.
#include "tests/firmware_sim/app/live_jaw.hpp"

namespace pinjaw::jaw_app {
namespace {

using JawOnVcan = Holding;

TEST_F(JawOnVcan, keeps_the_part_when_its_host_dies_and_ends_when_told) {
  std::this_thread::sleep_for(std::chrono::seconds(1));  // without its host
  expect_held();
  EXPECT_EQ(end(SIGTERM), 0);
  EXPECT_FALSE(std::filesystem::exists(path_));
  EXPECT_EQ(said().find("bus of node"), std::string::npos) << said();
}

TEST(JawProgramOnVcan, an_interrupt_ends_it_cleanly) {
  const ArmFiles files;
  const std::string path = files.path("world");
  test::Process program(jaw_command(files.controller(), path), "", files.path("said"));
  ASSERT_TRUE(world_at(path));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 0);
}

}  // namespace
}  // namespace pinjaw::jaw_app

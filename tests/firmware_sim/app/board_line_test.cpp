// Promises: SIM.
// The serial line to a board whose jaws are simulated here: what goes out when, and what holds when nothing
// comes back.
#include "firmware_sim/app/board_line.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "tests/support/folder.hpp"

namespace pinjaw::jaw_app {
namespace {

using testing::HasSubstr;

const core::Valves kClosing{.spool = core::Spool::Close, .close_set_mbar = 1234, .relax = true};

core::Sensors reading(int mbar) {
  core::Sensors sensors;
  sensors.supply_mbar = mbar;
  return sensors;
}

/// What a packet says, without its number.
link::SensorsPacket sent_again(const link::SensorsPacket& packet) {
  return link::pack(link::sensors_of(packet), 0);
}

/// The board's end of the line.
class BoardLineTest : public testing::Test {
 protected:
  BoardLineTest() {
    const std::string path = folder_.path("line");
    const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.size());
    EXPECT_EQ(::bind(listener, static_cast<sockaddr*>(static_cast<void*>(&address)), sizeof(address)), 0);
    EXPECT_EQ(::listen(listener, 1), 0);
    auto line = BoardLine::connect(path);
    board_ = ::accept(listener, nullptr, nullptr);
    close(listener);
    fcntl(board_, F_SETFL, O_NONBLOCK);
    if (line) line_ = std::move(*line);
  }
  ~BoardLineTest() override { close(board_); }

  void SetUp() override { ASSERT_NE(line_, nullptr); }

  /// Readings that have arrived at the board since the last look.
  std::vector<link::SensorsPacket> arrived() {
    std::vector<link::SensorsPacket> packets;
    for (std::uint8_t byte = 0; read(board_, &byte, 1) == 1;) {
      if (const auto packet = reader_.take(byte)) packets.push_back(*packet);
    }
    return packets;
  }
  void answer(const core::Valves& valves, std::uint8_t number) {
    const link::ValvesPacket packet = link::pack(valves, number);
    ASSERT_EQ(write(board_, packet.data(), packet.size()), static_cast<ssize_t>(packet.size()));
  }
  void answer(const core::Valves& valves, const link::SensorsPacket& to) {
    answer(valves, link::number_of(to));
  }

  const test::Folder folder_;
  int board_ = -1;
  link::PacketReader<link::kSensorsBytes> reader_{link::kSensorsMark};
  std::unique_ptr<BoardLine> line_;
};

TEST_F(BoardLineTest, brings_readings_there_and_what_the_valves_are_told_back) {
  core::Sensors sensors{.close_mbar = {-70, 1650}, .open_mbar = {5000, 9900}, .supply_mbar = 6000};
  sensors.separation_10um = 5997;
  sensors.seats = 0x55;
  sensors.local_enable = true;
  EXPECT_EQ(line_->exchange(sensors), core::Valves{}) << "nothing was told yet";
  const auto packets = arrived();
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(sent_again(packets[0]), link::pack(sensors, 0));
  answer(kClosing, packets[0]);
  EXPECT_EQ(line_->exchange(sensors), kClosing);
}

TEST_F(BoardLineTest, sends_new_readings_only_once_the_last_were_answered) {
  line_->exchange(reading(1));
  const auto first = arrived();
  ASSERT_EQ(first.size(), 1U);
  for (int i = 2; i < 10; ++i) line_->exchange(reading(i));
  EXPECT_TRUE(arrived().empty());
  answer(kClosing, first[0]);
  line_->exchange(reading(10));
  const auto second = arrived();
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(sent_again(second[0]), link::pack(reading(10), 0)) << "the present ones, none of those between";
}

TEST_F(BoardLineTest, asks_again_after_20_ms_and_lets_no_queue_of_old_readings_stay) {
  for (int i = 0; i < 61; ++i) line_->exchange(reading(i));
  const auto waiting = arrived();
  ASSERT_EQ(waiting.size(), 4U) << "at 0, 20, 40 and 60 ms";
  for (std::size_t i = 0; i < 3; ++i) {
    answer(kClosing, waiting[i]);
    EXPECT_EQ(line_->exchange(reading(100)), kClosing) << "late, but what the valves are told";
    EXPECT_TRUE(arrived().empty()) << "an old reading's answer asks for no new one";
  }
  answer(kClosing, waiting[3]);
  line_->exchange(reading(101));
  EXPECT_EQ(arrived().size(), 1U);
}

TEST_F(BoardLineTest, de_energises_the_valves_of_a_board_that_says_nothing_for_100_ms) {
  answer(kClosing, 0);
  EXPECT_EQ(line_->exchange(reading(0)), kClosing);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(line_->exchange(reading(0)), kClosing) << i;
  EXPECT_EQ(line_->exchange(reading(0)), core::Valves{});
  answer(kClosing, 0);
  EXPECT_EQ(line_->exchange(reading(0)), kClosing) << "and believes it again";
}

TEST_F(BoardLineTest, passes_over_what_is_no_packet) {
  const link::ValvesPacket whole = link::pack(kClosing, 7);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    link::ValvesPacket spoilt = whole;
    spoilt.at(at) ^= 0x10U;
    ASSERT_EQ(write(board_, spoilt.data(), spoilt.size()), static_cast<ssize_t>(spoilt.size()));
    EXPECT_EQ(line_->exchange(reading(0)), core::Valves{}) << at;
  }
  answer(kClosing, 7);
  EXPECT_EQ(line_->exchange(reading(0)), kClosing);
}

TEST_F(BoardLineTest, outlives_a_board_that_hangs_up) {
  answer(kClosing, 0);
  EXPECT_EQ(line_->exchange(reading(0)), kClosing);
  close(board_);
  board_ = -1;
  for (int i = 0; i < 200; ++i) line_->exchange(reading(i));
  EXPECT_EQ(line_->exchange(reading(0)), core::Valves{});
}

TEST(BoardLine, says_which_socket_nobody_listens_at) {
  const auto line = BoardLine::connect("/nowhere/line");
  ASSERT_FALSE(line);
  EXPECT_THAT(line.error(), HasSubstr("/nowhere/line: no board's serial line: No such file"));
  EXPECT_THAT(BoardLine::connect(std::string(200, 'x')).error(), HasSubstr("too long"));
}

}  // namespace
}  // namespace pinjaw::jaw_app

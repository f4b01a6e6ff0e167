#include "tests/protocol/socketcan/vcan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "protocol/wire/codec.hpp"

/// SocketBus on a real vcan0, with candump and cansend as its peers. Times are never asserted.
namespace pinjaw::socketcan {
namespace {

using wire::Frame;
using wire::FrameKind;

TEST(Vcan, candump_sees_what_we_send) {
  const std::vector<Frame> sent = {
      wire::pack(wire::NodeState{.state = wire::State::Hold, .f_low_dn = 771}, {.node = 2, .counter = 5}),
      frame_of(0x7FF, {}), frame_of(0x001, {1, 2, 3}), Frame{.id = 0x12345678, .extended = true, .data = {9}},
      Frame{.id = 0x123, .kind = FrameKind::Remote, .length = 0}};
  Candump candump("", static_cast<int>(sent.size()));
  const auto bus = opened();
  ASSERT_NE(bus, nullptr);
  for (const Frame& frame : sent) ASSERT_TRUE(bus->send(frame).has_value());
  const std::vector<bus::LogLine> seen = candump.lines();
  ASSERT_EQ(seen.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(seen[i].frame, sent[i]) << bus::to_log_line({0, "vcan0", sent[i]});
    EXPECT_EQ(seen[i].interface, "vcan0");
  }
}

TEST(Vcan, we_see_what_cansend_sends) {
  const auto bus = opened();
  ASSERT_NE(bus, nullptr);
  run("cansend vcan0 062#DEADBEEF && cansend vcan0 12345678#01 && cansend vcan0 123#R");
  const auto standard = next(*bus);
  ASSERT_TRUE(standard.has_value());
  EXPECT_EQ(standard->frame, frame_of(0x062, {0xDE, 0xAD, 0xBE, 0xEF}));
  EXPECT_EQ(standard->origin, bus::Origin::SameMachine);
  EXPECT_GT(standard->time_us, 1'600'000'000'000'000) << "the kernel's time of day";
  const auto extended = next(*bus);
  ASSERT_TRUE(extended.has_value());
  EXPECT_TRUE(extended->frame.extended);
  EXPECT_EQ(extended->frame.id, 0x12345678U);
  const auto remote = next(*bus);
  ASSERT_TRUE(remote.has_value());
  EXPECT_EQ(remote->frame.kind, FrameKind::Remote);
}

TEST(Vcan, canplayer_plays_the_logs_we_write) {
  const std::vector<Frame> logged = {wire::pack(wire::Force{.f_high_dn = 891}, {.node = 2, .counter = 1}),
                                     frame_of(0x7FF, {}),
                                     Frame{.id = 0x12345678, .extended = true, .data = {9}},
                                     Frame{.id = 0x123, .kind = FrameKind::Remote, .length = 0}};
  const std::string path = ::testing::TempDir() + "canplayer." + std::to_string(::getpid()) + ".log";
  {
    std::ofstream log(path);
    std::int64_t time_us = 0;
    for (const Frame& frame : logged) log << bus::to_log_line({time_us += 1000, "vcan0", frame}) << '\n';
  }
  const auto bus = opened();
  ASSERT_NE(bus, nullptr);
  run("canplayer -I " + path);
  for (const Frame& frame : logged) {
    const auto received = next(*bus);
    ASSERT_TRUE(received.has_value());
    EXPECT_EQ(received->frame, frame);
  }
  std::remove(path.c_str());
}

TEST(Vcan, filters_let_no_other_and_no_extended_or_remote_frame_pass) {
  const auto bus = opened({.filters = {{0x062, 0x7FF}, {0x100, 0x7F0}}});
  ASSERT_NE(bus, nullptr);
  run("cansend vcan0 00000062#01; cansend vcan0 062#R; cansend vcan0 063#02; cansend vcan0 10F#03; "
      "cansend vcan0 110#04; cansend vcan0 062#05");
  EXPECT_EQ(next(*bus)->frame, frame_of(0x10F, {3}));
  EXPECT_EQ(next(*bus)->frame, frame_of(0x062, {5}));
  EXPECT_FALSE(next(*bus, 200'000).has_value());
}

TEST(Vcan, reports_error_frames_whatever_the_filters) {
  const auto bus = opened({.filters = {{0x062, 0x7FF}}});
  ASSERT_NE(bus, nullptr);
  run("cansend vcan0 20000040#0000000000000000");
  const auto received = next(*bus);
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(received->frame.kind, FrameKind::Error);
  EXPECT_EQ(received->frame.id, 0x40U) << "bus-off";
  EXPECT_EQ(bus->statistics().error_frames, 1U);
}

TEST(Vcan, tells_own_frames_from_those_of_others) {
  const auto quiet = opened();
  const auto echoing = opened({.hear_self = true});
  ASSERT_NE(quiet, nullptr);
  ASSERT_NE(echoing, nullptr);
  ASSERT_TRUE(quiet->send(frame_of(1, {1})).has_value());
  ASSERT_TRUE(echoing->send(frame_of(2, {2})).has_value());
  EXPECT_EQ(next(*echoing)->origin, bus::Origin::SameMachine);
  EXPECT_EQ(next(*echoing)->origin, bus::Origin::Self);
  EXPECT_EQ(next(*quiet)->frame.id, 2U);
  EXPECT_FALSE(next(*quiet, 200'000).has_value()) << "its own never comes back";
}

TEST(Vcan, says_when_the_interface_goes_down_or_away) {
  const auto bus = opened({}, "vcan1");
  ASSERT_NE(bus, nullptr);
  run("ip link set vcan1 down");
  const auto sent = bus->send(frame_of(1, {}));
  ASSERT_FALSE(sent.has_value());
  EXPECT_EQ(sent.error().kind, bus::FailureKind::Down);
  EXPECT_FALSE(SocketBus::open("vcan1", {}).has_value());
  const auto received = bus->receive();
  ASSERT_FALSE(received.has_value());
  EXPECT_EQ(received.error().kind, bus::FailureKind::Down);
  run("ip link del vcan1");
  EXPECT_FALSE(bus->send(frame_of(1, {})).has_value());
  EXPECT_EQ(SocketBus::open("vcan1", {}).error().kind, bus::FailureKind::Unavailable);
}

TEST(Vcan, refuses_an_interface_that_is_not_can) {
  const auto bus = SocketBus::open("lo", {});
  ASSERT_FALSE(bus.has_value());
  EXPECT_EQ(bus.error().kind, bus::FailureKind::Unavailable);
}

}  // namespace
}  // namespace pinjaw::socketcan

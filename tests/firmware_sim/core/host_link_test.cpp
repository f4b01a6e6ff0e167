// Promises: I5.
#include "firmware_sim/core/host_link.hpp"

#include <gtest/gtest.h>

/// Which host a controller hears, and for how long it believes that.
namespace pinjaw::core::test {
namespace {

wire::Received<wire::HostHeartbeat> beat(std::uint8_t counter, std::uint16_t epoch,
                                         std::uint16_t permit = 1) {
  return {{0, counter}, {.permit = permit, .epoch = epoch}};
}

TEST(HostLink, is_alive_after_three_heartbeats_in_order_for_200_ms) {
  HostLink host;
  EXPECT_FALSE(host.alive());
  EXPECT_FALSE(host.permits());
  host.hear(beat(0, 5), 1);
  host.hear(beat(1, 5), 1);
  EXPECT_FALSE(host.alive());
  host.hear(beat(2, 5), 1);
  EXPECT_TRUE(host.alive());
  EXPECT_TRUE(host.permits());
  EXPECT_EQ(host.epoch(), 5);
  EXPECT_FALSE(host.two_hosts());
  host.advance(199);
  EXPECT_TRUE(host.alive());
  host.advance(1);
  EXPECT_FALSE(host.alive());
  EXPECT_FALSE(host.permits());
}

TEST(HostLink, permits_only_the_nodes_that_the_last_good_heartbeat_permits) {
  HostLink host;
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 5, 0b10), 1);
  EXPECT_TRUE(host.alive());
  EXPECT_FALSE(host.permits());
  host.hear(beat(3, 5, 0b01), 1);
  EXPECT_TRUE(host.permits());
  host.hear(beat(3, 5, 0b10), 1);
  EXPECT_TRUE(host.permits()) << "a repeated heartbeat says nothing";
}

TEST(HostLink, notices_a_second_host_and_keeps_to_the_first) {
  HostLink host;
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 5), 1);
  host.hear(beat(9, 6), 1);
  EXPECT_TRUE(host.two_hosts());
  EXPECT_EQ(host.epoch(), 5);
  EXPECT_TRUE(host.alive());
  host.advance(100);
  host.hear(beat(3, 5), 1);
  host.advance(99);
  EXPECT_TRUE(host.two_hosts());
  host.advance(1);
  EXPECT_FALSE(host.two_hosts()) << "200 ms after the second one's only heartbeat";
  EXPECT_TRUE(host.alive());
}

TEST(HostLink, follows_the_second_host_when_the_first_is_silent) {
  HostLink host;
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 5), 1);
  host.advance(100);
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 6), 1);
  host.advance(100);
  EXPECT_EQ(host.epoch(), 6);
  EXPECT_TRUE(host.alive());
  EXPECT_FALSE(host.two_hosts());
  host.hear(beat(3, 6), 1);
  EXPECT_FALSE(host.two_hosts()) << "it is the one that is followed";
}

TEST(HostLink, makes_a_host_that_comes_back_qualify_again) {
  HostLink host;
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 5), 1);
  host.advance(200);
  host.hear(beat(3, 5), 1);
  EXPECT_FALSE(host.alive());
  host.hear(beat(4, 5), 1);
  host.hear(beat(5, 5), 1);
  EXPECT_TRUE(host.alive());
}

TEST(HostLink, lives_on_heartbeats_that_are_in_order_and_not_on_repeats) {
  HostLink host;
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 5), 1);
  host.advance(100);
  host.hear(beat(2, 5), 1);
  host.advance(99);
  EXPECT_TRUE(host.alive());
  EXPECT_TRUE(host.permits());
  host.advance(1);
  EXPECT_FALSE(host.alive());
  EXPECT_FALSE(host.permits());
}

TEST(HostLink, makes_a_third_host_qualify_for_itself) {
  HostLink host;
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 5), 1);
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 6), 1);
  host.advance(100);
  host.hear(beat(3, 7), 1);
  host.advance(100);
  EXPECT_FALSE(host.alive()) << "7 is followed now, and was heard once";
  host.hear(beat(4, 7), 1);
  host.hear(beat(5, 7), 1);
  EXPECT_TRUE(host.alive());
  EXPECT_EQ(host.epoch(), 7);
}

TEST(HostLink, keeps_to_the_first_of_two_as_time_goes_by) {
  HostLink host;
  for (std::uint8_t counter = 0; counter < 3; ++counter) {
    host.hear(beat(counter, 5, 0b01), 1);
    host.hear(beat(counter, 6, 0b10), 1);
  }
  for (int ms = 0; ms < 3; ++ms) {
    host.advance(1);
    EXPECT_EQ(host.epoch(), 5);
    EXPECT_TRUE(host.permits());
  }
}

TEST(HostLink, of_epoch_0_is_one_like_any_other) {
  HostLink host;
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 0), 1);
  EXPECT_TRUE(host.alive());
  EXPECT_FALSE(host.two_hosts());
  host.advance(200);
  for (std::uint8_t counter = 0; counter < 3; ++counter) host.hear(beat(counter, 5), 1);
  host.hear(beat(0, 0), 1);
  EXPECT_TRUE(host.two_hosts());
  EXPECT_EQ(host.epoch(), 5);
}

}  // namespace
}  // namespace pinjaw::core::test

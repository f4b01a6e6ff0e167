// Promises: BUS-STRESS.
#include "protocol/socketcan/controller_watch.hpp"

#include <gtest/gtest.h>
#include <linux/can/error.h>

#include "protocol/bus/statistics.hpp"

namespace pinjaw::socketcan {
namespace {

wire::Frame error_frame(std::uint32_t classes, std::uint8_t controller = 0) {
  return {.id = classes, .kind = wire::FrameKind::Error, .data = {0, controller}};
}

/// A watch and what it counts.
struct Watched {
  ControllerWatch watch{};
  bus::Statistics statistics{};
  void error(std::uint32_t classes, std::uint8_t controller = 0) {
    watch.take({.frame = error_frame(classes, controller)}, statistics);
  }
  void data(bus::Origin origin) { watch.take({.frame = {.id = 0x60}, .origin = origin}, statistics); }
};

TEST(ErrorFrame, tells_each_thing_by_its_own_bit_alone) {
  for (unsigned bit = 0; bit < 29; ++bit) {
    const std::uint32_t one = 1U << bit;
    const ErrorReport report = read_error(error_frame(one));
    EXPECT_EQ(report.bus_off, one == CAN_ERR_BUSOFF);
    EXPECT_EQ(report.restarted, one == CAN_ERR_RESTARTED);
    EXPECT_EQ(report.unacknowledged, one == CAN_ERR_ACK);
    EXPECT_FALSE(report.passive || report.overrun || report.recovering);
  }
  for (unsigned bit = 0; bit < 8; ++bit) {
    const auto one = static_cast<std::uint8_t>(1U << bit);
    const ErrorReport report = read_error(error_frame(CAN_ERR_CRTL, one));
    EXPECT_EQ(report.overrun, (one & (CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW)) != 0);
    EXPECT_EQ(report.passive, (one & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0);
    EXPECT_EQ(report.recovering,
              (one & (CAN_ERR_CRTL_ACTIVE | CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0);
    EXPECT_EQ(read_error(error_frame(CAN_ERR_PROT, one)), ErrorReport{}) << "details of another class";
  }
}

TEST(ErrorFrame, of_no_length_has_no_details) {
  wire::Frame frame = error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE);
  frame.length = 0;
  EXPECT_EQ(read_error(frame), ErrorReport{});
}

TEST(ControllerWatch, is_off_from_bus_off_to_restart_and_counts_each_once) {
  Watched watched;
  EXPECT_FALSE(watched.watch.off());
  watched.error(CAN_ERR_BUSOFF);
  watched.error(CAN_ERR_BUSOFF);
  EXPECT_TRUE(watched.watch.off());
  watched.error(CAN_ERR_ACK);
  watched.data(bus::Origin::SameMachine);
  EXPECT_TRUE(watched.watch.off()) << "a frame of this machine proves nothing";
  watched.error(CAN_ERR_RESTARTED);
  EXPECT_FALSE(watched.watch.off());
  EXPECT_EQ(watched.statistics.bus_off, 1U);
  EXPECT_EQ(watched.statistics.restarts, 1U);
  EXPECT_EQ(watched.statistics.unacknowledged, 1U);
  EXPECT_EQ(watched.statistics.error_frames, 4U);
}

TEST(ControllerWatch, that_is_patient_stays_off_until_it_may_come_back_as_well) {
  Watched watched{.watch = ControllerWatch(true)};
  watched.error(CAN_ERR_BUSOFF);
  watched.error(CAN_ERR_RESTARTED);
  EXPECT_TRUE(watched.watch.off());
  watched.watch.permit_restart();
  EXPECT_FALSE(watched.watch.off());
  watched.error(CAN_ERR_BUSOFF);
  watched.watch.permit_restart();
  EXPECT_TRUE(watched.watch.off()) << "before the kernel has restarted it";
  watched.error(CAN_ERR_RESTARTED);
  EXPECT_FALSE(watched.watch.off());
}

TEST(ControllerWatch, a_frame_from_elsewhere_proves_that_the_controller_is_on) {
  Watched watched;
  watched.error(CAN_ERR_BUSOFF);
  watched.data(bus::Origin::Elsewhere);
  EXPECT_FALSE(watched.watch.off());
}

TEST(ControllerWatch, is_passive_until_it_only_warns) {
  Watched watched;
  watched.error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  watched.error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_RX_WARNING);
  EXPECT_TRUE(watched.watch.passive());
  watched.error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING);
  EXPECT_FALSE(watched.watch.passive());
  watched.error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  EXPECT_EQ(watched.statistics.passive, 2U);
}

TEST(ControllerWatch, counts_overruns_in_the_controller) {
  Watched watched;
  watched.error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW);
  watched.error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_OVERFLOW);
  EXPECT_EQ(watched.statistics.overruns, 2U);
}

TEST(Statistics, tell_every_trouble_there_was_and_no_other) {
  EXPECT_EQ(bus::to_text({.sent = 5, .received = 7}), "");
  EXPECT_EQ(bus::to_text({.lost_receiving = 3, .bus_off = 1}), "lost receiving 3, bus-off 1");
}

TEST(Statistics, of_two_ends_add_up_in_every_count) {
  bus::Statistics one{.sent = 1, .received = 2};
  std::uint64_t next = 3;
  for (const bus::Trouble& trouble : bus::kTroubles) one.*trouble.count = next++;
  bus::Statistics both = one;
  both += one;
  EXPECT_EQ(both.sent, 2U);
  EXPECT_EQ(both.received, 4U);
  for (const bus::Trouble& trouble : bus::kTroubles) EXPECT_EQ(both.*trouble.count, 2 * (one.*trouble.count));
  EXPECT_EQ(sizeof(bus::Statistics), (2 + bus::kTroubles.size()) * sizeof(std::uint64_t))
      << "none is left out";
}

}  // namespace
}  // namespace pinjaw::socketcan

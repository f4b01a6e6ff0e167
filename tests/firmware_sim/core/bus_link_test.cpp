// Promises: BUS-OFF, I5.
#include <gtest/gtest.h>

#include "tests/firmware_sim/core/bench.hpp"

/// Bus-off: a controller holds at once, recovers a few times by itself, and believes nobody it has not heard
/// since.
namespace pinjaw::core::test {
namespace {

struct BusOff : testing::Test {
  BusOff() { bench.load_all(); }
  void fall_off(Station& station, int ms = 5) {
    station.bus.off = true;
    bench.run(ms);
  }
  Bench bench;
};

TEST_F(BusOff, changes_no_valve_of_a_holder) {
  bench.load_gripper(kArm);
  bench.run(500);
  fall_off(bench.arm(), 2000);
  EXPECT_EQ(bench.arm().id(), StateId::Hold);
  EXPECT_GE(bench.arm().jaw.squeeze_dn(), 400);
}

TEST_F(BusOff, stops_jaws_that_close_within_one_step) {
  bench.arm().jaw.local_enable = true;
  bench.bring_part(kArm, true);
  bench.arm_session(kArm);
  bench.command(kArm, wire::plain_command(wire::Op::CloseLight));
  ASSERT_TRUE(bench.run_until(2000, [&] { return bench.arm().outputs.valves.spool == Spool::Close; }));
  fall_off(bench.arm(), 1);
  EXPECT_EQ(bench.arm().outputs.valves.spool, Spool::Hold);
  EXPECT_FALSE(bench.arm().core.gate.armed());
}

TEST_F(BusOff, of_a_giver_that_relaxes_makes_it_squeeze_again) {
  bench.load_gripper(kArm);
  ASSERT_TRUE(bench.seat(kArm, kPedestal));
  ASSERT_TRUE(bench.squeeze(kPedestal));
  ASSERT_TRUE(bench.reaches(kArm, StateId::Relax));
  fall_off(bench.arm(), 1);
  EXPECT_EQ(bench.arm().id(), StateId::Resqueeze);
}

TEST_F(BusOff, asks_for_recovery_three_times_in_ten_seconds_and_then_stays_off) {
  bench.load_gripper(kArm);
  for (int fall = 0; fall < 5; ++fall) {
    fall_off(bench.arm(), 10);
    EXPECT_EQ(bench.arm().outputs.restart_bus, fall < 3) << fall;
    if (fall < 3) bench.arm().bus.off = false;
    bench.run(500);
  }
  bench.run(20'000);
  EXPECT_FALSE(bench.arm().outputs.restart_bus) << "it does not begin again by itself";
  EXPECT_GE(bench.arm().jaw.squeeze_dn(), 400);
}

TEST_F(BusOff, recovers_without_end_where_it_is_rare) {
  for (int fall = 0; fall < 8; ++fall) {
    fall_off(bench.arm(), 10);
    EXPECT_TRUE(bench.arm().outputs.restart_bus) << fall;
    bench.arm().bus.off = false;
    bench.run(4000);
  }
}

TEST_F(BusOff, is_reported_once_it_is_over) {
  fall_off(bench.arm());
  bench.arm().bus.off = false;
  bool told = false;
  bench.after_step = [&] {
    for (const wire::Frame& frame : bench.heard) {
      const auto fault = wire::parse<wire::FaultReport>(frame);
      told = told ||
             (fault && fault->label.node == kArm && fault->message.code == wire::FaultCode::BusOffRecovered);
    }
  };
  bench.run(50);
  EXPECT_TRUE(told);
  EXPECT_FALSE(bench.arm().core.faults.active(wire::FaultCode::BusOff));
}

TEST_F(BusOff, makes_everyone_qualify_anew) {
  bench.run(500);
  ASSERT_TRUE(bench.arm().core.host.alive());
  fall_off(bench.arm());
  bench.arm().bus.off = false;
  bench.run(1);
  EXPECT_FALSE(bench.arm().core.host.alive());
  EXPECT_FALSE(bench.arm().core.peers.find(kPedestal)->fresh());
  bench.run(300);
  EXPECT_TRUE(bench.arm().core.host.alive());
}

TEST_F(BusOff, and_its_lesser_sisters_are_told) {
  bench.arm().bus.passive = true;
  bench.arm().bus.overruns = 3;
  bool overrun = false;
  bench.after_step = [&] {
    for (const wire::Frame& frame : bench.heard) {
      const auto fault = wire::parse<wire::FaultReport>(frame);
      overrun = overrun || (fault && fault->message.code == wire::FaultCode::ReceiveOverrun);
    }
  };
  bench.run(20);
  EXPECT_TRUE(overrun);
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::BusPassive));
  bench.arm().bus.passive = false;
  bench.run(1);
  EXPECT_FALSE(bench.arm().core.faults.active(wire::FaultCode::BusPassive));
}

}  // namespace
}  // namespace pinjaw::core::test

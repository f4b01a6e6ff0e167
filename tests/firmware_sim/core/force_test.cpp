// Promises: I1, I5.
#include <gtest/gtest.h>

#include <algorithm>

#include "firmware_sim/core/force_control.hpp"
#include "firmware_sim/core/guards.hpp"
#include "tests/firmware_sim/core/bench.hpp"

namespace pinjaw::core::test {
namespace {

struct Force : testing::Test {
  Force() { bench.load_all(); }
  ToyJaw& jaw() { return bench.arm().jaw; }
  void seat() {
    bench.bring_part(kArm, true);
    jaw().local_enable = true;
    bench.arm_session(kArm);
    bench.command(kArm, wire::plain_command(wire::Op::CloseLight));
    ASSERT_TRUE(bench.reaches(kArm, StateId::Seated));
  }
  void squeeze(std::uint16_t set_dn, std::uint16_t permit_dn) {
    ASSERT_EQ(bench.result_of(kArm, wire::squeeze_command({set_dn, permit_dn})), wire::CommandResult::Ok);
  }
  Bench bench;
};

TEST_F(Force, approach_presses_lightly) {
  int most_dn = 0;
  bench.after_step = [&] { most_dn = std::max(most_dn, jaw().squeeze_dn()); };
  seat();
  bench.run(500);
  EXPECT_GT(jaw().squeeze_dn(), 100);
  EXPECT_LE(most_dn, 120 + 120);
}

TEST_F(Force, rises_no_faster_than_the_ramp_and_never_over_the_set_point_by_more_than_u) {
  seat();
  squeeze(800, 1400);
  int most_dn = 0;
  int before_dn = jaw().squeeze_dn();
  int steepest_dn = 0;
  bench.after_step = [&] {
    steepest_dn = std::max(steepest_dn, jaw().squeeze_dn() - before_dn);
    before_dn = jaw().squeeze_dn();
    most_dn = std::max(most_dn, before_dn);
  };
  ASSERT_TRUE(bench.reaches(kArm, StateId::Hold));
  bench.run(500);
  EXPECT_LE(steepest_dn, 6);
  EXPECT_LE(most_dn, 800 + 120);
  EXPECT_GE(jaw().squeeze_dn(), 800 - 120);
}

TEST_F(Force, holds_with_the_check_valve_shut_and_does_not_hunt) {
  bench.load_gripper(kArm);
  bench.run(500);
  int switched = 0;
  bench.after_step = [&] { switched += bench.arm().outputs.valves.spool == Spool::Hold ? 0 : 1; };
  bench.run(2000);
  EXPECT_EQ(switched, 0);
}

TEST_F(Force, refills_what_leaks) {
  bench.load_gripper(kArm);
  int fills_ms = 0;
  bench.after_step = [&] { fills_ms += bench.arm().outputs.valves.spool == Spool::Close ? 1 : 0; };
  for (int i = 0; i < 20; ++i) {
    jaw().close_mbar -= 10;
    bench.run(100);
    EXPECT_EQ(bench.arm().id(), StateId::Hold);
  }
  EXPECT_GT(fills_ms, 0);
  EXPECT_GE(jaw().squeeze_dn(), 400);
}

TEST_F(Force, that_is_lost_while_sole_is_reported_and_the_part_kept) {
  bench.load_gripper(kArm);
  jaw().supply_mbar = 0;
  jaw().leak_permille = 20;
  bench.run(600);
  EXPECT_EQ(bench.arm().id(), StateId::Hold);
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::HoldLost));
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::SupplyAirLow));
  EXPECT_NE(bench.arm().outputs.valves.spool, Spool::Open);
}

TEST_F(Force, over_the_limit_while_squeezing_falls_back_to_light) {
  seat();
  squeeze(520, 640);
  jaw().regulator_stuck_open = true;
  ASSERT_TRUE(bench.run_until(2000, [&] { return bench.arm().id() == StateId::Seated; }));
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::OverForce));
  EXPECT_FALSE(bench.arm().core.gate.armed()) << "a fault ends the session";
}

/// The regulator sticks open in the middle of a squeeze to 52 N; all the controller can do then is to want
/// less.
int most_force_with_a_stuck_regulator_dn(bool guard) {
  Bench bench;
  bench.arm().config.force_guard_enabled = guard;
  bench.load_all();
  ToyJaw& jaw = bench.arm().jaw;
  bench.bring_part(kArm, true);
  jaw.local_enable = true;
  bench.arm_session(kArm);
  bench.command(kArm, wire::plain_command(wire::Op::CloseLight));
  bench.reaches(kArm, StateId::Seated);
  bench.command(kArm, wire::squeeze_command({520, 800}));
  int most_dn = 0;
  bench.after_step = [&] { most_dn = std::max(most_dn, jaw.squeeze_dn()); };
  bench.run(50);
  jaw.regulator_stuck_open = true;
  bench.run(3000);
  return most_dn;
}

TEST_F(Force, guard_keeps_the_limit_when_the_regulator_sticks_open) {
  EXPECT_LE(most_force_with_a_stuck_regulator_dn(true), 800);
}

TEST_F(Force, without_the_guard_the_same_failure_exceeds_the_limit) {
  EXPECT_GT(most_force_with_a_stuck_regulator_dn(false), 800);
}

int most_force_of_a_runaway_dn(bool guard) {
  Config config;
  config.force_guard_enabled = guard;
  ToyJaw jaw;
  jaw.part_10um = 3000;
  jaw.separation_10um = 3000;
  jaw.regulator_stuck_open = true;
  ForceGuard state;
  int most_dn = 0;
  for (int ms = 0; ms < 3000; ++ms) {
    const Valves runaway{.spool = Spool::Close, .close_set_mbar = 20000};
    jaw.step(guarded(config, 1000, jaw.read(), 1, runaway, state));
    most_dn = std::max(most_dn, jaw.squeeze_dn());
  }
  return most_dn;
}

TEST_F(Force, guard_alone_stops_a_runaway) {
  EXPECT_LE(most_force_of_a_runaway_dn(true), 1000);
}

TEST_F(Force, without_the_guard_a_runaway_exceeds_the_limit) {
  EXPECT_GT(most_force_of_a_runaway_dn(false), 1000);
}

TEST_F(Force, guard_never_raises_what_is_wanted) {
  const Config config;
  ForceGuard state;
  for (int close_mbar = 0; close_mbar < 6000; close_mbar += 500) {
    for (int set_mbar = 0; set_mbar < 6000; set_mbar += 500) {
      const Sensors sensors{.close_mbar = {close_mbar, close_mbar}};
      const Valves wanted{.spool = Spool::Close, .close_set_mbar = set_mbar};
      const Valves allowed = guarded(config, 900, sensors, 1, wanted, state);
      EXPECT_LE(allowed.close_set_mbar, set_mbar);
      EXPECT_NE(allowed.spool, Spool::Open);
      EXPECT_LE(pressure_mbar(config, 0, 0) + squeeze_dn(config, allowed.close_set_mbar * 1000, 0), 900);
    }
  }
}

TEST_F(Force, set_point_and_uncertainty_stay_within_the_effective_limit_in_every_state) {
  bench.after_step = [&] {
    for (const std::uint8_t node : {kArm, kPedestal}) {
      const State& core = bench.at(node).core;
      if (force_set_dn(core) == 0) continue;
      ASSERT_LE(force_set_dn(core) + core.config.uncertainty_dn, force_limit_dn(core));
    }
  };
  bench.load_gripper(kArm);
  ASSERT_TRUE(bench.hand_over(kArm, kPedestal));
}

TEST_F(Force, misses_the_part_and_says_so) {
  jaw().local_enable = true;
  bench.arm_session(kArm);
  bench.command(kArm, wire::plain_command(wire::Op::CloseLight));
  ASSERT_TRUE(bench.reaches(kArm, StateId::FaultEmpty));
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::NoPart));
  bench.arm_session(kArm);
  EXPECT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::ClearFault)), wire::CommandResult::Ok);
  EXPECT_EQ(bench.arm().id(), StateId::Loaded);
}

TEST_F(Force, blocked_short_of_the_part_says_so_and_opens_on_abort) {
  jaw().part_10um = 3300;
  jaw().local_enable = true;
  bench.arm_session(kArm);
  bench.command(kArm, wire::plain_command(wire::Op::CloseLight));
  ASSERT_TRUE(bench.reaches(kArm, StateId::FaultEmpty));
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::MisSeated));
  bench.run(100);
  EXPECT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::ClearFault)),
            wire::CommandResult::BadSession);
  bench.arm_session(kArm);
  EXPECT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::ClearFault)), wire::CommandResult::Refused);
  EXPECT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::Abort)), wire::CommandResult::Ok);
  EXPECT_EQ(bench.arm().id(), StateId::Ready);
  bench.run(500);
  EXPECT_GE(jaw().separation_10um, 4900);
}

TEST_F(Force, sensors_that_disagree_stop_a_squeeze) {
  seat();
  squeeze(520, 1400);
  jaw().offset_a_mbar = 400;
  EXPECT_TRUE(bench.reaches(kArm, StateId::FaultEmpty, 10));
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::SensorsDisagree));
}

}  // namespace
}  // namespace pinjaw::core::test

// Promises: I3, I5, I6.
#include <gtest/gtest.h>

#include "tests/firmware_sim/core/bench.hpp"

/// I6: nothing opens because something was not heard.
namespace pinjaw::core::test {
namespace {

struct Silence : testing::Test {
  Silence() { bench.load_all(); }

  /// The host falls silent; for a while no valve may open anything that was not already decided.
  void host_dies_and_nothing_opens(std::uint8_t node, int ms = 3000) {
    bench.host_alive = false;
    bench.after_step = [this, node] { ASSERT_NE(bench.at(node).outputs.valves.spool, Spool::Open); };
    bench.run(ms);
    bench.after_step = nullptr;
  }
  void start_to_seat(std::uint8_t node) {
    bench.bring_part(node, true);
    bench.at(node).jaw.local_enable = true;
    bench.arm_session(node);
    bench.command(node, wire::plain_command(wire::Op::CloseLight));
  }
  void seat(std::uint8_t node) {
    start_to_seat(node);
    ASSERT_TRUE(bench.reaches(node, StateId::Seated));
  }
  void offer_and_accept() {
    bench.load_gripper(kArm);
    bench.arm_session(kPedestal);
    bench.bring_part(kPedestal, true);
    ASSERT_EQ(bench.result_of(kArm, wire::offer_command(kPedestal)), wire::CommandResult::Ok);
    bench.run(100);
    ASSERT_EQ(bench.result_of(kPedestal, wire::accept_command(kArm)), wire::CommandResult::Ok);
  }
  Bench bench;
};

TEST_F(Silence, of_the_host_ends_the_session_after_200_ms) {
  bench.arm_session(kArm);
  bench.host_alive = false;
  bench.run(140);
  EXPECT_TRUE(bench.arm().core.gate.armed());
  bench.run(70);
  EXPECT_FALSE(bench.arm().core.gate.armed());
  EXPECT_EQ(bench.arm().id(), StateId::Loaded);
}

TEST_F(Silence, of_a_host_never_heard_is_the_same_as_lost) {
  Bench quiet;
  quiet.host_alive = false;
  quiet.load_all();
  EXPECT_FALSE(quiet.arm().core.host.alive());
  EXPECT_TRUE(quiet.arm().core.faults.active(wire::FaultCode::HostLost));
}

TEST_F(Silence, while_open_stops_the_jaws) {
  bench.arm_session(kArm);
  host_dies_and_nothing_opens(kArm);
  EXPECT_EQ(bench.arm().id(), StateId::Loaded);
}

TEST_F(Silence, while_seating_at_the_part_keeps_the_light_squeeze) {
  start_to_seat(kArm);
  ASSERT_TRUE(bench.run_until(3000, [&] { return bench.arm().jaw.squeeze_dn() > 50; }));
  host_dies_and_nothing_opens(kArm);
  EXPECT_EQ(bench.arm().id(), StateId::Seated);
  EXPECT_GT(bench.arm().jaw.squeeze_dn(), 90);
  EXPECT_LT(bench.arm().jaw.squeeze_dn(), 240);
}

/// I3: what is not permitted any more does not go on. Air that is shut in may push the jaws on for a while.
TEST_F(Silence, of_the_permit_ends_an_approach_until_it_is_back) {
  start_to_seat(kArm);
  bench.run(20);
  bench.host_permit = 0;
  bench.run(60);
  bench.after_step = [this] { ASSERT_EQ(bench.arm().outputs.valves, Valves{}); };
  bench.run(4000);
  bench.after_step = nullptr;
  ASSERT_EQ(bench.arm().id(), StateId::Seating) << "nor does its time run out";
  bench.host_permit = 0x3FFF;
  EXPECT_TRUE(bench.reaches(kArm, StateId::Seated));
}

TEST_F(Silence, of_the_permit_ends_a_squeeze) {
  seat(kArm);
  bench.command(kArm, wire::squeeze_command({1200, 1400}));
  bench.run(20);
  ASSERT_EQ(bench.arm().id(), StateId::Squeezing);
  bench.host_permit = 0;
  bench.run(60);
  EXPECT_EQ(bench.arm().id(), StateId::Seated);
  bench.run(1000);
  EXPECT_LT(bench.arm().jaw.squeeze_dn(), 240);
}

/// Another host is no reason to go on with what the first one began.
TEST_F(Silence, of_the_first_host_ends_a_squeeze_and_an_offer_also_where_a_second_one_is_heard) {
  for (const bool offers : {false, true}) {
    bench = Bench();
    bench.load_all();
    if (offers) {
      bench.load_gripper(kArm);
      ASSERT_EQ(bench.result_of(kArm, wire::offer_command(kPedestal)), wire::CommandResult::Ok);
    } else {
      seat(kArm);
      bench.command(kArm, wire::squeeze_command({1200, 1400}));
    }
    bench.run(20);
    ASSERT_EQ(bench.arm().id(), offers ? StateId::Offered : StateId::Squeezing);
    bench.epoch ^= 0x55U;
    bench.run(600);
    EXPECT_TRUE(bench.arm().core.host.alive());
    EXPECT_EQ(bench.arm().id(), offers ? StateId::Hold : StateId::Seated);
  }
}

TEST_F(Silence, while_squeezing_goes_back_to_light_and_stays_closed) {
  seat(kArm);
  bench.command(kArm, wire::squeeze_command({1200, 1400}));
  ASSERT_EQ(bench.arm().id(), StateId::Squeezing);
  bench.host_alive = false;
  bench.run(10);
  host_dies_and_nothing_opens(kArm);
  const StateId id = bench.arm().id();
  EXPECT_TRUE(id == StateId::Seated || id == StateId::Hold);
  EXPECT_GT(bench.arm().jaw.squeeze_dn(), 90);
}

TEST_F(Silence, while_sole_changes_no_force) {
  bench.load_gripper(kArm);
  bench.run(500);
  const int before_dn = bench.arm().jaw.squeeze_dn();
  host_dies_and_nothing_opens(kArm, 20000);
  EXPECT_EQ(bench.arm().id(), StateId::Hold);
  EXPECT_EQ(bench.arm().jaw.squeeze_dn(), before_dn);
}

TEST_F(Silence, while_offered_without_an_answer_takes_the_offer_back) {
  bench.load_gripper(kArm);
  bench.command(kArm, wire::offer_command(kPedestal));
  host_dies_and_nothing_opens(kArm);
  EXPECT_EQ(bench.arm().id(), StateId::Hold);
  EXPECT_EQ(bench.arm().core.announced.fact, wire::Fact::Retain);
}

TEST_F(Silence, after_the_receiver_has_taken_lets_the_handoff_complete_between_the_nodes) {
  offer_and_accept();
  ASSERT_TRUE(bench.reaches(kPedestal, StateId::Seated));
  bench.command(kPedestal, wire::squeeze_command({520, 1400}));
  ASSERT_TRUE(bench.reaches(kPedestal, StateId::Taken));
  bench.host_alive = false;
  EXPECT_TRUE(bench.reaches(kPedestal, StateId::Hold));
  EXPECT_GE(bench.pedestal().jaw.squeeze_dn(), 400);
  bench.run(300);
  EXPECT_EQ(bench.arm().id(), StateId::Loaded);
  EXPECT_EQ(bench.arm().core.announced.fact, wire::Fact::Released) << "said until the next grasp";
}

TEST_F(Silence, of_everyone_leaves_a_latched_receiver_holding_in_doubt) {
  offer_and_accept();
  ASSERT_TRUE(bench.reaches(kPedestal, StateId::Seated));
  bench.command(kPedestal, wire::squeeze_command({520, 1400}));
  ASSERT_TRUE(bench.reaches(kPedestal, StateId::Taken));
  bench.arm().power_off();
  host_dies_and_nothing_opens(kPedestal, 10000);
  EXPECT_EQ(bench.pedestal().id(), StateId::Taken);
  EXPECT_TRUE(bench.pedestal().core.faults.active(wire::FaultCode::InDoubt));
  EXPECT_GE(bench.pedestal().jaw.squeeze_dn(), 400);
}

TEST_F(Silence, of_the_giver_keeps_a_seated_receiver_from_squeezing) {
  offer_and_accept();
  ASSERT_TRUE(bench.reaches(kPedestal, StateId::Seated));
  bench.arm().power_off();
  bench.run(100);
  const auto answer = bench.command(kPedestal, wire::squeeze_command({520, 1400}));
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->reason, wire::Reason::PeerStale);
  EXPECT_EQ(bench.result_of(kPedestal, wire::plain_command(wire::Op::Abort)), wire::CommandResult::Refused)
      << "nobody says that somebody else holds the part";
}

TEST_F(Silence, between_two_heartbeats_with_one_repeated_is_no_silence) {
  bench.arm_session(kArm);
  bench.run(1);
  bench.inject(
      wire::pack(wire::HostHeartbeat{.permit = 0x3FFF, .epoch = bench.epoch}, {.node = 0, .counter = 0}));
  bench.run(400);
  EXPECT_TRUE(bench.arm().core.gate.armed());
}

TEST_F(Silence, after_global_hold_lasts_until_a_new_arm) {
  bench.bring_part(kArm, true);
  bench.arm().jaw.local_enable = true;
  bench.arm_session(kArm);
  bench.command(kArm, wire::plain_command(wire::Op::CloseLight));
  bench.run(50);
  ASSERT_EQ(bench.arm().id(), StateId::Seating);
  bench.inject(wire::pack(wire::GlobalHold{}, {.node = 0, .counter = 0}));
  bench.run(60);
  const int stopped_10um = bench.arm().jaw.separation_10um;
  bench.run(1000);
  EXPECT_EQ(bench.arm().id(), StateId::Seating);
  EXPECT_NEAR(bench.arm().jaw.separation_10um, stopped_10um, 1000);
  EXPECT_EQ(bench.arm().outputs.valves.spool, Spool::Hold);
  bench.arm_session(kArm);
  EXPECT_TRUE(bench.reaches(kArm, StateId::Seated));
}

}  // namespace
}  // namespace pinjaw::core::test

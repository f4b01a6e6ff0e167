// Promises: R1, R5, R6, I7.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/firmware_sim/core/bench.hpp"

/// I7: a controller that held before a power cut holds after it.
namespace pinjaw::core::test {
namespace {

struct Recovery : testing::Test {
  Recovery() { bench.load_all(); }
  void cut_power(std::uint8_t node, int off_ms = 50) {
    bench.at(node).power_off();
    bench.run(off_ms);
    bench.at(node).power_on_again();
  }
  void until_taken() {
    bench.load_gripper(kArm);
    ASSERT_TRUE(bench.seat(kArm, kPedestal));
    ASSERT_TRUE(bench.squeeze(kPedestal));
    ASSERT_TRUE(bench.reaches(kPedestal, StateId::Taken));
  }
  Bench bench;
};

TEST_F(Recovery, of_a_sole_holder_holds) {
  bench.load_gripper(kArm);
  bench.run(20);
  cut_power(kArm);
  bench.run(3);
  EXPECT_EQ(bench.arm().id(), StateId::Hold);
  bench.run(1000);
  EXPECT_GE(bench.arm().jaw.squeeze_dn(), 400);
  EXPECT_EQ(bench.arm().core.announced.fact, wire::Fact::Sole);
}

TEST_F(Recovery, of_a_sole_holder_can_still_hand_over) {
  bench.load_gripper(kArm);
  bench.run(20);
  cut_power(kArm);
  bench.run(500);
  EXPECT_TRUE(bench.hand_over(kArm, kPedestal));
}

TEST_F(Recovery, of_a_giver_with_an_offer_out_takes_it_back_only_with_a_good_hold) {
  bench.load_gripper(kArm);
  bench.command(kArm, wire::offer_command(kPedestal));
  bench.run(20);
  cut_power(kArm);
  bench.after_step = [&] {
    const bool retains = bench.arm().core.announced.fact == wire::Fact::Retain;
    ASSERT_TRUE(!retains || bench.arm().jaw.squeeze_dn() >= 400);
  };
  EXPECT_TRUE(bench.reaches(kArm, StateId::Resqueeze, 5));
  EXPECT_TRUE(bench.reaches(kArm, StateId::Hold));
  bench.run(20);
  EXPECT_EQ(bench.arm().core.announced.fact, wire::Fact::Retain);
}

TEST_F(Recovery, of_a_latched_receiver_stays_latched_and_completes) {
  until_taken();
  bench.run(10);
  cut_power(kPedestal, 20);
  bench.run(3);
  EXPECT_EQ(bench.pedestal().id(), StateId::Taken);
  EXPECT_EQ(bench.pedestal().core.announced.fact, wire::Fact::Unknown)
      << "no TAKE before the hold is good again";
  EXPECT_TRUE(bench.reaches(kPedestal, StateId::Hold)) << "the giver decides when it hears TAKE again";
}

TEST_F(Recovery, after_the_decision_goes_on_opening) {
  until_taken();
  ASSERT_TRUE(bench.reaches(kArm, StateId::Opening));
  bench.run(2);
  ASSERT_EQ(bench.arm().memory.record->custody, Custody::Decided);
  cut_power(kArm, 10);
  EXPECT_TRUE(bench.reaches(kArm, StateId::Loaded, 2000));
  EXPECT_TRUE(bench.reaches(kPedestal, StateId::Hold));
}

TEST_F(Recovery, with_unreadable_memory_holds_and_says_so) {
  bench.load_gripper(kArm);
  bench.arm().power_off();
  bench.arm().memory.readable = false;
  bench.arm().power_on_again();
  bench.run(10);
  EXPECT_EQ(bench.arm().id(), StateId::FaultHold);
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::CustodyMemory));
  EXPECT_EQ(bench.arm().outputs.valves, Valves{});
}

/// I5: what a processor that hung has done is not trusted further than the hold.
TEST_F(Recovery, by_the_watchdog_holds_and_gives_nothing_away_until_the_fault_is_cleared) {
  bench.load_gripper(kArm);
  bench.arm().power_off();
  bench.arm().memory.reset = wire::ResetCause::Watchdog;
  bench.arm().power_on_again();
  ASSERT_TRUE(bench.reaches(kArm, StateId::Hold));
  EXPECT_TRUE(bench.arm().core.faults.active(wire::FaultCode::Watchdog));
  bench.run(300);  // until it believes its host again
  bench.arm_session(kArm);
  EXPECT_EQ(bench.result_of(kArm, wire::offer_command(kPedestal)), wire::CommandResult::Refused);
  EXPECT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::ClearFault)), wire::CommandResult::Ok);
  bench.arm_session(kArm);
  EXPECT_EQ(bench.result_of(kArm, wire::offer_command(kPedestal)), wire::CommandResult::Ok);
}

TEST_F(Recovery, with_a_part_felt_and_no_record_holds_until_the_operator_decides) {
  bench.arm().jaw.separation_10um = 3000;
  bench.bring_part(kArm, true);
  bench.arm().power_on_again();
  bench.run(300);
  ASSERT_EQ(bench.arm().id(), StateId::FaultHold);
  bench.arm_session(kArm);
  EXPECT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::ClearFault)), wire::CommandResult::Refused)
      << "another node may answer for the part";
  bench.arm().jaw.local_enable = true;
  EXPECT_EQ(bench.result_of(kArm, wire::plain_command(wire::Op::ClearFault)), wire::CommandResult::Ok);
  EXPECT_TRUE(bench.reaches(kArm, StateId::Hold, 10));
  bench.run(1000);
  EXPECT_GE(bench.arm().jaw.squeeze_dn(), 400);
}

TEST_F(Recovery, never_gives_out_a_session_twice) {
  std::vector<std::uint16_t> seen;
  for (int boot = 0; boot < 3; ++boot) {
    for (int i = 0; i < 40; ++i) {
      const auto answer = bench.arm_session(kArm);
      ASSERT_TRUE(answer.has_value());
      if (answer->result != wire::CommandResult::Ok) continue;
      EXPECT_EQ(std::find(seen.begin(), seen.end(), answer->session), seen.end());
      seen.push_back(answer->session);
    }
    cut_power(kArm);
    bench.run(200);
  }
  EXPECT_GT(seen.size(), 100U);
}

TEST_F(Recovery, of_memory_that_fails_tells_nobody_a_fact_that_is_not_stored) {
  bench.load_gripper(kArm);
  bench.run(20);
  bench.arm().memory_fails = true;
  bench.command(kArm, wire::offer_command(kPedestal));
  bench.run(100);
  EXPECT_NE(bench.arm().core.announced.fact, wire::Fact::Offer);
  EXPECT_TRUE(holds(bench.arm().id()));
}

struct Found {
  const char* what;
  Custody custody;
  StateId state;
  wire::Fact fact;  ///< said once the hold is good
};

/// Every record there is, found at power on by a gripper and by a passive station with the part in it.
TEST_F(Recovery, follows_from_every_record_alone) {
  constexpr Found kFound[] = {
      {"nothing recorded, part felt", Custody::Empty, StateId::FaultHold, wire::Fact::Empty},
      {"sole", Custody::Sole, StateId::Hold, wire::Fact::Sole},
      {"offered", Custody::Offered, StateId::Hold, wire::Fact::Retain},
      {"latched", Custody::Latched, StateId::Taken, wire::Fact::Take},
      {"retained", Custody::Retained, StateId::Hold, wire::Fact::Retain},
      {"released, part felt", Custody::Released, StateId::FaultHold, wire::Fact::Released},
  };
  for (const std::uint8_t node : {kArm, kPallet}) {
    for (const Found& found : kFound) {
      Bench fresh;
      fresh.load_all();
      if (node == kPallet) {
        fresh.load_pallet();
      } else {
        fresh.load_gripper(node);
      }
      fresh.run(50);
      fresh.at(node).power_off();
      NvmRecord record = *fresh.at(node).memory.record;
      record.custody = found.custody;
      record.peer = kPedestal;
      record.token = 9;
      record.pair = layout_for(node).peer(kPedestal)->pair_crc;
      fresh.at(node).memory.record = record;
      fresh.at(node).power_on_again();
      fresh.run(1500);
      EXPECT_EQ(fresh.at(node).id(), found.state) << found.what << " at node " << int{node};
      EXPECT_EQ(fresh.at(node).core.announced.fact, found.fact) << found.what << " at node " << int{node};
      EXPECT_NE(fresh.at(node).outputs.valves.spool, Spool::Open) << found.what;
      EXPECT_GE(fresh.at(node).jaw.squeeze_dn(), node == kArm ? 400 : 0) << found.what;
    }
  }
}

TEST_F(Recovery, of_a_receiver_in_doubt_goes_on_saying_take_and_reports_the_doubt) {
  until_taken();
  bench.arm().power_off();
  bench.run(1900);
  EXPECT_FALSE(bench.pedestal().core.faults.active(wire::FaultCode::InDoubt));
  bench.run(200);
  EXPECT_TRUE(bench.pedestal().core.faults.active(wire::FaultCode::InDoubt));
  bench.run(60'000);
  EXPECT_EQ(bench.pedestal().id(), StateId::Taken);
  EXPECT_EQ(bench.pedestal().core.announced.fact, wire::Fact::Take);
  bench.arm().power_on_again();
  EXPECT_TRUE(bench.run_until(5000, [&] {
    const StateId id = bench.pedestal().id();
    return id == StateId::Hold || id == StateId::Seated;
  })) << "the giver's word settles it";
  EXPECT_FALSE(bench.pedestal().core.faults.active(wire::FaultCode::InDoubt));
}

}  // namespace
}  // namespace pinjaw::core::test

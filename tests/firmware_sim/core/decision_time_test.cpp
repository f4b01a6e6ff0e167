// Promises: TIME-DECISION.
// From a frame that came to the valve it moves: counted in steps of 1 ms of the controller. A frame is read
// in the step after its last bit, and acts on the valves in that same step.
#include <gtest/gtest.h>

#include <optional>

#include "protocol/wire/codec.hpp"
#include "tests/firmware_sim/core/bench.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::core::test {
namespace {

/// Steps after the one that reads the frame until the valves change; counted by its after_step.
struct Decision : testing::Test {
  static constexpr int kNever = 1000;

  Decision() { bench.load_all(); }

  /// Gives `frame` to all, and lets time pass until `changed`.
  int steps_until(const wire::Frame& frame, const std::function<bool(const Valves&)>& changed) {
    bench.inject(frame);
    for (int step = 0; step < kNever; ++step) {
      bench.run(1);
      if (changed(bench.arm().outputs.valves)) return step;
    }
    return kNever;
  }

  void begin_to_close() {
    bench.bring_part(kArm, true);
    bench.arm().jaw.local_enable = true;
    ASSERT_TRUE(bench.arm_session(kArm));
    ASSERT_TRUE(bench.reaches(kArm, StateId::Ready));
    ASSERT_TRUE(bench.command(kArm, wire::plain_command(wire::Op::CloseLight)));
  }

  static void state(const char* what, int steps) {
    pinjaw::test::figure("TIME-DECISION", what, steps, "steps");
  }

  Bench bench;
};

TEST_F(Decision, a_command_moves_the_valve_in_the_step_that_answers_it_or_the_next) {
  bench.bring_part(kArm, true);
  bench.arm().jaw.local_enable = true;
  ASSERT_TRUE(bench.arm_session(kArm));
  ASSERT_TRUE(bench.reaches(kArm, StateId::Ready));
  bench.run(50);
  ASSERT_EQ(bench.arm().outputs.valves.spool, Spool::Hold);
  std::optional<int> answered_ms;
  std::optional<int> moved_ms;
  bench.after_step = [&] {
    for (const wire::Frame& frame : bench.arm().outputs.send.view()) {
      if (frame.id == wire::id_of({wire::MessageType::Acknowledge, kArm}) && !answered_ms)
        answered_ms = bench.now_ms;
    }
    if (bench.arm().outputs.valves.spool != Spool::Hold && !moved_ms) moved_ms = bench.now_ms;
  };
  ASSERT_TRUE(bench.command(kArm, wire::plain_command(wire::Op::CloseLight)));
  bench.run(50);
  ASSERT_TRUE(answered_ms && moved_ms);
  EXPECT_GE(*moved_ms, *answered_ms);
  EXPECT_LE(*moved_ms, *answered_ms + 1) << "a new state moves the jaws from the step after";
  state("CMD to valve", *moved_ms - *answered_ms);
}

TEST_F(Decision, everyone_s_hold_stops_the_jaws_in_the_step_that_reads_it) {
  begin_to_close();
  ASSERT_TRUE(bench.run_until(500, [&] { return bench.arm().outputs.valves.spool == Spool::Close; }));
  const wire::Frame hold = wire::pack(wire::GlobalHold{}, {.node = kPedestal, .counter = 1});
  const int steps = steps_until(hold, [](const Valves& valves) { return valves.spool == Spool::Hold; });
  EXPECT_EQ(steps, 0);
  state("GLOBAL_HOLD to valve", steps);
}

TEST_F(Decision, without_that_frame_the_jaws_go_on) {
  begin_to_close();
  ASSERT_TRUE(bench.run_until(500, [&] { return bench.arm().outputs.valves.spool == Spool::Close; }));
  wire::Frame broken = wire::pack(wire::GlobalHold{}, {.node = kPedestal, .counter = 1});
  broken.data[0] ^= 1U;
  const int steps = steps_until(broken, [](const Valves& valves) { return valves.spool == Spool::Hold; });
  EXPECT_GT(steps, 0);
}

TEST_F(Decision, a_receiver_that_loses_its_hold_ends_the_giver_s_relaxing_in_the_step_that_reads_it) {
  bench.load_gripper(kArm);
  bench.arm_session(kPedestal);
  bool relaxed = false;
  std::optional<int> said_ms;
  std::optional<int> stopped_ms;
  bench.after_step = [&] {
    if (bench.arm().id() == StateId::Relax && !relaxed) {
      relaxed = true;
      bench.pedestal().jaw.leak_permille = 900;
    }
    if (!relaxed) return;
    for (const wire::Frame& frame : bench.pedestal().outputs.send.view()) {
      const bool unstable = frame.id == wire::id_of({wire::MessageType::State, kPedestal}) &&
                            (frame.data[3] >> 1 & 1U) == 0;  // HOLD_STABLE, bit 25
      const bool fault = frame.id == wire::id_of({wire::MessageType::Fault, kPedestal});
      if ((unstable || fault) && !said_ms) said_ms = bench.now_ms;
    }
    if (bench.arm().id() == StateId::Resqueeze && !stopped_ms) stopped_ms = bench.now_ms;
  };
  bench.hand_over(kArm, kPedestal);
  ASSERT_TRUE(relaxed);
  ASSERT_TRUE(said_ms && stopped_ms);
  EXPECT_LE(*stopped_ms - *said_ms, 1) << "a frame of one step is read in the next";
  state("receiver's lost hold to giver's decision", *stopped_ms - *said_ms);
}

}  // namespace
}  // namespace pinjaw::core::test

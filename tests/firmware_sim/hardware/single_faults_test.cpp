// Promises: I1, I5, HW-FAULT.
/// Every single fault of the hardware in every state of a handoff from node 1 to node 2.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "firmware_sim/core/guards.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/nightly.hpp"

namespace pinjaw::test {
namespace {

using wire::State;

constexpr double kSingleFault_n = 1.10 * 140;  // I1, of the hardware's limit
constexpr double kThrown_n = 2.1 * 140;        // measured: 2.04
constexpr int kDecision_ms = 3;                // I5

/// Where the fault strikes: a node in a state of the handoff.
struct Moment {
  int node = 1;
  State state = State::Hold;
};

constexpr Moment kMoments[] = {
    {1, State::Hold},    {1, State::Offered}, {1, State::Relax},     {1, State::Opening}, {2, State::Ready},
    {2, State::Seating}, {2, State::Seated},  {2, State::Squeezing}, {2, State::Taken},
};

// Offsets and drifts to either side; a leak that wants a refill now and then, and one that wants it all the
// time.
const std::vector<std::string> kFaults = {
    "leak=0.05",
    "leak=30",
    "spool_stuck",
    "spool_stuck_hold",
    "spool_stuck_close",
    "spool_stuck_open",
    "check_stuck_shut",
    "check_stuck_open",
    "vent_stuck_shut",
    "vent_stuck_open",
    "cut_stuck_off",
    "cut_stuck_on",
    "regulator_open",
    "regulator_closed",
    "regulator_stuck",
    "supply_lost",
    "sensor_a=600",
    "sensor_a=-600",
    "sensor_b=600",
    "sensor_b=-600",
    "sensor_open_a=600",
    "sensor_open_a=-600",
    "sensor_open_b=600",
    "sensor_open_b=-600",
    "sensor_a_drift=200",
    "sensor_a_drift=-200",
    "sensor_b_drift=200",
    "sensor_b_drift=-200",
    "sensor_open_a_drift=200",
    "sensor_open_b_drift=-200",
    "sensor_a_stuck",
    "sensor_b_stuck",
    "sensor_open_a_stuck",
    "sensor_open_b_stuck",
    "sensor_a_lost",
    "sensor_b_lost",
    "sensor_open_a_lost",
    "sensor_open_b_lost",
    "position=2",
    "position=-2",
    "position_drift=1",
    "position_drift=-1",
    "position_stuck",
    "position_lost",
};

/// Faults that a sensor shows at once, and so must be known within I5's time.
bool shows_at_once(const std::string& fault) {
  const bool pressure = fault.starts_with("sensor_") && fault.find("drift") == std::string::npos &&
                        fault.find("stuck") == std::string::npos;
  return pressure || fault == "position_lost";
}

/// What is seen of one run.
struct Outcome {
  bool struck = false;
  double peak_n = 0;
  bool dropped = false;
  int min_holders = 0;
  int known_after_ms = -1;  ///< the controller has raised a sensor's fault
  int unguarded_ms = 0;     ///< longest that sensor B was over the limit and the guard had not cut
  std::set<int> faults;     ///< that the struck node raised
};

class Striker {
 public:
  Striker(TestCell& cell, const Moment& moment, std::string fault)
      : cell_(cell), moment_(moment), fault_(std::move(fault)) {}

  void watch() {
    const node::Node& one = *cell_.world().find(moment_.node);
    if (armed && !seen.struck && one.firmware().id == moment_.state && ++waited_ms_ > 5) strike();
    if (seen.struck) ++since_ms_;
    for (const int number : {1, 2}) {
      seen.peak_n = std::max(seen.peak_n, cell_.world().find(number)->truth().most_n);
    }
    if (!seen.struck) return;
    const core::State& firmware = one.firmware();
    if (firmware.measurement.trouble != core::SensorTrouble::None && seen.known_after_ms < 0) {
      seen.known_after_ms = since_ms_ - 1;
    }
    unguarded_ms_ = firmware.guard.over_ms > 0 && !firmware.guard.cut ? unguarded_ms_ + 1 : 0;
    seen.unguarded_ms = std::max(seen.unguarded_ms, unguarded_ms_);
    for (const wire::FaultCode code : wire::kFaultCodes) {
      if (firmware.faults.active(code)) seen.faults.insert(static_cast<int>(code));
    }
  }

  bool armed = false;
  Outcome seen;

 private:
  void strike() {
    seen.struck = true;
    since_ms_ = 0;
    EXPECT_TRUE(std::holds_alternative<bench::Done>(cell_.ask(bench::Break{moment_.node, fault_}))) << fault_;
  }
  TestCell& cell_;
  Moment moment_;
  std::string fault_;
  int waited_ms_ = 0;
  int since_ms_ = 0;
  int unguarded_ms_ = 0;
};

Outcome strike(const Moment& moment, const std::string& fault, double receives_at_mm = 36) {
  TestCell cell({{.node = 1, .separation_mm = 30, .needed_n = 60},
                 {.node = 2, .separation_mm = receives_at_mm, .needed_n = 40}});
  cell.keep_logs(false);
  Striker striker(cell, moment, fault);
  cell.on_step([&] { striker.watch(); });
  EXPECT_TRUE(cell.commission() && cell.load(1));
  cell.run_ms(100);
  striker.armed = true;
  cell.run_ms(20);
  (void)cell.hand_over(1, 2);  // as far as it goes
  cell.run_ms(2000);
  Outcome seen = striker.seen;
  seen.dropped = cell.truth().dropped;
  seen.min_holders = cell.truth().min_holders.value_or(0);
  return seen;
}

/// A regulator that sticks open before the jaws have touched: resting seals let go at once, and what flowed
/// in before any valve could shut throws the jaws at the part. No command of the controller is in time;
/// I1's 1.10 is not kept here.
bool throws_jaws(const Moment& moment, const std::string& fault) {
  const bool on_the_way = moment.state == State::Ready || moment.state == State::Seating;
  return on_the_way && fault == "regulator_open";
}

TEST(HardwareFaults, a_regulator_that_sticks_open_before_the_touch_throws_the_jaws_no_harder_than_measured) {
  double worst_n = 0;
  for (const double at_mm : by_night<std::vector<double>>({54, 50, 46, 42, 38, 34, 30, 26, 22}, {50, 30})) {
    const Outcome seen = strike({2, State::Ready}, "regulator_open", at_mm);
    EXPECT_TRUE(seen.struck && !seen.dropped) << at_mm;
    worst_n = std::max(worst_n, seen.peak_n);
  }
  figure("HW-FAULT", "hardest touch with a regulator that sticks open before it", worst_n, "N");
  EXPECT_LE(worst_n, kThrown_n);
}

TEST(HardwareFaults, no_single_one_presses_over_the_relief_or_drops_a_part_that_can_be_held) {
  double worst_n = 0;
  std::string worst;
  int runs = 0;
  int held = 0;
  int slowest_ms = 0;
  int unguarded_ms = 0;
  const std::size_t every = by_night<std::size_t>(1, 7);  // a seventh by day, another fault in each state
  std::size_t next = 0;
  for (const Moment& moment : kMoments) {
    for (const std::string& fault : kFaults) {
      if (next++ % every != 0) continue;
      const std::string what = std::to_string(static_cast<int>(moment.state)) + " of node " +
                               std::to_string(moment.node) + ": " + fault;
      const Outcome seen = strike(moment, fault);
      EXPECT_TRUE(seen.struck) << what;
      ++runs;
      if (seen.peak_n > worst_n && !throws_jaws(moment, fault)) {
        worst_n = seen.peak_n;
        worst = what;
      }
      EXPECT_LE(seen.peak_n, throws_jaws(moment, fault) ? kThrown_n : kSingleFault_n) << what;
      EXPECT_LE(seen.unguarded_ms, kDecision_ms) << what;
      unguarded_ms = std::max(unguarded_ms, seen.unguarded_ms);
      if (shows_at_once(fault)) {
        EXPECT_GE(seen.known_after_ms, 0) << what;
        EXPECT_LE(seen.known_after_ms, kDecision_ms) << what;
        slowest_ms = std::max(slowest_ms, seen.known_after_ms);
      }
      EXPECT_FALSE(seen.dropped) << what;
      EXPECT_GE(seen.min_holders, 1) << what;
      held += seen.dropped ? 0 : 1;
    }
  }
  figure("HW-FAULT", "faults in states", runs);
  figure("HW-FAULT", "of them with the part held throughout", held);
  figure("HW-FAULT", "highest force", worst_n, "N (" + worst + ")");
  figure("HW-FAULT", "slowest decision on a sensor", slowest_ms, "ms");
  figure("HW-FAULT", "longest that the guard saw too much force and had not cut", unguarded_ms, "ms");
}

/// The fault that a sole holder reports within `wait_ms` of `fault`, or of whatever came of it.
std::set<int> reported(const std::string& fault, int wait_ms) {
  TestCell cell({{.node = 1, .separation_mm = 30, .needed_n = 60}});
  EXPECT_TRUE(cell.commission() && cell.load(1));
  cell.run_ms(2000);
  cell.ask(bench::Break{1, fault});
  std::set<int> codes;
  const core::State& firmware = cell.world().find(1)->firmware();
  for (int i = 0; i < wait_ms; ++i) {
    cell.advance();
    for (const wire::FaultCode code : wire::kFaultCodes) {
      if (firmware.faults.active(code)) codes.insert(static_cast<int>(code));
    }
  }
  return codes;
}

int number(wire::FaultCode code) {
  return static_cast<int>(code);
}

TEST(HardwareFaults, a_leak_that_the_loop_makes_up_for_is_told) {
  EXPECT_TRUE(reported("leak=0.2", 60000).contains(number(wire::FaultCode::Leak)));
  EXPECT_TRUE(reported("leak=0", 60000).empty()) << "a sound chamber is not suspected";
}

TEST(HardwareFaults, a_drifting_sensor_is_told_before_it_shifts_the_force_by_more_than_its_uncertainty) {
  for (const char* fault : {"sensor_a_drift=50", "sensor_a_drift=-50", "sensor_b_drift=50",
                            "sensor_b_drift=-50", "sensor_open_a_drift=50", "sensor_open_b_drift=-50"}) {
    EXPECT_TRUE(reported(fault, 11000).contains(number(wire::FaultCode::SensorsDisagree))) << fault;
  }
}

}  // namespace
}  // namespace pinjaw::test

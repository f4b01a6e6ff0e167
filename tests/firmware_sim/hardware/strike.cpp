#include "tests/firmware_sim/hardware/strike.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/firmware_sim/hardware/specimen.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"

namespace pinjaw::test {
namespace {

using wire::State;

constexpr int kRelaxed_ms = 150;  // of 200: there is something to squeeze again

/// The controller has decided that nothing may flow into the close chamber: over-force, or a fault's state.
bool has_decided(const core::State& firmware) {
  return firmware.guard.cut || firmware.id == State::FaultHold || firmware.id == State::FaultEmpty;
}

class Striker {
 public:
  Striker(TestCell& cell, const Moment& moment, std::string fault)
      : cell_(cell), moment_(moment), fault_(std::move(fault)) {}

  void watch() {
    const node::Node& one = *cell_.world().find(moment_.node);
    if (armed && moment_.state == State::Resqueeze) abort_in_time();
    if (armed && !seen.struck && one.firmware().id == moment_.state && ++waited_ms_ > moment_.after_ms)
      strike();
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
    watch_main_valve(one);
    for (const wire::FaultCode code : wire::kFaultCodes) {
      if (firmware.faults.active(code)) seen.faults.insert(static_cast<int>(code));
    }
  }

  bool armed = false;
  Outcome seen;

 private:
  void abort_in_time() {
    if (cell_.world().find(1)->firmware().id != State::Relax || ++relaxed_ms_ != kRelaxed_ms) return;
    cell_.host().send(1, wire::plain_command(wire::Op::Abort));
  }

  /// A valve that is told something else on its way starts anew.
  void watch_main_valve(const node::Node& one) {
    const core::Valves& told = one.told_valves();
    const bool decided = has_decided(one.firmware());
    seen.told_to_feed |= decided && told.spool == core::Spool::Close && !told.relax;
    const bool feeds = one.plant_state().spool == plant::Spool::Close && !told.relax;
    if (!decided || !feeds || told.spool != told_) unshut_ms_ = 0;
    if (decided && feeds) ++unshut_ms_;
    told_ = told.spool;
    seen.unshut_ms = std::max(seen.unshut_ms, unshut_ms_);
  }

  void strike() {
    seen.struck = true;
    since_ms_ = 0;
    EXPECT_TRUE(std::holds_alternative<bench::Done>(cell_.ask(bench::Break{moment_.node, fault_}))) << fault_;
  }
  TestCell& cell_;
  Moment moment_;
  std::string fault_;
  int relaxed_ms_ = 0;
  int waited_ms_ = 0;
  int since_ms_ = 0;
  int unguarded_ms_ = 0;
  int unshut_ms_ = 0;
  core::Spool told_ = core::Spool::Hold;
};

void draw_grippers(TestCell& cell, std::uint64_t seed) {
  Draws draws{{.state = seed * 0x9E3779B97F4A7C15U}};
  for (const int number : {1, 2}) draw_plant(draws, cell.world().find(number)->plant_for_tests());
}

}  // namespace

Outcome strike(const Moment& moment, const std::string& fault, const Cell& given) {
  const auto grip = [&](int node, double separation_mm, double needed_share) {
    return TestGrip{.node = node,
                    .separation_mm = separation_mm,
                    .needed_n = needed_share * given.size.max_squeeze_n,
                    .limit_n = given.size.max_squeeze_n,
                    .max_squeeze_n = given.size.max_squeeze_n,
                    .uncertainty_n = given.size.uncertainty_n,
                    .keeper_n = given.keeper_n};
  };
  TestCell cell({grip(1, 30, 60.0 / 140), grip(2, given.separation_mm, 40.0 / 140)});
  cell.keep_logs(false);
  if (given.specimen != 0) draw_grippers(cell, given.specimen);
  Striker striker(cell, moment, fault);
  cell.on_step([&] { striker.watch(); });
  if (!given.soft_start) cell.ask(bench::Break{2, "soft_start_stuck_open"});
  EXPECT_TRUE(cell.commission() && cell.load(1));
  if (given.opened_before) {
    EXPECT_TRUE(cell.hand_over(1, 2));
    cell.run_ms(300);  // until the giver is clear of the part
    EXPECT_TRUE(cell.hand_over(2, 1));
  }
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

}  // namespace pinjaw::test

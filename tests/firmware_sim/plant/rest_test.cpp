// Promises: PLANT-REST.
// A plant at rest takes a millisecond in one step, and nobody can tell.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware_sim/plant/stand.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::plant {
namespace {

constexpr int kFine = 50;  // of kStep_s in 1 ms

/// One millisecond, coasting where the plant rests; whether it did.
bool millisecond(Stand& stand, bool may_coast) {
  const bool rests = may_coast && at_rest(stand.parameters, stand.inputs, stand.state);
  if (rests) coast(stand.parameters, stand.inputs, kFine * kStep_s, stand.state);
  for (int i = 0; i < kFine && !rests; ++i) step(stand.parameters, stand.inputs, kStep_s, stand.state);
  return rests;
}

/// What a gripper lives through in a minute: closes, holds shut in, its neighbour moves, the regulator is
/// told something else, it opens, stands open.
void direct(Stand& stand, int ms) {
  Inputs& in = stand.inputs;
  if (ms == 0) in.actuation = {.spool = Spool::Close, .close_set_pa = 3e5};
  if (ms == 1000) in.actuation = {.spool = Spool::Hold, .close_set_pa = 3e5};
  if (ms == 3000) in.neighbour_moves = true;
  if (ms == 4000) in.neighbour_moves = false;
  if (ms == 6000) in.actuation.close_set_pa = 2e5;
  if (ms == 20000) in.faults.supply_lost = true;
  if (ms == 22000) in.faults.supply_lost = false;
  if (ms == 30000) in.actuation = {.spool = Spool::Close, .close_set_pa = 4e5};
  if (ms == 31000) in.actuation = {.spool = Spool::Hold};
  if (ms == 50000) in.actuation = {.spool = Spool::Open};
  if (ms == 51000) in.actuation = {.spool = Spool::Hold};
}

struct Apart {
  double pressure_pa = 0;
  double force_n = 0;
  double position_m = 0;
  double supply_pa = 0;
  double regulator_pa = 0;
  double rested_share = 0;
};

Apart compare(AirLaw law, int duration_ms) {
  Stand fine = study_stand();
  fine.parameters.air.law = law;
  Stand fast = fine;
  Apart apart;
  for (int ms = 0; ms < duration_ms; ++ms) {
    direct(fine, ms);
    direct(fast, ms);
    millisecond(fine, false);
    apart.rested_share += millisecond(fast, true) ? 1.0 / duration_ms : 0.0;
    const State& a = fine.state;
    const State& b = fast.state;
    for (std::size_t i = 0; i < 4; ++i) {
      apart.pressure_pa = std::max(apart.pressure_pa, std::abs(a.sensed_pa.at(i) - b.sensed_pa.at(i)));
    }
    apart.force_n = std::max(apart.force_n, std::abs(squeeze_n(a) - squeeze_n(b)));
    apart.position_m = std::max(apart.position_m, 2 * std::abs(a.sensed_position_m - b.sensed_position_m));
    apart.supply_pa =
        std::max(apart.supply_pa, std::abs(a.supply_pa - a.droop_pa - b.supply_pa + b.droop_pa));
    apart.regulator_pa = std::max(apart.regulator_pa, std::abs(a.regulator_pa - b.regulator_pa));
  }
  return apart;
}

TEST(Rest, a_millisecond_in_one_step_reads_as_fifty_steps_do) {
  for (const AirLaw law : {AirLaw::Polytropic, AirLaw::EnergyBalance}) {
    const Apart apart = compare(law, 60000);
    const bool poly = law == AirLaw::Polytropic;
    test::figure("PLANT-REST", poly ? "force apart, polytropic" : "force apart, energy balance",
                 apart.force_n, "N");
    test::figure("PLANT-REST", poly ? "pressure apart, polytropic" : "pressure apart, energy balance",
                 apart.pressure_pa, "Pa");
    EXPECT_GT(apart.rested_share, 0.6);
    EXPECT_LT(apart.pressure_pa, 240) << "one step of the pressure sensor";
    EXPECT_LT(apart.force_n, 0.1);
    EXPECT_LT(apart.position_m, 1e-6) << "a tenth of the position sensor's step";
    EXPECT_LT(apart.supply_pa, 0.02 * 6e5);
    EXPECT_LT(apart.regulator_pa, 0.02 * 6e5);
  }
}

/// Whether a plant that came to rest while it held still does after `change`.
bool still_rests(const std::function<void(Stand&)>& change) {
  Stand stand = study_stand();
  stand.inputs.actuation = {.spool = Spool::Close, .close_set_pa = 3e5};
  stand.run(1.0);
  stand.inputs.actuation = {};
  stand.run(1.0);
  EXPECT_TRUE(at_rest(stand.parameters, stand.inputs, stand.state));
  change(stand);
  return at_rest(stand.parameters, stand.inputs, stand.state);
}

TEST(Rest, whatever_could_move_something_ends_it) {
  EXPECT_TRUE(still_rests([](Stand& s) { s.inputs.neighbour_moves = true; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.inputs.actuation.spool = Spool::Close; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.inputs.actuation.spool = Spool::Open; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.inputs.contact.present = false; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.inputs.contact.separation_m += 1e-5; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.inputs.faults.close_leak.conductance_m3_s_pa = 1e-15; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.parameters.air.close_leak.conductance_m3_s_pa = 1e-15; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.parameters.air.relief_pa = 1e5; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.state.open_pa += 100; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.state.close_pa += 100; }));
  EXPECT_FALSE(still_rests([](Stand& s) { s.state.speed_m_s = 1e-3; }));
}

}  // namespace
}  // namespace pinjaw::plant

// Promises: I1, I3, I5.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "firmware_sim/core/force_control.hpp"
#include "firmware_sim/core/force_guard.hpp"
#include "firmware_sim/core/guards.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// The pressure loop and its guard against what docs/reliability.md 3 says of them, computed once more from
/// physical quantities, at and beside every edge.
namespace pinjaw::core::test {
namespace {

struct Loop {
  ForceControl control;
  Valves valves;
};

/// Whole part, towards 0, as the core's integers have it.
std::int64_t whole(double value) {
  return static_cast<std::int64_t>(std::trunc(value));
}

/// Pressure that makes `force_dn` against `open_mbar`, without the check valve.
std::int64_t feed_forward_mbar(const Config& config, std::int64_t force_dn, std::int64_t open_mbar) {
  const double area_dn_per_mbar = config.area_udn_per_mbar * 1e-6;
  const std::int64_t own_mbar = whole(static_cast<double>(force_dn - config.spring_dn) / area_dn_per_mbar);
  return std::clamp<std::int64_t>(own_mbar + open_mbar * config.open_ratio_permille / 1000, 0, 20'000);
}

/// One step of a loop that brings the squeeze to `set_dn`, with at most `most_dn`.
Loop specified(const State& state, int set_dn, int most_dn, int elapsed_ms) {
  const Config& config = state.config;
  Loop next{.control = state.control, .valves = {}};
  ForceControl& control = next.control;
  const int measured_dn = state.measurement.squeeze.measured_dn;
  const int top_dn = std::max(set_dn, std::min(set_dn + 10, most_dn));
  const int relieve_dn = std::max(top_dn, std::min(top_dn + 20, most_dn));
  const int ramp_dn = 5 * elapsed_ms;
  if (control.reference_dn < top_dn) {
    control.reference_dn = std::min(control.reference_dn + ramp_dn, top_dn);
  } else {
    control.reference_dn = std::max(control.reference_dn - ramp_dn, top_dn);
  }
  const bool arrived = control.reference_dn == top_dn;
  const bool below = control.reference_dn < top_dn;
  if (arrived && control.flow == Flow::Filling && std::abs(top_dn - measured_dn) <= 60) {
    const std::int64_t error_ubar = whole((top_dn - measured_dn) * 1e9 / config.area_udn_per_mbar);
    const std::int64_t sum_ubar = control.integral_ubar + error_ubar * elapsed_ms / 100;
    control.integral_ubar = static_cast<std::int32_t>(std::clamp<std::int64_t>(sum_ubar, -300'000, 300'000));
  }
  const Flow before = control.flow;
  if (before == Flow::Shut && measured_dn > relieve_dn) control.flow = Flow::Relieving;
  if (before == Flow::Shut && measured_dn <= relieve_dn && (below || 2 * measured_dn < set_dn + top_dn - 1))
    control.flow = Flow::Filling;
  if (before == Flow::Filling && measured_dn >= top_dn && !below) control.flow = Flow::Shut;
  if (before == Flow::Relieving && measured_dn <= top_dn) control.flow = Flow::Shut;
  control.refilling = before == Flow::Shut && arrived && control.flow == Flow::Filling;

  next.valves.spool = control.flow == Flow::Shut ? Spool::Hold : Spool::Close;
  next.valves.relax = control.flow == Flow::Relieving;
  const int open_mbar = state.measurement.open_ubar / 1000;
  std::int64_t mbar = feed_forward_mbar(config, control.reference_dn, open_mbar);
  if (!next.valves.relax) mbar += 200 + control.integral_ubar / 1000;
  next.valves.close_set_mbar = static_cast<std::int32_t>(std::clamp<std::int64_t>(mbar, 0, 6000));
  return next;
}

std::string differs(const Loop& is, const Loop& should) {
  const auto text = [](const Loop& loop) {
    const ForceControl& c = loop.control;
    return std::to_string(static_cast<int>(c.flow)) + ' ' + std::to_string(c.reference_dn) + " dn " +
           std::to_string(c.integral_ubar) + " ubar " + std::to_string(c.refilling) + ' ' +
           std::to_string(c.push_mdn) + " mdn, spool " + std::to_string(static_cast<int>(loop.valves.spool)) +
           ' ' + std::to_string(loop.valves.close_set_mbar) + " mbar " + std::to_string(loop.valves.relax) +
           std::to_string(loop.valves.pre_vent);
  };
  return text(is) == text(should) ? "" : text(is) + " instead of " + text(should);
}

/// All steps from a loop's edges, of a state that is to squeeze with `set_dn`.
void expect_specified(State state, int set_dn, int most_dn) {
  const int top_dn = std::max(set_dn, std::min(set_dn + 10, most_dn));
  const int middle_dn = (set_dn + top_dn) / 2;
  const int relieve_dn = std::max(top_dn, std::min(top_dn + 20, most_dn));
  for (const Flow flow : {Flow::Shut, Flow::Filling, Flow::Relieving}) {
    for (const int measured_dn : {0, top_dn - 61, top_dn - 60, middle_dn - 1, middle_dn, top_dn - 1, top_dn,
                                  top_dn + 1, relieve_dn, relieve_dn + 1, top_dn + 60, top_dn + 61}) {
      for (const int reference_dn : {0, top_dn - 6, top_dn - 5, top_dn - 1, top_dn, top_dn + 5, top_dn + 6}) {
        for (const int integral_ubar : {0, 299'999, -299'999}) {
          for (const auto& [elapsed_ms, open_ubar] : {std::pair{1, 0}, {10, 1'000'999}, {1000, 999}}) {
            squeeze_with(state, measured_dn);
            state.measurement.open_ubar = open_ubar;
            state.control = {.flow = flow, .reference_dn = reference_dn, .integral_ubar = integral_ubar};
            const Loop should = specified(state, set_dn, most_dn, elapsed_ms);
            Loop is{};
            is.valves = wanted_valves(state, static_cast<std::uint32_t>(elapsed_ms));
            is.control = state.control;
            ASSERT_EQ(differs(is, should), "") << measured_dn << " dn, reference " << reference_dn << " dn";
          }
        }
      }
    }
  }
}

TEST(ForceGrid, regulates_as_specified_wherever_it_stands) {
  for (const std::uint16_t permit_dn : {std::uint16_t{1400}, std::uint16_t{645}, std::uint16_t{640}}) {
    State state = made(StateId::Hold);
    state.force_set_dn = 520;
    state.permit_dn = permit_dn;
    expect_specified(state, 520, permit_dn - 120);
  }
}

TEST(ForceGrid, squeezes_in_every_state_that_grips_as_that_state_should) {
  for (const StateId id : {StateId::Squeezing, StateId::Taken, StateId::Hold, StateId::Offered,
                           StateId::Relax, StateId::Resqueeze, StateId::Seated}) {
    State state = made(id);
    state.force_set_dn = id == StateId::Seated ? 0 : 1000;
    const int set_dn = id == StateId::Seated ? 120 : id == StateId::Relax ? 300 : 1000;
    squeeze_with(state, set_dn - 100);
    state.control = {.flow = Flow::Filling, .reference_dn = set_dn - 100};
    const Loop should = specified(state, set_dn, id == StateId::Seated ? 240 : 1280, 1);
    const Valves valves = wanted_valves(state, 1);
    EXPECT_EQ(differs({state.control, valves}, should), "") << static_cast<int>(id);
  }
}

/// An approach: the push grows with how far the jaws are under 70 mm/s.
TEST(ForceGrid, approaches_as_specified_however_fast_the_jaws_are) {
  for (const auto& [light_dn, u_dn] : {std::pair{120, 120}, {1000, 1000}, {1, 1}}) {
    State state = made(StateId::Seating);
    state.measurement.separation_10um = 4000;
    state.measurement.still_ms = 5;  // where there is no part it stands still, too
    state.layouts.layout.f_light_dn = static_cast<std::uint16_t>(light_dn);
    state.layouts.layout.f_limit_dn = 2500;
    state.config.hardware_limit_dn = 2500;
    state.config.uncertainty_dn = u_dn;
    state.config.open_ratio_permille = 1000;
    for (const int push_mdn : {0, 500, 999, 119'299, 119'301, 999'301, -59'999, -60'000, -499'999}) {
      for (const int closing_mm_s : {0, 69, 70, 71, 200, -10}) {
        for (const int elapsed_ms : {1, 10, 1000}) {
          state.control = {.push_mdn = push_mdn};
          Loop should{.control = {.flow = Flow::Filling, .reference_dn = light_dn},
                      .valves = {.spool = Spool::Close}};
          should.control.push_mdn =
              std::clamp(push_mdn + 10 * (70 - closing_mm_s) * elapsed_ms, -500 * light_dn, 1000 * u_dn);
          const std::int64_t mbar =
              feed_forward_mbar(state.config, light_dn + should.control.push_mdn / 1000, 0) + 200;
          should.valves.close_set_mbar = static_cast<std::int32_t>(std::min<std::int64_t>(mbar, 6000));
          state.measurement.closing_mm_s = closing_mm_s;
          Loop is{};
          is.valves = wanted_valves(state, static_cast<std::uint32_t>(elapsed_ms));
          is.control = state.control;
          ASSERT_EQ(differs(is, should), "") << push_mdn << " mdn " << closing_mm_s << " mm/s";
        }
      }
    }
  }
}

TEST(ForceGrid, opens_nothing_in_ready_on_a_decision_of_the_past) {
  State state = made(StateId::Ready);
  state.store.record.custody = Custody::Decided;
  EXPECT_EQ(wanted_valves(state, 1), Valves{});
}

/// Whether the guard has cut the supply after 3 ms of these pressures.
bool cuts(const Config& config, int close_mbar, std::array<std::int32_t, 2> open_mbar, int limit_dn) {
  ForceGuard guard;
  const Sensors sensors{.close_mbar = {0, close_mbar}, .open_mbar = open_mbar};
  const Valves fill{.spool = Spool::Close, .close_set_mbar = 6000};
  return guarded(config, limit_dn, sensors, 3, fill, guard).supply_cut;
}

TEST(ForceGrid, guard_cuts_where_the_higher_end_of_the_force_is_over_the_limit) {
  const Config config;
  for (const int open_mbar : {0, 1, 5999, 6000}) {
    for (int close_mbar = 0; close_mbar < 10'000; close_mbar += 7) {
      const double net_mbar = close_mbar - 0.85 * open_mbar;
      const std::int64_t high_dn =
          whole(net_mbar * config.area_udn_per_mbar * 1e-6 + (net_mbar < 0 ? -1e-9 : 1e-9)) + 120;
      ASSERT_FALSE(cuts(config, close_mbar, {open_mbar, open_mbar}, static_cast<int>(high_dn)));
      ASSERT_TRUE(cuts(config, close_mbar, {open_mbar, open_mbar}, static_cast<int>(high_dn) - 1))
          << close_mbar;
    }
  }
}

TEST(ForceGrid, guard_believes_the_open_sensor_that_reads_less_and_none_under_nothing) {
  Config config;
  config.area_udn_per_mbar = 1'000'000'000;  // 100 N a mbar, so that one counts
  for (const std::array<std::int32_t, 2>& open_mbar :
       {std::array{0, 0}, std::array{0, 900}, std::array{900, 0}, std::array{-900, 0}, std::array{-1, -1}}) {
    EXPECT_FALSE(cuts(config, 1, open_mbar, 1120));
    EXPECT_TRUE(cuts(config, 1, open_mbar, 1119));
  }
  EXPECT_FALSE(cuts(config, 2, {1, 1}, 1270));
  EXPECT_TRUE(cuts(config, 2, {1, 1}, 1269));
}

}  // namespace
}  // namespace pinjaw::core::test

// Promises: PLANT.
#include <gtest/gtest.h>

#include <cmath>

#include "firmware_sim/plant/flow.hpp"
#include "firmware_sim/plant/friction.hpp"
#include "firmware_sim/plant/noise.hpp"

namespace pinjaw::plant {
namespace {

constexpr Restriction kValve{0.3 * kDm3PerSecondBar, 0.3};

TEST(Flow, equal_pressures_move_no_air) {
  EXPECT_EQ(mass_flow(kValve, 3e5, 3e5), 0.0);
}

TEST(Flow, a_vacuum_gives_nothing) {
  EXPECT_EQ(mass_flow(kValve, 0.0, 0.0), 0.0);
}

TEST(Flow, is_odd_in_its_direction) {
  EXPECT_DOUBLE_EQ(mass_flow(kValve, 3e5, 2e5), -mass_flow(kValve, 2e5, 3e5));
}

TEST(Flow, is_choked_below_the_critical_ratio) {
  const double choked = kValve.conductance_m3_s_pa * kReferenceDensity * 6e5;
  EXPECT_DOUBLE_EQ(mass_flow(kValve, 6e5, 0.1e5), choked);
  EXPECT_DOUBLE_EQ(mass_flow(kValve, 6e5, 0.3 * 6e5), choked);
}

TEST(Flow, never_falls_when_the_back_pressure_falls) {
  double before = 0.0;
  for (double ratio = 1.0; ratio > 0.0; ratio -= 1e-4) {
    const double flow = mass_flow(kValve, 6e5, ratio * 6e5);
    EXPECT_GE(flow, before);
    before = flow;
  }
}

TEST(Flow, is_continuous_where_the_linear_part_begins) {
  const double above = mass_flow(kValve, 6e5, 0.999001 * 6e5);
  const double below = mass_flow(kValve, 6e5, 0.998999 * 6e5);
  EXPECT_NEAR(above / below, 1.0, 2e-3);
}

TEST(Friction, holds_below_breakaway_and_slides_at_the_coulomb_level) {
  const FrictionParameters parameters;
  FrictionState state;
  double force_n = 0;
  for (int i = 0; i < 200000; ++i) force_n = friction_force_n(parameters, 0.05, 20e-6, state);
  const double viscous_n = parameters.viscous_n_s_m * 0.05;
  EXPECT_NEAR(force_n, parameters.coulomb_n + viscous_n, 0.1);
}

TEST(Friction, is_strongest_when_it_starts_to_slide) {
  const FrictionParameters parameters;
  FrictionState state;
  double largest_n = 0;
  for (int i = 0; i < 200000; ++i) {
    largest_n = std::max(largest_n, friction_force_n(parameters, 1e-4, 20e-6, state));
  }
  EXPECT_NEAR(largest_n, parameters.breakaway_n, 0.1);
}

TEST(Friction, grows_with_rest) {
  const FrictionParameters parameters;
  FrictionState fresh;
  FrictionState rested;
  rested.rest_s = parameters.rest_full_s;
  const auto peak_n = [&](FrictionState& state) {
    double largest_n = 0;
    for (int i = 0; i < 100000; ++i) {
      largest_n = std::max(largest_n, friction_force_n(parameters, 9e-5, 20e-6, state));
    }
    return largest_n;
  };
  EXPECT_NEAR(peak_n(rested) / peak_n(fresh), 1.3, 0.01);
}

TEST(Friction, never_feeds_energy_at_steady_speed) {
  const FrictionParameters parameters;
  for (const double speed_m_s : {-1.0, -0.1, -1e-3, 1e-3, 0.1, 1.0}) {
    FrictionState state;
    double force_n = 0;
    for (int i = 0; i < 50000; ++i) force_n = friction_force_n(parameters, speed_m_s, 20e-6, state);
    EXPECT_GT(force_n * speed_m_s, 0.0) << speed_m_s;
  }
}

TEST(Noise, one_seed_gives_one_row_of_numbers) {
  Noise a{7};
  Noise b{7};
  Noise c{8};
  EXPECT_EQ(a.bits(), b.bits());
  EXPECT_NE(a.bits(), c.bits());
}

TEST(Noise, normal_has_mean_0_and_deviation_1) {
  Noise noise{3};
  double sum = 0;
  double squares = 0;
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) {
    const double draw = noise.normal();
    sum += draw;
    squares += draw * draw;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / kDraws), 1.0, 0.02);
}

}  // namespace
}  // namespace pinjaw::plant

#include "firmware_sim/plant/friction.hpp"

#include <algorithm>
#include <cmath>

namespace pinjaw::plant {
namespace {
constexpr double kSliding_m_s = 1e-4;  // chosen: below it the bristles only bend
}  // namespace

double friction_force_n(const FrictionParameters& parameters, double speed_m_s, double dt_s,
                        FrictionState& state) {
  const double rest_share = std::min(1.0, state.rest_s / parameters.rest_full_s);
  const double breakaway_n = parameters.breakaway_n * (1.0 + parameters.rest_rise * rest_share);
  const double relative = speed_m_s / parameters.stribeck_m_s;
  const double level_n =
      parameters.coulomb_n + (breakaway_n - parameters.coulomb_n) / (1.0 + relative * relative);

  const double before_m = state.bristle_m;
  const double decay = parameters.bristle_n_m * std::abs(speed_m_s) / level_n;
  state.bristle_m = (before_m + speed_m_s * dt_s) / (1.0 + decay * dt_s);
  state.rest_s = std::abs(speed_m_s) < kSliding_m_s ? state.rest_s + dt_s : 0.0;

  // The bristles' damping fades as it slides, else it would add a second viscous part.
  const double damping = parameters.bristle_damping_n_s_m / (1.0 + relative * relative);
  return parameters.bristle_n_m * state.bristle_m + damping * (state.bristle_m - before_m) / dt_s +
         parameters.viscous_n_s_m * speed_m_s;
}

}  // namespace pinjaw::plant

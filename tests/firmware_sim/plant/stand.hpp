#pragma once

#include <algorithm>
#include <functional>

#include "firmware_sim/plant/plant.hpp"

namespace pinjaw::plant {

/// One gripper on a test stand: a plant, its inputs, and what happened to it.
struct Stand {
  Parameters parameters = parameters_for({});
  Inputs inputs;
  State state;
  double dt_s = kStep_s;
  double time_s = 0;
  double peak_n = 0;
  double first_touch_s = -1;
  double speed_at_touch_m_s = 0;

  void start(double separation_m_, std::uint64_t seed = 1) {
    state = initial_state(parameters, seed, separation_m_);
  }

  /// Runs for `duration_s`; `each_ms` may change the inputs.
  void run(double duration_s, const std::function<void(Stand&)>& each_ms = nullptr) {
    const double end_s = time_s + duration_s;
    double next_ms_s = time_s;
    while (time_s < end_s) {
      if (each_ms && time_s >= next_ms_s) {
        each_ms(*this);
        next_ms_s += 0.001;
      }
      const double speed_m_s = state.speed_m_s;
      step(parameters, inputs, dt_s, state);
      time_s += dt_s;
      peak_n = std::max(peak_n, squeeze_n(state));
      if (first_touch_s < 0 && squeeze_n(state) > 0) {
        first_touch_s = time_s;
        speed_at_touch_m_s = speed_m_s;
      }
    }
  }
};

/// The gripper of the table of docs/reliability.md: 7 mm of stroke, the part 4 mm from each jaw.
inline Stand study_stand() {
  Stand stand;
  stand.parameters = parameters_for({.max_squeeze_n = 140, .max_separation_m = 0.014});
  stand.inputs.contact = {.present = true, .separation_m = 0.006};
  stand.start(0.014);
  return stand;
}

}  // namespace pinjaw::plant

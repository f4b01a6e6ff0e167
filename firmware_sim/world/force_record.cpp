#include "firmware_sim/world/force_record.hpp"

#include <algorithm>

namespace pinjaw::world {

void ForceRecord::observe(double least_n, double most_n, double limit_n) {
  max_n_ = std::max(max_n_, most_n);
  if (most_n > limit_n) over_limit_s_ += 0.001;
  window_n_.at(next_) = least_n;
  next_ = (next_ + 1) % window_n_.size();
  max_steady_n_ = std::max(max_steady_n_, *std::ranges::min_element(window_n_));
}

}  // namespace pinjaw::world

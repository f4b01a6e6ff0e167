#include "firmware_sim/app/pace.hpp"

namespace pinjaw::jaw_app {

int Pace::due(std::int64_t now_ns) {
  if (now_ns < next_ns_) return 0;
  std::int64_t steps = (now_ns - next_ns_) / kStep_ns + 1;
  next_ns_ += steps * kStep_ns;
  if (steps > kMost_ms) {
    given_up_ms_ += steps - kMost_ms;
    steps = kMost_ms;
  }
  return static_cast<int>(steps);
}

}  // namespace pinjaw::jaw_app

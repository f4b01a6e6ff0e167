#include "firmware_sim/core/bus_link.hpp"

namespace pinjaw::core {
namespace {
constexpr std::uint16_t kRecoveryWindow_ms = 10'000;  // section 2.5
}  // namespace

bool BusLink::take_recovery() {
  if (given_up_) return false;
  for (wire::Countdown& recovery : recent_) {
    if (recovery.running()) continue;
    recovery.start(kRecoveryWindow_ms);
    return true;
  }
  given_up_ = true;
  return false;
}

void BusLink::observe(const BusHealth& health, std::uint16_t elapsed_ms) {
  for (wire::Countdown& recovery : recent_) recovery.advance(elapsed_ms);
  was_off_ = off_;
  off_ = health.off;
  passive_ = health.passive;
  overran_ = health.overruns != overruns_;
  overruns_ = health.overruns;
  if (fell_off()) restart_ = take_recovery();
  if (!off_) restart_ = false;
}

}  // namespace pinjaw::core

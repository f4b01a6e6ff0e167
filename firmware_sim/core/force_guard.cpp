#include "firmware_sim/core/force_guard.hpp"

#include <algorithm>

#include "firmware_sim/core/measure.hpp"

namespace pinjaw::core {
namespace {

constexpr std::uint16_t kOver_ms = 3;    // I5
constexpr std::uint16_t kUnder_ms = 20;  // chosen: a valve's time, so that the cut-off does not chatter

}  // namespace

Valves guarded(const Config& config, std::int32_t limit_dn, const Sensors& sensors, std::uint32_t elapsed_ms,
               const Valves& wanted, ForceGuard& guard) {
  if (config.passive) return Valves{};
  if (!config.force_guard_enabled) return wanted;
  const std::int32_t close_mbar = sensors.close_mbar[1];
  const std::int32_t open_mbar =
      std::max<std::int32_t>(std::min(sensors.open_mbar[0], sensors.open_mbar[1]), 0);
  const std::int32_t high_dn =
      squeeze_dn(config, close_mbar * 1000, open_mbar * 1000) + config.uncertainty_dn;
  guard.over_ms = counted(guard.over_ms, high_dn > limit_dn, elapsed_ms);
  guard.under_ms = counted(guard.under_ms, high_dn <= limit_dn, elapsed_ms);
  if (guard.over_ms >= kOver_ms) guard.cut = true;
  if (guard.under_ms >= kUnder_ms) guard.cut = false;

  Valves allowed = wanted;
  const std::int32_t most_mbar = pressure_mbar(config, limit_dn - config.uncertainty_dn, open_mbar);
  const std::int32_t with_check_mbar =
      std::min(most_mbar + config.check_cracking_mbar, pressure_mbar(config, limit_dn, open_mbar));
  allowed.close_set_mbar =
      std::clamp<std::int32_t>(wanted.close_set_mbar, 0, wanted.relax ? most_mbar : with_check_mbar);
  if (!guard.cut || wanted.spool == Spool::Open) return allowed;
  allowed.supply_cut = true;
  const bool lets_out = wanted.relax && allowed.close_set_mbar < close_mbar;
  if (!lets_out) {
    allowed.spool = Spool::Hold;
    allowed.relax = false;
  }
  return allowed;
}

}  // namespace pinjaw::core

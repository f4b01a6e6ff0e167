#include "firmware_sim/core/force_control.hpp"

#include <algorithm>

#include "firmware_sim/core/guards.hpp"

namespace pinjaw::core {
namespace {

constexpr std::int32_t kRelaxPercent = 30;  // section 2.5
constexpr std::int32_t kIntegral_ms = 100;  // chosen: slower than the regulator's 40 to 75 ms
constexpr std::int32_t kIntegralMost_ubar =
    300'000;  // chosen: 1 % linearity, 0.5 % hysteresis and sensor offsets
constexpr std::int32_t kIntegralWindow_dn =
    60;  // anti-windup: beyond it the feed-forward is still on its way
constexpr std::int32_t kApproach_mm_s =
    70;  // chosen: slower, and seals stick and slip; faster, and the touch is hard
constexpr std::int32_t kPush_mdn_per_mm =
    10;  // chosen: the whole uncertainty within 200 ms of standing still

/// One step of the reference towards the set point.
void follow_ramp(const State& state, std::int32_t set_dn, std::int32_t elapsed_ms, ForceControl& control) {
  const std::int32_t most_dn = state.config.ramp_dn_per_ms * elapsed_ms;
  control.reference_dn += std::clamp(set_dn - control.reference_dn, -most_dn, most_dn);
}

void integrate(const State& state, std::int32_t error_dn, std::int32_t elapsed_ms, ForceControl& control) {
  if (error_dn > kIntegralWindow_dn || error_dn < -kIntegralWindow_dn) return;
  const std::int64_t error_ubar =
      std::int64_t{error_dn} * 1'000'000'000 / std::max<std::int32_t>(state.config.area_udn_per_mbar, 1);
  const std::int64_t sum_ubar = control.integral_ubar + error_ubar * elapsed_ms / kIntegral_ms;
  control.integral_ubar =
      static_cast<std::int32_t>(std::clamp<std::int64_t>(sum_ubar, -kIntegralMost_ubar, kIntegralMost_ubar));
}

/// The band in which the check valve stays shut: refilled under its middle, filled up to its top.
struct Band {
  std::int32_t top_dn;
  std::int32_t refill_dn;
  std::int32_t relieve_dn;
};

Band band_about(const State& state, std::int32_t set_dn) {
  const std::int32_t most_dn = force_limit_dn(state) - state.config.uncertainty_dn;
  const std::int32_t top_dn = std::max(set_dn, std::min(set_dn + state.config.hold_band_dn, most_dn));
  return {.top_dn = top_dn,
          .refill_dn = set_dn + (top_dn - set_dn) / 2,
          .relieve_dn = std::max(top_dn, std::min(top_dn + 2 * state.config.hold_band_dn, most_dn))};
}

void switch_flow(const Band& band, std::int32_t measured_dn, bool ramping_up, ForceControl& control) {
  switch (control.flow) {
    case Flow::Shut:
      if (measured_dn < band.refill_dn || ramping_up) control.flow = Flow::Filling;
      if (measured_dn > band.relieve_dn) control.flow = Flow::Relieving;
      break;
    case Flow::Filling:
      if (measured_dn >= band.top_dn && !ramping_up) control.flow = Flow::Shut;
      break;
    default:  // relieving
      if (measured_dn <= band.top_dn) control.flow = Flow::Shut;
      break;
  }
}

/// Brings the squeeze to `set_dn` and keeps it there.
Valves regulate(State& state, std::int32_t set_dn, std::int32_t elapsed_ms) {
  ForceControl& control = state.control;
  const std::int32_t measured_dn = state.measurement.squeeze.measured_dn;
  const Band band = band_about(state, set_dn);
  follow_ramp(state, band.top_dn, elapsed_ms, control);
  const bool arrived = control.reference_dn == band.top_dn;
  if (arrived && control.flow == Flow::Filling)
    integrate(state, band.top_dn - measured_dn, elapsed_ms, control);
  const bool shut = control.flow == Flow::Shut;
  switch_flow(band, measured_dn, control.reference_dn < band.top_dn, control);
  control.refilling = shut && arrived && control.flow == Flow::Filling;

  Valves valves;
  const std::int32_t open_mbar = state.measurement.open_ubar / 1000;
  const std::int32_t aim_mbar = pressure_mbar(state.config, control.reference_dn, open_mbar);
  valves.relax = control.flow == Flow::Relieving;
  valves.spool = control.flow == Flow::Shut ? Spool::Hold : Spool::Close;
  valves.close_set_mbar = aim_mbar;
  if (!valves.relax) valves.close_set_mbar += state.config.check_cracking_mbar + control.integral_ubar / 1000;
  valves.close_set_mbar = std::clamp<std::int32_t>(valves.close_set_mbar, 0, state.config.pressure_max_mbar);
  return valves;
}

/// Closes on the part with about the light squeeze. The open side's pressure brakes the jaws and is not made
/// up for. Friction, orifices and supply differ from gripper to gripper: the push grows while the jaws are
/// slow, up to the uncertainty, and shrinks while they are fast, so that none sticks and none hits the part
/// hard.
Valves approach(State& state, std::int32_t elapsed_ms) {
  const Measurement& m = state.measurement;
  const std::int32_t light_dn = force_set_dn(state);
  if (separation_in_window(state) && m.still_ms > 0) return regulate(state, light_dn, elapsed_ms);
  Valves valves;
  if (!motion_permitted(state)) return valves;
  if (m.open_ubar / 1000 > state.config.pre_vent_mbar) {
    valves.pre_vent = true;
    return valves;
  }
  std::int32_t& push_mdn = state.control.push_mdn;
  push_mdn = std::clamp(push_mdn + (kApproach_mm_s - m.closing_mm_s) * kPush_mdn_per_mm * elapsed_ms,
                        -500 * light_dn, 1000 * state.config.uncertainty_dn);
  state.control.reference_dn = light_dn;
  state.control.flow = Flow::Filling;
  valves.spool = Spool::Close;
  const std::int32_t aim_mbar = pressure_mbar(state.config, light_dn + push_mdn / 1000, 0);
  valves.close_set_mbar =
      std::min(aim_mbar + state.config.check_cracking_mbar, state.config.pressure_max_mbar);
  return valves;
}

/// Motion that nobody holds a part in needs a session and a permit (I3).
Valves open_while_permitted(State& state) {
  Valves valves;
  if (fully_open(state)) state.opening_wanted = false;
  if (state.opening_wanted && motion_permitted(state)) valves.spool = Spool::Open;
  return valves;
}

}  // namespace

std::int32_t force_set_dn(const State& state) {
  if (!state.layouts.committed || state.config.passive) return 0;
  const std::int32_t light_dn = state.layouts.layout.f_light_dn;
  std::int32_t set_dn = 0;
  switch (state.id) {
    default:
      break;
    case StateId::Seating:
    case StateId::Seated:
      set_dn = light_dn;
      break;
    case StateId::Squeezing:
    case StateId::Taken:
    case StateId::Hold:
    case StateId::Offered:
    case StateId::Resqueeze:
      set_dn = state.force_set_dn;
      break;
    case StateId::Relax:
      set_dn = std::max(light_dn, state.force_set_dn * kRelaxPercent / 100);
  }
  const std::int32_t most_dn = force_limit_dn(state) - state.config.uncertainty_dn;
  return std::min(set_dn, std::max<std::int32_t>(most_dn, 0));
}

Valves wanted_valves(State& state, std::uint32_t elapsed_ms) {
  if (state.config.passive) return Valves{};
  const auto ms = static_cast<std::int32_t>(std::min<std::uint32_t>(elapsed_ms, 1000));
  switch (state.id) {
    case StateId::Ready:
      return open_while_permitted(state);
    case StateId::FaultEmpty:
      if (state.store.record.custody == Custody::Decided) return Valves{.spool = Spool::Open};
      return open_while_permitted(state);
    case StateId::Seating:  // the way back must outlive a power cut before the jaws touch anything
      return state.frozen || !state.store.durable() ? Valves{} : approach(state, ms);
    case StateId::Seated:
      return state.frozen ? Valves{} : regulate(state, force_set_dn(state), ms);
    case StateId::Squeezing:
    case StateId::Taken:
    case StateId::Hold:
    case StateId::Offered:
    case StateId::Relax:
    case StateId::Resqueeze:
      return regulate(state, force_set_dn(state), ms);
    case StateId::Opening:
      return Valves{.spool = Spool::Open};
    default:
      return Valves{};
  }
}

}  // namespace pinjaw::core

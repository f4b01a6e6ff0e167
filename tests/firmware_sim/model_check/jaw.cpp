#include "tests/firmware_sim/model_check/jaw.hpp"

#include "firmware_sim/core/custody.hpp"
#include "firmware_sim/core/measure.hpp"
#include "tests/firmware_sim/model_check/layouts.hpp"

namespace pinjaw::core::model {
namespace {

// Inside the dead bands about the light and the full squeeze of layouts.hpp.
constexpr std::int32_t kLight_dn = 137;
constexpr std::int32_t kFull_dn = 537;

}  // namespace

Sensors read(const Config& config, Grip grip) {
  Sensors sensors{.supply_mbar = 6000};
  if (config.passive) {
    sensors.seats = grip == Grip::Full ? config.seat_switches : std::uint8_t{0};
    return sensors;
  }
  sensors.separation_10um = grip == Grip::Open ? kOpen_10um : kContact_10um;
  if (grip == Grip::Open) return sensors;
  const std::int32_t close_mbar = pressure_mbar(config, grip == Grip::Full ? kFull_dn : kLight_dn, 0);
  sensors.close_mbar = {close_mbar, close_mbar};
  return sensors;
}

Pull pull_of(const Config& config, const Valves& valves) {
  if (valves.spool == Spool::Open) return Pull::Open;
  if (valves.spool == Spool::Hold) return Pull::Stay;
  const std::int32_t lost_mbar = valves.relax ? 0 : config.check_cracking_mbar;
  const std::int32_t reached_dn = squeeze_dn(config, (valves.close_set_mbar - lost_mbar) * 1000, 0);
  if (reached_dn >= kRequired_dn + config.uncertainty_dn) return Pull::Full;
  return valves.relax ? Pull::Ease : Pull::Light;
}

Pull passive_pull(Custody recorded) {
  return has_custody(recorded) ? Pull::Stay : Pull::Either;
}

Grip pulled(Grip grip, Pull pull) {
  switch (pull) {
    case Pull::Stay:
      return grip;
    case Pull::Open:
      return grip == Grip::Full ? Grip::Light : Grip::Open;
    case Pull::Light:
      return grip == Grip::Open ? Grip::Light : grip;
    case Pull::Full:
      return grip == Grip::Open ? Grip::Light : Grip::Full;
    case Pull::Ease:
      return Grip::Light;
    case Pull::Either:
      return grip == Grip::Full ? Grip::Open : Grip::Full;
  }
  return grip;
}

}  // namespace pinjaw::core::model

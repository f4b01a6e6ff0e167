#include "firmware_sim/node/fault_spec.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "firmware_sim/node/units.hpp"

namespace pinjaw::node {
namespace {

using plant::Faults;
using plant::RegulatorFault;
using plant::Spool;
using plant::Stick;

struct Known {
  std::string_view name;
  Fault::Add add;
  std::string_view unit{};  ///< empty: it takes no value
  double least = 0;
  double most = 0;
  Fault::Of of = Fault::Of::Plant;
};

constexpr double kLeakReference_Pa = 6e5;  // absolute: a leak is told at 5 bar gauge
constexpr double kMost_mbar = 10000;
constexpr double kMost_mm = 1000;
constexpr double kMm = 1e-3;

template <Spool where>
void stick_spool(double /*value*/, Faults& faults) {
  faults.spool_sticks_at = where;
}

template <Stick Faults::*valve, Stick where>
void stick(double /*value*/, Faults& faults) {
  faults.*valve = where;
}

template <RegulatorFault how>
void break_regulator(double /*value*/, Faults& faults) {
  faults.regulator = how;
}

template <std::size_t sensor>
void offset_sensor(double mbar, Faults& faults) {
  faults.pressure[sensor].offset = mbar * kPa_per_mbar;
}

template <std::size_t sensor>
void drift_sensor(double mbar_s, Faults& faults) {
  faults.pressure[sensor].drift_per_s = mbar_s * kPa_per_mbar;
}

template <std::size_t sensor>
void stick_sensor(double /*value*/, Faults& faults) {
  faults.pressure[sensor].stuck = true;
}

template <std::size_t sensor>
void lose_sensor(double /*value*/, Faults& faults) {
  faults.pressure[sensor].lost = true;
}

constexpr std::array kKnown = {
    Known{
        "leak",
        [](double cm3_s, Faults& f) { f.close_leak.conductance_m3_s_pa = cm3_s * 1e-6 / kLeakReference_Pa; },
        "CM3_S", 0.0, 100.0},
    Known{"spool_stuck", [](double, Faults& f) { f.spool_stuck = true; }},
    Known{"spool_stuck_hold", stick_spool<Spool::Hold>},
    Known{"spool_stuck_close", stick_spool<Spool::Close>},
    Known{"spool_stuck_open", stick_spool<Spool::Open>},
    Known{"check_stuck_shut", stick<&Faults::relax, Stick::Off>},
    Known{"check_stuck_open", stick<&Faults::relax, Stick::On>},
    Known{"vent_stuck_shut", stick<&Faults::vent, Stick::Off>},
    Known{"vent_stuck_open", stick<&Faults::vent, Stick::On>},
    Known{"cut_stuck_off", stick<&Faults::cut, Stick::Off>},
    Known{"cut_stuck_on", stick<&Faults::cut, Stick::On>},
    Known{"soft_start_stuck_shut", stick<&Faults::soft_start, Stick::Off>},
    Known{"soft_start_stuck_open", stick<&Faults::soft_start, Stick::On>},
    Known{"regulator_open", break_regulator<RegulatorFault::Open>},
    Known{"regulator_closed", break_regulator<RegulatorFault::Closed>},
    Known{"regulator_stuck", break_regulator<RegulatorFault::Stuck>},
    Known{"supply_lost", [](double, Faults& f) { f.supply_lost = true; }},
    Known{"sensor_a", offset_sensor<0>, "MBAR", -kMost_mbar, kMost_mbar},
    Known{"sensor_b", offset_sensor<1>, "MBAR", -kMost_mbar, kMost_mbar},
    Known{"sensor_open_a", offset_sensor<2>, "MBAR", -kMost_mbar, kMost_mbar},
    Known{"sensor_open_b", offset_sensor<3>, "MBAR", -kMost_mbar, kMost_mbar},
    Known{"sensor_a_drift", drift_sensor<0>, "MBAR_S", -kMost_mbar, kMost_mbar},
    Known{"sensor_b_drift", drift_sensor<1>, "MBAR_S", -kMost_mbar, kMost_mbar},
    Known{"sensor_open_a_drift", drift_sensor<2>, "MBAR_S", -kMost_mbar, kMost_mbar},
    Known{"sensor_open_b_drift", drift_sensor<3>, "MBAR_S", -kMost_mbar, kMost_mbar},
    Known{"sensor_a_stuck", stick_sensor<0>},
    Known{"sensor_b_stuck", stick_sensor<1>},
    Known{"sensor_open_a_stuck", stick_sensor<2>},
    Known{"sensor_open_b_stuck", stick_sensor<3>},
    Known{"sensor_a_lost", lose_sensor<0>},
    Known{"sensor_b_lost", lose_sensor<1>},
    Known{"sensor_open_a_lost", lose_sensor<2>},
    Known{"sensor_open_b_lost", lose_sensor<3>},
    Known{"position", [](double mm, Faults& f) { f.position.offset = mm * kMm; }, "MM", -kMost_mm, kMost_mm},
    Known{"position_drift", [](double mm_s, Faults& f) { f.position.drift_per_s = mm_s * kMm; }, "MM_S",
          -kMost_mm, kMost_mm},
    Known{"position_stuck", [](double, Faults& f) { f.position.stuck = true; }},
    Known{"position_lost", [](double, Faults& f) { f.position.lost = true; }},
    Known{.name = "nvm_failed", .add = nullptr, .of = Fault::Of::Memory},
    Known{.name = "hang", .add = nullptr, .of = Fault::Of::Processor},
};

tl::unexpected<std::string> wrong(std::string why) {
  return tl::unexpected(std::move(why));
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::string known_faults() {
  std::string list;
  for (const Known& known : kKnown) {
    if (!list.empty()) list += ", ";
    list += known.name;
    if (!known.unit.empty()) list.append("=").append(known.unit);
  }
  return list;
}

tl::expected<Fault, std::string> parse_fault(std::string_view text) {
  const auto equals = text.find('=');
  const std::string name(text.substr(0, equals));
  for (const Known& known : kKnown) {
    if (known.name != name) continue;
    const bool has_value = equals != std::string_view::npos;
    if (known.unit.empty()) {
      if (has_value) return wrong(name + " takes no value");
      return Fault{.of = known.of, .add = known.add};
    }
    const auto value = has_value ? number(text.substr(equals + 1)) : std::nullopt;
    if (!value || *value < known.least || *value > known.most) {
      std::string why = name;
      why.append(" needs a number from ").append(std::to_string(static_cast<int>(known.least)));
      why.append(" to ").append(std::to_string(static_cast<int>(known.most)));
      return wrong(why.append(": ").append(name).append("=").append(known.unit));
    }
    return Fault{.add = known.add, .value = *value};
  }
  return wrong("no such fault: '" + name + "'; known are " + known_faults());
}

}  // namespace pinjaw::node

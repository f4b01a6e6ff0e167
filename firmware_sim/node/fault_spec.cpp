#include "firmware_sim/node/fault_spec.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "firmware_sim/node/units.hpp"

namespace pinjaw::node {
namespace {

struct Known {
  std::string_view name;
  Fault::Kind kind;
  std::string_view unit;  ///< empty: it takes no value
  double least = 0;
  double most = 0;
};

constexpr std::array kKnown = {
    Known{"leak", Fault::Kind::Leak, "CM3_S", 0.0, 100.0},
    Known{"spool_stuck", Fault::Kind::SpoolStuck, ""},
    Known{"regulator_open", Fault::Kind::RegulatorOpen, ""},
    Known{"supply_lost", Fault::Kind::SupplyLost, ""},
    Known{"sensor_a", Fault::Kind::SensorA, "MBAR", -10000.0, 10000.0},
    Known{"sensor_b", Fault::Kind::SensorB, "MBAR", -10000.0, 10000.0},
    Known{"position_stuck", Fault::Kind::PositionStuck, ""},
    Known{"nvm_failed", Fault::Kind::NvmFailed, ""},
};

constexpr double kLeakReference_Pa = 6e5;  // absolute: a leak is told at 5 bar gauge

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
      return Fault{.kind = known.kind};
    }
    const auto value = has_value ? number(text.substr(equals + 1)) : std::nullopt;
    if (!value || *value < known.least || *value > known.most) {
      std::string why = name;
      why.append(" needs a number from ").append(std::to_string(static_cast<int>(known.least)));
      why.append(" to ").append(std::to_string(static_cast<int>(known.most)));
      return wrong(why.append(": ").append(name).append("=").append(known.unit));
    }
    return Fault{.kind = known.kind, .value = *value};
  }
  return wrong("no such fault: '" + name + "'; known are " + known_faults());
}

void add_fault(const Fault& fault, plant::Faults& faults) {
  switch (fault.kind) {
    case Fault::Kind::Leak:
      faults.close_leak.conductance_m3_s_pa = fault.value * 1e-6 / kLeakReference_Pa;
      return;
    case Fault::Kind::SpoolStuck:
      faults.spool_stuck = true;
      return;
    case Fault::Kind::RegulatorOpen:
      faults.regulator_open = true;
      return;
    case Fault::Kind::SupplyLost:
      faults.supply_lost = true;
      return;
    case Fault::Kind::SensorA:
      faults.close_sensor_offset_pa[0] = fault.value * kPa_per_mbar;
      return;
    case Fault::Kind::SensorB:
      faults.close_sensor_offset_pa[1] = fault.value * kPa_per_mbar;
      return;
    case Fault::Kind::PositionStuck:
      faults.position_stuck = true;
      return;
    case Fault::Kind::NvmFailed:
      return;
  }
}

}  // namespace pinjaw::node

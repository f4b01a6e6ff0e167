#include "firmware_sim/plant/chambers.hpp"

#include <algorithm>
#include <cmath>

#include "firmware_sim/plant/regulator.hpp"

namespace pinjaw::plant {
namespace {

constexpr double kHeatRatio = 1.4;                                              // gamma of air
constexpr double kHeatPressure = kHeatRatio * kAirConstant / (kHeatRatio - 1);  // cp, J/(kg K)
constexpr double kHeatVolume = kAirConstant / (kHeatRatio - 1);                 // cv
constexpr double kShut_pa = 2.0;   // chosen: what still moves under it is under 1e-3 N
constexpr double kWarm_K = 0.005;  // chosen: of 293 K, 10 Pa at 6 bar

/// What crosses one chamber's ports, kg/s, both at least 0.
struct PortFlow {
  double in_kg_s = 0;
  double out_kg_s = 0;
  void add(double into_kg_s) { (into_kg_s > 0 ? in_kg_s : out_kg_s) += std::abs(into_kg_s); }
};

bool valve_on(Stick stick, bool told) {
  return stick == Stick::Free ? told : stick == Stick::On;
}

/// What the soft start leaves of the regulator's outlet.
double behind_soft_start_pa(const AirParameters& air, const Faults& faults, double outlet_pa,
                            const State& state) {
  if (valve_on(faults.soft_start, state.soft_start_open)) return outlet_pa;
  return std::min(outlet_pa, kAtmosphere_Pa + air.soft_start_pa);
}

PortFlow close_flow(const AirParameters& air, const Inputs& inputs, const Actuation& valves,
                    const State& state) {
  PortFlow flow;
  flow.add(-mass_flow(inputs.faults.close_leak, state.close_pa, kAtmosphere_Pa));
  flow.add(-mass_flow(air.close_leak, state.close_pa, kAtmosphere_Pa));
  const double over_pa = state.close_pa - kAtmosphere_Pa - air.relief_pa;
  if (over_pa > 0.0) {
    Restriction relief = air.relief;
    relief.conductance_m3_s_pa *= std::min(1.0, over_pa / (air.relief_span * air.relief_pa));
    flow.add(-mass_flow(relief, state.close_pa, kAtmosphere_Pa));
  }
  if (state.spool == Spool::Open) flow.add(-mass_flow(air.relax, state.close_pa, kAtmosphere_Pa));
  if (state.spool != Spool::Close) return flow;

  const double outlet_pa = regulator_outlet_pa(inputs, state);
  const double fed_pa = behind_soft_start_pa(air, inputs.faults, outlet_pa, state);
  const double cracking_pa = valves.relax ? 0.0 : air.check_cracking_pa;
  if (fed_pa - cracking_pa > state.close_pa) {
    if (!valves.supply_cut) flow.add(mass_flow(air.fill, fed_pa - cracking_pa, state.close_pa));
  } else if (valves.relax) {
    flow.add(-mass_flow(air.relax, state.close_pa, std::min(outlet_pa, state.close_pa)));
  }
  return flow;
}

PortFlow open_flow(const AirParameters& air, const Actuation& valves, const State& state) {
  PortFlow flow;
  if (state.spool == Spool::Open) {
    if (!valves.supply_cut) flow.add(mass_flow(air.open_fill, supply_pa(state), state.open_pa));
  } else {
    flow.add(-mass_flow(air.meter_out, state.open_pa, kAtmosphere_Pa));
  }
  if (valves.vent_open) flow.add(-mass_flow(air.relax, state.open_pa, kAtmosphere_Pa));
  return flow;
}

/// One chamber as the laws of gas see it.
struct Gas {
  double volume_m3 = 0;
  double volume_rate_m3_s = 0;
  double& pressure_pa;
  double& temperature_K;
};

void charge_polytropic(double exponent, const PortFlow& flow, double dt_s, Gas gas) {
  constexpr double kGas = kAirConstant * kTemperature_K;
  gas.pressure_pa += exponent / gas.volume_m3 * dt_s *
                     (kGas * (flow.in_kg_s - flow.out_kg_s) - gas.pressure_pa * gas.volume_rate_m3_s);
}

/// Mass and inner energy of the chamber's air after `dt_s` at constant volume, and what they came to.
void charge_by_energy(double wall_w_K, const PortFlow& flow, double dt_s, Gas gas, Ledger& ledger) {
  const double mass_kg = gas.pressure_pa * gas.volume_m3 / (kAirConstant * gas.temperature_K);
  const double in_j = kHeatPressure * kTemperature_K * flow.in_kg_s * dt_s;
  const double out_j = kHeatPressure * gas.temperature_K * flow.out_kg_s * dt_s;
  const double heat_j = wall_w_K * (kTemperature_K - gas.temperature_K) * dt_s;
  const double energy_j = kHeatVolume * mass_kg * gas.temperature_K + in_j - out_j + heat_j;
  const double after_kg = mass_kg + (flow.in_kg_s - flow.out_kg_s) * dt_s;
  gas.temperature_K = energy_j / (kHeatVolume * after_kg);
  gas.pressure_pa = (kHeatRatio - 1) * energy_j / gas.volume_m3;
  ledger.enthalpy_in_j += in_j;
  ledger.enthalpy_out_j += out_j;
  ledger.wall_heat_j += heat_j;
}

/// The air pays for p dV out of its inner energy.
void expand(double from_m3, Gas gas) {
  const double mass_kg = gas.pressure_pa * from_m3 / (kAirConstant * gas.temperature_K);
  const double energy_j =
      gas.pressure_pa * from_m3 / (kHeatRatio - 1) - gas.pressure_pa * (gas.volume_m3 - from_m3);
  gas.temperature_K = energy_j / (kHeatVolume * mass_kg);
  gas.pressure_pa = (kHeatRatio - 1) * energy_j / gas.volume_m3;
}

Gas close_gas(const Parameters& parameters, State& state) {
  return {.volume_m3 = close_volume_m3(parameters, state),
          .volume_rate_m3_s = parameters.air.close_area_m2 * state.speed_m_s,
          .pressure_pa = state.close_pa,
          .temperature_K = state.close_K};
}

Gas open_gas(const Parameters& parameters, State& state) {
  return {.volume_m3 = open_volume_m3(parameters, state),
          .volume_rate_m3_s = -parameters.air.open_area_m2 * state.speed_m_s,
          .pressure_pa = state.open_pa,
          .temperature_K = state.open_K};
}

/// What only the difference of pressures makes.
double air_alone_n(const AirParameters& air, const State& state) {
  return air.close_area_m2 * (state.close_pa - kAtmosphere_Pa) -
         air.open_area_m2 * (state.open_pa - kAtmosphere_Pa);
}

/// The keeper's catch: let go by a squeeze well above its spring, drawn back by air on the open side.
void step_keeper(const AirParameters& air, State& state) {
  if (air.keeper_n <= 0.0) return;
  if (state.open_pa - kAtmosphere_Pa > air.keeper_release_pa) {
    state.keeper_engaged = false;
  } else if (air_alone_n(air, state) > air.keeper_engage_share * air.keeper_n) {
    state.keeper_engaged = true;
  }
}

/// The soft start's pilots: the chambers press against each other as they do on the piston.
void step_soft_start(const AirParameters& air, State& state) {
  const double pressing_pa = air_alone_n(air, state) / air.close_area_m2;
  if (pressing_pa > air.soft_start_opens_pa) {
    state.soft_start_open = true;
  } else if (pressing_pa < air.soft_start_shuts_share * air.soft_start_opens_pa) {
    state.soft_start_open = false;
  }
}

}  // namespace

Actuation actual_valves(const Inputs& inputs) {
  Actuation valves = inputs.actuation;
  valves.relax = valve_on(inputs.faults.relax, valves.relax);
  valves.vent_open = valve_on(inputs.faults.vent, valves.vent_open);
  valves.supply_cut = valve_on(inputs.faults.cut, valves.supply_cut);
  return valves;
}

double close_volume_m3(const Parameters& parameters, const State& state) {
  return parameters.air.dead_volume_m3 + parameters.air.close_area_m2 * state.displacement_m;
}

double open_volume_m3(const Parameters& parameters, const State& state) {
  return parameters.air.dead_volume_m3 +
         parameters.air.open_area_m2 * (parameters.jaw.stroke_m - state.displacement_m);
}

void step_chambers(const Parameters& parameters, const Inputs& inputs, double dt_s, State& state) {
  const AirParameters& air = parameters.air;
  const Actuation valves = actual_valves(inputs);
  PortFlow close = close_flow(air, inputs, valves, state);
  PortFlow open = open_flow(air, valves, state);
  if (air.law == AirLaw::Polytropic) {
    charge_polytropic(air.polytropic, close, dt_s, close_gas(parameters, state));
    charge_polytropic(air.polytropic, open, dt_s, open_gas(parameters, state));
  } else {
    // ISO 6358-1: warmer air is thinner, and flows out slower.
    close.out_kg_s *= std::sqrt(kTemperature_K / state.close_K);
    open.out_kg_s *= std::sqrt(kTemperature_K / state.open_K);
    charge_by_energy(air.wall_w_K, close, dt_s, close_gas(parameters, state), state.ledger);
    charge_by_energy(air.wall_w_K, open, dt_s, open_gas(parameters, state), state.ledger);
  }
  state.ledger.mass_in_kg += (close.in_kg_s + open.in_kg_s) * dt_s;
  state.ledger.mass_out_kg += (close.out_kg_s + open.out_kg_s) * dt_s;
  step_keeper(air, state);
  step_soft_start(air, state);
}

void take_stroke(const Parameters& parameters, double from_m, State& state) {
  const AirParameters& air = parameters.air;
  const double stroke_m = state.displacement_m - from_m;
  const double close_m3 = air.close_area_m2 * stroke_m;
  const double open_m3 = -air.open_area_m2 * stroke_m;
  state.ledger.piston_work_j += state.close_pa * close_m3 + state.open_pa * open_m3;
  if (air.law == AirLaw::Polytropic) return;
  expand(close_volume_m3(parameters, state) - close_m3, close_gas(parameters, state));
  expand(open_volume_m3(parameters, state) - open_m3, open_gas(parameters, state));
}

double air_force_n(const Parameters& parameters, const State& state) {
  const AirParameters& air = parameters.air;
  const double air_n = air_alone_n(air, state) + air.spring_n;
  if (!state.keeper_engaged) return air_n;
  return air_n + std::clamp(air.keeper_n - air_n, 0.0, air.keeper_n);
}

bool shut_in(const Parameters& parameters, const Inputs& inputs, const State& state) {
  const AirParameters& air = parameters.air;
  if (state.spool != Spool::Hold || inputs.faults.close_leak.conductance_m3_s_pa > 0.0 ||
      air.close_leak.conductance_m3_s_pa > 0.0) {
    return false;
  }
  const bool relieved = state.close_pa - kAtmosphere_Pa > air.relief_pa;
  const bool vented = std::abs(state.open_pa - kAtmosphere_Pa) < kShut_pa;
  const bool cooled =
      std::abs(state.close_K - kTemperature_K) < kWarm_K && std::abs(state.open_K - kTemperature_K) < kWarm_K;
  return !relieved && vented && cooled;
}

}  // namespace pinjaw::plant

#pragma once

namespace pinjaw::plant {

/// A restriction of a pneumatic line by its two ISO 6358 figures.
struct Restriction {
  double conductance_m3_s_pa = 0;  ///< sonic conductance C; 1 dm3/(s bar) is 1e-8 m3/(s Pa)
  double critical_ratio = 0.3;     ///< b: choked flow for p2/p1 up to here
};

constexpr double kDm3PerSecondBar = 1e-8;    // 1 dm3/(s bar) in m3/(s Pa)
constexpr double kAtmosphere_Pa = 101325.0;  // standard atmosphere
constexpr double kAirConstant = 287.05;      // J/(kg K), dry air
constexpr double kTemperature_K = 293.15;  // ISO 6358 T0; walls stay there, and air under the polytropic law
constexpr double kReferenceDensity = 1.185;  // kg/m3, ISO 6358 rho0 at T0, 1 bar, 65 % humidity

/// Mass flow in kg/s from `from_pa` to `to_pa` (absolute), negative when it runs back (ISO 6358-1, the
/// elliptic law, air at T0). Linear for p2/p1 above 0.999, where the law's slope is infinite.
double mass_flow(const Restriction& line, double from_pa, double to_pa);

}  // namespace pinjaw::plant

#pragma once

namespace pinjaw::plant {

/// Friction of seals and guides, the LuGre model (Canudas de Wit et al. 1995): presliding bristles, Stribeck
/// curve, viscous part.
struct FrictionParameters {
  double coulomb_n = 6.0;              // study
  double breakaway_n = 9.0;            // the same
  double viscous_n_s_m = 25.0;         // the same
  double rest_rise = 0.3;              // the same: breakaway grows by 30 % after 8 h at rest
  double rest_full_s = 8.0 * 3600.0;   // the same
  double stribeck_m_s = 0.005;         // chosen: usual for pneumatic seals, 1 to 10 mm/s
  double bristle_n_m = 1e6;            // chosen: 9 um of presliding at breakaway
  double bristle_damping_n_s_m = 300;  // chosen: half of critical for 0.35 kg on the bristles
};

struct FrictionState {
  double bristle_m = 0;
  double rest_s = 0;  ///< since it last slid
};

/// Force that opposes the motion at `speed_m_s`; advances the bristle by `dt_s`, implicitly, so that any step
/// is stable.
double friction_force_n(const FrictionParameters& parameters, double speed_m_s, double dt_s,
                        FrictionState& state);

}  // namespace pinjaw::plant

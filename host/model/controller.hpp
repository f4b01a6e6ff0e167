#pragma once

#include <optional>
#include <string>

#include "host/model/authentication.hpp"
#include "host/model/kit.hpp"

namespace pinjaw::model {

/// Figures of the simulated pneumatics that a controller file sets; nothing: as the plant has them.
struct PlantFigures {
  std::optional<double> supply_bar;        ///< gauge
  std::optional<double> supply_droop_bar;  ///< while a neighbour moves
  std::optional<double> moving_mass_kg;
  std::optional<double> dead_volume_cm3;  ///< of each chamber, hose included
  std::optional<double> spring_n;         ///< always presses
  std::optional<double> keeper_n;         ///< behind a catch: gives what the air lacks of it
  std::optional<double> coulomb_friction_n;
  std::optional<double> breakaway_friction_n;
  std::optional<double> contact_n_mm;
  std::optional<double> close_conductance_dm3_s_bar;
  std::optional<double> leak_dm3_s_bar;
  std::optional<double> pressure_noise_mbar;
  std::optional<double> pressure_offset_mbar;
};

/// A simulated jaw controller: its address, its kit and what its hardware can do.
struct Controller {
  std::string name;
  int node = 0;  ///< 1..14
  Kit kit;
  bool passive = false;  ///< a pallet or fixture: seat switches and custody, no squeeze
  double max_squeeze_n = 0;
  double force_uncertainty_n = 0;
  PlantFigures plant;
  std::optional<Authentication> authentication;  ///< nothing: whoever is on the bus may command
};

}  // namespace pinjaw::model

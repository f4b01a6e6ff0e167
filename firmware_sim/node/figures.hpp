#pragma once

#include <cstdint>
#include <optional>

#include "firmware_sim/core/config.hpp"
#include "firmware_sim/plant/parameters.hpp"
#include "protocol/wire/aes.hpp"

namespace pinjaw::node {

/// Figures of the pneumatics that differ from the plant's own; nothing: as the plant has them.
struct PlantFigures {
  std::optional<double> supply_bar{};        ///< gauge
  std::optional<double> supply_droop_bar{};  ///< while a neighbour moves
  std::optional<double> moving_mass_kg{};
  std::optional<double> dead_volume_cm3{};  ///< of each chamber, hose included
  std::optional<double> spring_n{};         ///< always presses; the firmware counts it in
  std::optional<double> keeper_n{};         ///< behind a catch: gives what the air lacks of it
  std::optional<double> coulomb_friction_n{};
  std::optional<double> breakaway_friction_n{};
  std::optional<double> contact_n_mm{};
  std::optional<double> close_conductance_dm3_s_bar{};
  std::optional<double> leak_dm3_s_bar{};
  std::optional<double> pressure_noise_mbar{};
  std::optional<double> pressure_offset_mbar{};
};

/// What a controller's file and kit say of it, as plain values.
struct Figures {
  int node = 1;                     ///< 1..14
  bool passive = false;             ///< a pallet or fixture: three seat switches, no squeeze
  std::uint16_t kit_id = 0;         ///< first 16 bits of the kit's SHA-256
  double max_squeeze_n = 140;       ///< of the hardware, sum of both jaws
  double force_uncertainty_n = 12;  ///< of force inferred from pressure
  double separation_min_mm = 0;
  double separation_max_mm = 60;
  bool can_fd = false;             ///< with a key: CAN FD, a MAC in every frame
  std::optional<wire::Key> key{};  ///< shared with hosts; nothing: whoever is on the bus may command
  PlantFigures plant{};
};

/// Integers for the firmware.
core::Config core_config(const Figures& figures);

/// Pneumatics sized for them: stroke and volumes follow from the separations.
plant::Parameters plant_parameters(const Figures& figures);

}  // namespace pinjaw::node

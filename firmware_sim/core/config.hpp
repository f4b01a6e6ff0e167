#pragma once

#include <cstdint>
#include <optional>

#include "firmware_sim/core/state_table.hpp"
#include "protocol/wire/aes.hpp"

// An image for a microcontroller without CAN FD leaves it out by 0: some 3 KiB of flash.
#ifndef PINJAW_CAN_FD
#define PINJAW_CAN_FD 1
#endif

namespace pinjaw::core {

/// What one controller's hardware is and can do, in the integers the core decides with. It never changes
/// while the controller runs; the defaults are the 140 N class of docs/reliability.md, section 3.
///
/// Forces are sums over both jaws in 0.1 N (dn), pressures gauge in mbar, separations in 10 um.
struct Config {
  std::uint8_t node = 1;           ///< 1..14
  bool passive = false;            ///< a pallet or fixture: seat switches and custody, no squeeze
  std::uint16_t kit_id = 0;        ///< first 16 bits of the kit's SHA-256
  std::uint8_t seat_switches = 0;  ///< mask of the seat switches a passive station has

  std::int32_t hardware_limit_dn = 1400;    ///< F_hw
  std::int32_t uncertainty_dn = 120;        ///< u: the true force is within F_meas +- u
  std::int32_t area_udn_per_mbar = 259259;  ///< close chamber: 1e-7 N of squeeze per mbar; 140 N at 5.4 bar
  std::int32_t open_ratio_permille = 850;   ///< open chamber's area over the close chamber's
  std::int32_t spring_dn = 0;               ///< keeper spring, closing

  std::int32_t separation_min_10um = 0;     ///< jaws fully closed
  std::int32_t separation_max_10um = 6000;  ///< jaws fully open

  std::int32_t pressure_max_mbar = 6000;        ///< highest set point the regulator takes
  std::int32_t supply_low_mbar = 4500;          ///< chosen: below, fault 0x7010
  std::int32_t sensor_disagreement_mbar = 300;  ///< two sensors of +-1 % of 10 bar, and noise
  std::int32_t check_cracking_mbar =
      200;                           ///< section 3: the check valve takes this off the regulator's outlet
  std::int32_t pre_vent_mbar = 500;  ///< section 3: the open side's pressure before the jaws may close

  std::uint32_t serial = 0;

  std::optional<wire::Key> key{};  ///< shared with hosts: commands must prove that they know it
  bool can_fd = false;  ///< with a key: a MAC in every frame; classic frames but HOLD are not heard

  std::int32_t ramp_dn_per_ms = 5;  ///< section 3: at most 0.5 N/ms
  std::int32_t hold_band_dn = 10;   ///< chosen: half the dead band while holding, several times sensor noise

  /// For tests only: shows that the guard, and nothing else, keeps the force in its limits.
  bool force_guard_enabled = true;
  /// For tests only: shows what the other channel does alone.
  bool release_guard_enabled = true;

  /// The state machine; tests hand in mistaken ones. The last member, so that all others lie alike in memory
  /// whatever the size of a pointer.
  const StateTable* table = &kStateTable;
};

/// Every frame is one of CAN FD with a MAC.
constexpr bool on_can_fd(const Config& config) {
  return PINJAW_CAN_FD != 0 && config.can_fd && config.key;
}

}  // namespace pinjaw::core

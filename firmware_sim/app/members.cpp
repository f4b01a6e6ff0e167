#include "firmware_sim/app/members.hpp"

#include <fmt/format.h>

#include <map>
#include <span>

#include "host/config/read.hpp"
#include "protocol/wire/layout.hpp"

namespace pinjaw::jaw_app {

node::Figures figures_of(const model::Controller& controller) {
  const model::PlantFigures& plant = controller.plant;
  std::optional<wire::Key> key;
  if (controller.authentication) key = controller.authentication->key;
  return {.node = controller.node,
          .passive = controller.passive,
          .kit_id = wire::kit_id_of(std::span(controller.kit.sha256)),
          .max_squeeze_n = controller.max_squeeze_n,
          .force_uncertainty_n = controller.force_uncertainty_n,
          .separation_min_mm = controller.kit.jaws.separation_mm.lo,
          .separation_max_mm = controller.kit.jaws.separation_mm.hi,
          .can_fd = controller.authentication && controller.authentication->can_fd,
          .key = key,
          .plant = {.supply_bar = plant.supply_bar,
                    .supply_droop_bar = plant.supply_droop_bar,
                    .moving_mass_kg = plant.moving_mass_kg,
                    .dead_volume_cm3 = plant.dead_volume_cm3,
                    .spring_n = plant.spring_n,
                    .keeper_n = plant.keeper_n,
                    .coulomb_friction_n = plant.coulomb_friction_n,
                    .breakaway_friction_n = plant.breakaway_friction_n,
                    .contact_n_mm = plant.contact_n_mm,
                    .close_conductance_dm3_s_bar = plant.close_conductance_dm3_s_bar,
                    .leak_dm3_s_bar = plant.leak_dm3_s_bar,
                    .pressure_noise_mbar = plant.pressure_noise_mbar,
                    .pressure_offset_mbar = plant.pressure_offset_mbar}};
}

base::Checked<std::vector<node::Figures>> read_members(const std::vector<std::filesystem::path>& paths) {
  base::Diagnostics mistakes;
  std::vector<node::Figures> members;
  std::map<int, std::string> seen;
  for (const std::filesystem::path& path : paths) {
    const auto controller = config::read_controller(path);
    if (!controller) {
      mistakes.add(controller.error());
      continue;
    }
    const auto [other, fresh] = seen.emplace(controller->node, path.string());
    if (!fresh) {
      mistakes.add({.file = path.string()}, "node",
                   fmt::format("{} is node {} too", other->second, controller->node));
    }
    members.push_back(figures_of(*controller));
  }
  if (!mistakes.empty()) return tl::unexpected(mistakes);
  return members;
}

}  // namespace pinjaw::jaw_app

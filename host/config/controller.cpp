#include <fmt/format.h>

#include <utility>

#include "host/config/fields.hpp"
#include "host/config/key_file.hpp"
#include "host/config/read.hpp"

namespace pinjaw::config {
namespace {

using base::YamlMap;

void read_hardware(YamlMap map, model::Controller& controller) {
  controller.max_squeeze_n = map.number("max_squeeze_n", force_above_0());
  controller.force_uncertainty_n = map.number_or("force_uncertainty_n", force_at_least_0(), 0);
  if (2 * controller.force_uncertainty_n >= controller.max_squeeze_n) {
    map.mistake_at("force_uncertainty_n",
                   fmt::format("2 x {} leaves nothing of max_squeeze_n {}", controller.force_uncertainty_n,
                               controller.max_squeeze_n));
  }
  map.finish();
}

model::PlantFigures read_plant(YamlMap map) {
  model::PlantFigures plant;
  const auto read = [&map](std::string_view key, std::string_view noun, double most,
                           std::optional<double>& into) {
    const auto value = map.find(key);
    if (!value) return;
    base::NumberRule rule{fmt::format("{} from 0 to {}", noun, most)};
    rule.at_least = 0;
    rule.at_most = most;
    into = value->number(rule);
  };
  read("supply_bar", "a gauge pressure", 12, plant.supply_bar);
  read("supply_droop_bar", "a pressure", 12, plant.supply_droop_bar);
  read("moving_mass_kg", "a mass", 100, plant.moving_mass_kg);
  read("dead_volume_cm3", "a volume", 1000, plant.dead_volume_cm3);
  read("spring_n", "a force", 1000, plant.spring_n);
  read("keeper_n", "a force", 1000, plant.keeper_n);
  read("coulomb_friction_n", "a force", 1000, plant.coulomb_friction_n);
  read("breakaway_friction_n", "a force", 1000, plant.breakaway_friction_n);
  read("contact_n_mm", "a stiffness", 1e6, plant.contact_n_mm);
  read("close_conductance_dm3_s_bar", "a conductance", 10, plant.close_conductance_dm3_s_bar);
  read("leak_dm3_s_bar", "a conductance", 10, plant.leak_dm3_s_bar);
  read("pressure_noise_mbar", "a pressure", 1000, plant.pressure_noise_mbar);
  read("pressure_offset_mbar", "a pressure", 1000, plant.pressure_offset_mbar);
  map.finish();
  return plant;
}

}  // namespace

Read<model::Controller> read_controller(const std::filesystem::path& path) {
  base::YamlFile file(path);
  YamlMap top = top_of(file, "controller");
  base::Diagnostics nested;
  model::Controller controller;
  controller.name = top.text("controller", "a name");
  controller.node = top.whole("node", whole_between("a node number", 1, 14));
  if (const auto kit = top.require("kit")) {
    const auto kit_file = named_file(*kit);
    if (kit_file) controller.kit = take(read_kit(*kit_file), nested).value_or(model::Kit{});
  }
  if (const auto passive = top.find("passive")) controller.passive = passive->truth().value_or(false);
  const auto hardware = controller.passive ? top.find("hardware") : top.require("hardware");
  if (hardware && controller.passive) hardware->mistake("a passive controller has no actuator");
  if (hardware && !controller.passive)
    read_hardware(hardware->map("settings {max_squeeze_n: ...}"), controller);
  if (const auto plant = top.find("plant"))
    controller.plant = read_plant(plant->map("settings {key: value}"));
  if (const auto key = top.find("authentication")) controller.authentication = read_authentication(*key);
  top.finish();
  return checked(file, nested, std::move(controller));
}

}  // namespace pinjaw::config

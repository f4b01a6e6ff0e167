#include <fmt/format.h>

#include "host/config/disturbances.hpp"
#include "host/config/fields.hpp"
#include "host/config/part_source.hpp"
#include "host/config/ranges.hpp"
#include "host/config/read.hpp"

namespace pinjaw::config {
namespace {

using base::Diagnostics;
using base::YamlMap;
using base::YamlValue;

/// What `friction` says, before the material is known: a coefficient, or a table and what the pins are of.
struct FrictionSource {
  std::optional<YamlValue> at;
  std::optional<double> coefficient;
  std::optional<std::filesystem::path> table;
  std::string pins;
};

FrictionSource read_friction(YamlMap& top) {
  FrictionSource friction;
  friction.at = top.require("friction");
  if (!friction.at) return friction;
  if (!friction.at->is_map()) {
    base::NumberRule rule{"a coefficient above 0 and at most 2, or {table: FILE, pins: MATERIAL}"};
    rule.above = 0;
    rule.at_most = 2;
    friction.coefficient = friction.at->number(rule);
    return friction;
  }
  YamlMap map = friction.at->map("settings {table: FILE, pins: MATERIAL}");
  if (const auto table = map.require("table")) friction.table = named_file(*table);
  friction.pins = map.text("pins", "a material");
  map.finish();
  return friction;
}

double coefficient(const FrictionSource& friction, const std::string& material, const Materials& materials) {
  if (friction.coefficient) return *friction.coefficient;
  if (!friction.table || friction.pins.empty()) return 0;  // a mistake, told where it was made
  if (material.empty()) {
    friction.at->mistake("a friction table needs the part's material");
    return 0;
  }
  const auto found = materials.static_friction(material, friction.pins);
  if (found) return *found;
  friction.at->mistake(materials.no_such_pair(material, friction.pins));
  return 0;
}

/// All that the pins could be made of, by the table that the task names.
std::vector<model::PinMaterial> pin_materials(const FrictionSource& friction, const std::string& material,
                                              const Materials& materials) {
  std::vector<model::PinMaterial> pins;
  if (!friction.table) return pins;
  for (const std::string& name : materials.names()) {
    if (const auto mu = materials.static_friction(material, name)) pins.push_back({name, *mu});
  }
  return pins;
}

model::Obstacle read_obstacle(const YamlValue& item) {
  YamlMap map = item.map("an obstacle {file: ..., pose: {...}}");
  model::Obstacle obstacle;
  if (const auto file = map.require("file")) obstacle.file = read_shape_file(*file, false).value_or("");
  if (const auto pose = map.find("pose")) {
    YamlMap at = pose->map("settings {x_mm, y_mm, z_mm, theta_deg}");
    obstacle.pose.t_mm.x() = at.number_or("x_mm", coordinate(), 0);
    obstacle.pose.t_mm.y() = at.number_or("y_mm", coordinate(), 0);
    obstacle.z_mm = at.number_or("z_mm", coordinate(), 0);
    obstacle.pose.theta_rad = at.number_or("theta_deg", angle_deg(), 0) * kRadPerDeg;
    at.finish();
  }
  map.finish();
  return obstacle;
}

std::optional<model::Attached> read_attached(YamlMap& top) {
  const auto value = top.find("attached");
  if (!value) return {};
  YamlMap map = value->map("settings {file: ..., base: NAME}");
  model::Attached attached;
  if (const auto file = map.require("file")) attached.file = read_shape_file(*file, false).value_or("");
  attached.base = map.text("base", "the name of the base part");
  map.finish();
  return attached;
}

}  // namespace

Read<model::Task> read_task(const std::filesystem::path& path) {
  base::YamlFile file(path);
  YamlMap top = top_of(file, "task");
  Diagnostics nested;
  model::Task task;
  task.name = top.text("task", "a name");
  const FrictionSource friction = read_friction(top);
  const Materials materials = materials_for(path.parent_path(), friction.table, nested);
  if (const auto part = top.require("part")) task.part = read_part_source(*part, materials, nested);
  task.friction = coefficient(friction, task.part.material, materials);
  task.pin_materials = pin_materials(friction, task.part.material, materials);
  if (const auto kit = top.require("kit")) {
    const auto kit_file = named_file(*kit);
    if (kit_file) task.kit = take(read_kit(*kit_file), nested).value_or(model::Kit{});
  }
  if (const auto side = top.find("side")) {
    task.side = side->one_of({"below", "above"}) == 1 ? model::Side::Above : model::Side::Below;
  }
  DisturbanceLists lists = read_disturbances(top);
  task.always = std::move(lists.always);
  task.disturbances = std::move(lists.disturbances);
  if (const auto obstacles = top.find("obstacles")) {
    const auto items = obstacles->list("a list of obstacles [{file: ...}, ...]", {0, 100});
    for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) {
      task.obstacles.push_back(read_obstacle(item));
    }
  }
  task.attached = read_attached(top);
  task.ranges = read_ranges(top, task.friction);
  top.finish();
  return checked(file, nested, std::move(task));
}

}  // namespace pinjaw::config

#include <fmt/format.h>

#include <algorithm>

#include "host/config/fields.hpp"
#include "host/config/key_file.hpp"
#include "host/config/part_source.hpp"
#include "host/config/read.hpp"

namespace pinjaw::config {
namespace {

using base::Diagnostics;
using base::YamlMap;
using base::YamlValue;

model::Adjust read_adjust(const YamlValue& value) {
  YamlMap map = value.map("settings {x_mm, y_mm, theta_deg: [least, most]}");
  model::Adjust adjust;
  const geometry::Interval none{0, 0};
  if (const auto x = map.find("x_mm")) adjust.x_mm = interval(*x, coordinate()).value_or(none);
  if (const auto y = map.find("y_mm")) adjust.y_mm = interval(*y, coordinate()).value_or(none);
  if (const auto theta = map.find("theta_deg")) {
    const geometry::Interval degrees = interval(*theta, angle_deg()).value_or(none);
    adjust.theta_rad = {degrees.lo * kRadPerDeg, degrees.hi * kRadPerDeg};
  }
  map.finish();
  return adjust;
}

/// What a task and its cell say differently of the part; empty where they agree.
std::string disagreement(const model::PartSource& cell, const model::PartSource& task) {
  std::error_code ignored;
  if (!std::filesystem::equivalent(cell.file, task.file, ignored)) {
    return fmt::format("holds another part ({}) than the cell ({})", task.file.string(), cell.file.string());
  }
  constexpr double kSameDirection = 1e-9;  // chosen: the rounding of a written direction
  if ((cell.up - task.up).norm() > kSameDirection) return "holds the part with another up than the cell";
  const bool same_mass = cell.mass_kg == task.mass_kg && cell.density_g_cm3 == task.density_g_cm3;
  if (!same_mass) return "holds a part of another mass or material than the cell";
  return "";
}

void check_station(const model::Cell& cell, const model::Station& station, const YamlMap& map) {
  for (const model::Station& other : cell.stations) {
    if (!station.name.empty() && other.name == station.name) {
      map.mistake_at("name", fmt::format("another station is named {}", station.name));
    }
    if (station.node != 0 && other.node == station.node) {
      map.mistake_at("node", fmt::format("node {} is station {}'s", station.node, other.name));
    }
  }
  const bool both_known = !cell.part.file.empty() && !station.task.part.file.empty();
  const std::string difference = both_known ? disagreement(cell.part, station.task.part) : "";
  if (!difference.empty()) map.mistake_at("task", fmt::format("task {} {}", station.task.name, difference));
  if (station.grips && !station.task.name.empty() && station.task.kit.actuator.max_squeeze_n <= 0) {
    map.mistake_at(
        "task", fmt::format("station {} grips, but its kit {} has no actuator (a pallet says grips: false)",
                            station.name, station.task.kit.name));
  }
}

void read_station(const YamlValue& item, model::Cell& cell, Diagnostics& nested) {
  YamlMap map = item.map("a station {name: ..., node: ..., task: ...}");
  if (!map.present()) return;
  model::Station station;
  station.name = map.text("name", "a name");
  station.node = map.whole("node", whole_between("a node number", 1, 14));
  if (const auto task = map.require("task")) {
    const auto task_file = named_file(*task);
    if (task_file) station.task = take(read_task(*task_file), nested).value_or(model::Task{});
  }
  if (const auto adjust = map.find("adjust")) station.adjust = read_adjust(*adjust);
  if (const auto grips = map.find("grips")) station.grips = grips->truth().value_or(true);
  map.finish();
  check_station(cell, station, map);
  cell.stations.push_back(std::move(station));
}

bool same_pair(const model::Handoff& a, const model::Handoff& b) {
  return (a.giver == b.giver && a.receiver == b.receiver) || (a.giver == b.receiver && a.receiver == b.giver);
}

void read_handoff(const YamlValue& item, model::Cell& cell) {
  const auto names = item.list("two stations [GIVER, RECEIVER]", {2, 2});
  if (!names) return;
  std::vector<std::string> stations;
  for (const model::Station& station : cell.stations) stations.push_back(station.name);
  for (const YamlValue& name : *names) {
    const auto word = name.text("the name of a station");
    if (!word) return;
    if (std::find(stations.begin(), stations.end(), *word) != stations.end()) continue;
    return name.mistake(fmt::format("no station \"{}\"{}", *word, base::did_you_mean(*word, stations)));
  }
  const model::Handoff handoff{(*names)[0].raw(), (*names)[1].raw()};
  if (handoff.giver == handoff.receiver) return item.mistake("a station hands the part to itself");
  for (const model::Handoff& other : cell.handoffs) {
    if (same_pair(handoff, other))
      return item.mistake("this pair is listed before; a pair hands over both ways");
  }
  cell.handoffs.push_back(handoff);
}

}  // namespace

Read<model::Cell> read_cell(const std::filesystem::path& path) {
  base::YamlFile file(path);
  YamlMap top = top_of(file, "cell");
  Diagnostics nested;
  model::Cell cell;
  cell.name = top.text("cell", "a name");
  const Materials materials = materials_for(path.parent_path(), {}, nested);
  if (const auto part = top.require("part")) cell.part = read_part_source(*part, materials, nested);
  if (const auto stations = top.require("stations")) {
    const auto items = stations->list("a list of 1 to 14 stations", {1, 14});
    for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) read_station(item, cell, nested);
  }
  if (const auto handoffs = top.find("handoffs")) {
    const auto items = handoffs->list("a list of handoffs [[GIVER, RECEIVER], ...]", {0, 91});
    for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) read_handoff(item, cell);
  }
  if (const auto key = top.find("authentication")) cell.authentication = read_authentication(*key);
  top.finish();
  return checked(file, nested, std::move(cell));
}

}  // namespace pinjaw::config

#include "host/config/disturbances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "host/config/fields.hpp"

namespace pinjaw::config {
namespace {

using base::NumberRule;
using base::YamlMap;
using base::YamlValue;
using Eigen::Vector3d;

NumberRule force_part() {
  NumberRule rule{"a force from -1e6 to 1e6 N"};
  rule.at_least = -kStrongest_n;
  rule.at_most = kStrongest_n;
  return rule;
}

NumberRule torque_part() {
  NumberRule rule{"a torque from -1e9 to 1e9 N mm"};
  rule.at_least = -1e9;
  rule.at_most = 1e9;
  return rule;
}

Vector3d vector_at(YamlMap& map, std::string_view key, const NumberRule& rule) {
  const auto value = map.require(key);
  return (value ? vector3(*value, rule) : std::nullopt).value_or(Vector3d::Zero());
}

double nozzle_force_n(YamlMap& map) {
  NumberRule diameter{"a diameter above 0 and at most 100 mm"};
  diameter.above = 0;
  diameter.at_most = 100;
  NumberRule flow{"a flow above 0 and at most 1000 l/s"};
  flow.above = 0;
  flow.at_most = 1000;
  NumberRule density{"a density above 0 and at most 20000 kg/m3"};
  density.above = 0;
  density.at_most = 20000;
  model::Nozzle nozzle;
  nozzle.nozzle_mm = map.number("nozzle_mm", diameter);
  nozzle.flow_l_s = map.number("flow_l_s", flow);
  nozzle.density_kg_m3 = map.number_or("density_kg_m3", density, nozzle.density_kg_m3);
  return model::jet_force_n(nozzle);
}

void read_cone(YamlMap& map, model::Spray& spray) {
  const auto from = map.find("from");
  const auto within = map.find("within_deg");
  if (from) spray.from = unit_vector(*from);
  if (within) {
    NumberRule rule{"an angle above 0 and at most 180 degrees"};
    rule.above = 0;
    rule.at_most = 180;
    if (const auto angle_deg = within->number(rule)) spray.within_rad = *angle_deg * kRadPerDeg;
  }
  if (from.has_value() != within.has_value()) map.mistake("expected both from and within_deg, or neither");
}

model::Spray read_spray(YamlMap& map) {
  model::Spray spray;
  const bool by_nozzle = map.has("nozzle_mm") || map.has("flow_l_s");
  if (map.has("force_n") || !by_nozzle) spray.force_n = map.number("force_n", force_above_0());
  if (map.has("force_n") && by_nozzle) {
    map.mistake_at_key("force_n", "expected either force_n or nozzle_mm and flow_l_s, found both");
  }
  if (by_nozzle) spray.force_n = nozzle_force_n(map);
  spray.count = map.whole("count", whole_between("a count of rays", 1, 100000));
  if (const auto seed = map.find("seed")) {
    const auto number = seed->whole(whole_between("a seed", 0, std::numeric_limits<std::int64_t>::max()));
    spray.seed = static_cast<std::uint64_t>(number.value_or(1));
  }
  read_cone(map, spray);
  return spray;
}

model::Acceleration read_acceleration(YamlMap& map) {
  model::Acceleration acceleration;
  NumberRule peak{"an acceleration above 0 and at most 1000 g"};
  peak.above = 0;
  peak.at_most = 1000;
  acceleration.peak_g = map.number("peak_g", peak);
  const auto along = map.require("along");
  const auto directions =
      along ? along->list("a list of directions [[x, y, z], ...]", {1, 1000}) : std::nullopt;
  for (const YamlValue& direction : directions.value_or(std::vector<YamlValue>{})) {
    if (const auto unit = unit_vector(direction)) acceleration.along.push_back(*unit);
  }
  return acceleration;
}

/// `{gravity: [x, y, z]}`, or `{gravity: {name: ..., direction: [x, y, z]}}`.
model::Gravity read_gravity(const YamlValue& direction) {
  model::Gravity gravity;
  gravity.direction = unit_vector(direction).value_or(Vector3d(-Vector3d::UnitZ()));
  return gravity;
}

model::DisturbanceSource read_mapping(const std::string& kind, YamlMap& map) {
  if (kind == "spray") return read_spray(map);
  if (kind == "acceleration") return read_acceleration(map);
  if (kind == "force") {
    model::PointForce force;
    force.at_mm = vector_at(map, "at_mm", coordinate());
    force.force_n = vector_at(map, "force_n", force_part());
    return force;
  }
  if (kind == "wrench") {
    model::PlainWrench wrench;
    wrench.force_n = vector_at(map, "force_n", force_part());
    wrench.torque_nmm = vector_at(map, "torque_nmm", torque_part());
    return wrench;
  }
  const auto direction = map.require("direction");
  return direction ? read_gravity(*direction) : model::Gravity{};
}

/// Gives out names: each stands for one disturbance.
class Names {
 public:
  std::string given(const YamlValue& value) {
    std::string name = value.text("a name").value_or("");
    const auto [first, is_new] = lines_.emplace(name, value.place().line);
    if (!is_new && !name.empty()) {
      value.mistake(fmt::format("\"{}\" names another disturbance, in line {}", name, first->second));
    }
    return name;
  }

  std::string made(const std::string& kind, int line) {
    std::string name = kind;
    for (int number = 2; !lines_.emplace(name, line).second; ++number)
      name = fmt::format("{}-{}", kind, number);
    return name;
  }

 private:
  std::map<std::string, int> lines_;
};

struct Entry {
  YamlValue at;
  std::string kind;
  bool named = false;
  model::DisturbanceSource source;
};

std::optional<Entry> read_entry(const YamlValue& item, Names& names) {
  static const std::vector<std::string> known_kinds = {"gravity", "acceleration", "spray", "force", "wrench"};
  const auto choice = only_choice(item, "a disturbance {KIND: {...}}", known_kinds);
  if (!choice) return {};
  Entry entry{choice->value, choice->word, false, {}};
  if (choice->word == "gravity" && choice->value.is_list()) {
    entry.source = read_gravity(choice->value);
    return entry;
  }
  YamlMap map = choice->value.map("settings {key: value}");
  if (!map.present()) return {};
  const auto name = map.find("name");
  entry.source = read_mapping(choice->word, map);
  map.finish();
  if (name) {
    entry.named = true;
    std::visit([&](auto& source) { source.name = names.given(*name); }, entry.source);
  }
  return entry;
}

std::vector<Entry> read_list(YamlMap& task, std::string_view key, Names& names) {
  std::vector<Entry> entries;
  const auto list = task.find(key);
  const auto items =
      list ? list->list("a list of disturbances [{KIND: {...}}, ...]", {0, 10000}) : std::nullopt;
  for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) {
    if (auto entry = read_entry(item, names)) entries.push_back(std::move(*entry));
  }
  return entries;
}

void refuse_samples(const Entry& entry) {
  const auto* acceleration = std::get_if<model::Acceleration>(&entry.source);
  if (acceleration != nullptr && acceleration->along.size() > 1) {
    entry.at.mistake("acts always, so along one direction only; list the others under disturbances");
  }
  if (std::holds_alternative<model::Spray>(entry.source)) {
    entry.at.mistake("a spray is many loads, of which one acts at a time; list it under disturbances");
  }
}

/// How many loads a source stands for.
std::int64_t loads_of(const model::DisturbanceSource& source) {
  if (const auto* spray = std::get_if<model::Spray>(&source)) return spray->count;
  const auto* acceleration = std::get_if<model::Acceleration>(&source);
  return acceleration == nullptr ? 1 : static_cast<std::int64_t>(acceleration->along.size());
}

/// Each design is held against every load; so many bound memory to some 100 MB.
void refuse_too_many(const std::vector<Entry>& entries) {
  constexpr std::int64_t kMost = 1'000'000;
  std::int64_t loads = 0;
  for (const Entry& entry : entries) {
    loads += loads_of(entry.source);
    if (loads <= kMost) continue;
    return entry.at.mistake(fmt::format("with this the task has {} loads; expected up to {}", loads, kMost));
  }
}

}  // namespace

DisturbanceLists read_disturbances(YamlMap& task) {
  Names names;
  std::vector<Entry> always = read_list(task, "always", names);
  std::vector<Entry> disturbances = read_list(task, "disturbances", names);
  if (!task.has("disturbances") && task.present()) {
    task.mistake("lacks disturbances (a list; [] where the part is only located)");
  }
  refuse_too_many(disturbances);
  DisturbanceLists lists;
  // Names made up come after all given ones, so that none of them takes a name from a later line.
  for (auto* entries : {&always, &disturbances}) {
    for (Entry& entry : *entries) {
      const std::string name = entry.named ? "" : names.made(entry.kind, entry.at.place().line);
      if (!entry.named) std::visit([&](auto& source) { source.name = name; }, entry.source);
      if (entries == &always) refuse_samples(entry);
      (entries == &always ? lists.always : lists.disturbances).push_back(std::move(entry.source));
    }
  }
  return lists;
}

}  // namespace pinjaw::config

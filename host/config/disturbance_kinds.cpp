#include "host/config/disturbance_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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

NumberRule torque_at_least_0() {
  NumberRule rule{"a torque from 0 to 1e9 N mm"};
  rule.at_least = 0;
  rule.at_most = 1e9;
  return rule;
}

/// A unit vector; where it is missing or wrong (which is reported) -z.
Vector3d direction_at(YamlMap& map, std::string_view key) {
  const auto value = map.require(key);
  return (value ? unit_vector(*value) : std::nullopt).value_or(Vector3d(-Vector3d::UnitZ()));
}

/// `[x, y, z]`, or `{name: ..., direction: [x, y, z]}`.
std::optional<model::Heading> heading(const YamlValue& value) {
  if (!value.is_map()) {
    const auto unit = unit_vector(value);
    return unit ? std::optional<model::Heading>(*unit) : std::nullopt;
  }
  YamlMap map = value.map("settings {name: ..., direction: [x, y, z]}");
  const std::string name = map.text("name", "a name");
  const auto direction = map.require("direction");
  const auto unit = direction ? unit_vector(*direction) : std::nullopt;
  map.finish();
  if (!unit) return {};
  return model::Heading(*unit, name);
}

std::vector<model::Heading> headings(const YamlValue& value, std::string_view what) {
  std::vector<model::Heading> all;
  const auto items = value.list(what, {1, 1000});
  for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) {
    if (auto one = heading(item)) all.push_back(std::move(*one));
  }
  return all;
}

model::Acceleration read_acceleration(YamlMap& map) {
  model::Acceleration acceleration;
  NumberRule peak{"an acceleration above 0 and at most 1000 g"};
  peak.above = 0;
  peak.at_most = 1000;
  acceleration.peak_g = map.number("peak_g", peak);
  const auto along = map.require("along");
  if (!along) return acceleration;
  if (along->is_list()) {
    acceleration.along = headings(*along, "a list of directions [[x, y, z], ...]");
  } else if (along->raw() == "axes") {
    for (const double way : {1.0, -1.0}) {
      for (int axis = 0; axis < 3; ++axis) acceleration.along.emplace_back(way * Vector3d::Unit(axis));
    }
  } else if (along->raw() == "all") {
    acceleration.every_direction = true;
  } else {
    along->mistake(
        fmt::format("expected directions [[x, y, z], ...], axes or all, found \"{}\"", along->raw()));
  }
  return acceleration;
}

/// `direction` or `poses`; the short form `{gravity: [x, y, z]}` is not a mapping.
model::Gravity read_gravity(YamlMap& map) {
  model::Gravity gravity;
  const auto poses = map.find("poses");
  const auto direction = poses ? map.find("direction") : map.require("direction");
  if (poses && direction) map.mistake("expected either direction or poses, found both");
  if (poses) gravity.poses = headings(*poses, "a list of directions [[x, y, z], ...]");
  if (direction) {
    if (const auto unit = unit_vector(*direction)) gravity.poses = {*unit};
  }
  return gravity;
}

model::PointForce read_force(YamlMap& map) {
  model::PointForce force;
  force.at_mm = vector_at(map, "at_mm", coordinate());
  force.force_n = vector_at(map, "force_n", force_part());
  return force;
}

model::PlainWrench read_wrench(YamlMap& map) {
  model::PlainWrench wrench;
  wrench.force_n = vector_at(map, "force_n", force_part());
  wrench.torque_nmm = vector_at(map, "torque_nmm", torque_part());
  return wrench;
}

model::Drilling read_drilling(YamlMap& map) {
  model::Drilling drilling;
  drilling.at_mm = vector_at(map, "at_mm", coordinate());
  drilling.axis = direction_at(map, "axis");
  drilling.thrust_n = map.number("thrust_n", force_above_0());
  drilling.torque_nmm = map.number_or("torque_nmm", torque_at_least_0(), 0);
  drilling.pull_n = map.number_or("pull_n", force_at_least_0(), 0);
  using Turns = model::Drilling::Turns;
  constexpr std::array<Turns, 3> kTurns = {Turns::Right, Turns::Left, Turns::Both};
  if (const auto turns = map.find("turns"))
    drilling.turns = kTurns[turns->one_of({"right", "left", "both"}).value_or(0)];
  return drilling;
}

model::Insertion read_insertion(YamlMap& map) {
  model::Insertion insertion;
  insertion.at_mm = vector_at(map, "at_mm", coordinate());
  insertion.along = direction_at(map, "along");
  insertion.force_n = map.number("force_n", force_above_0());
  insertion.side_n = map.number_or("side_n", force_at_least_0(), 0);
  return insertion;
}

/// The corners of a polyline; neighbours must be apart, else a run has no direction.
std::vector<Vector3d> points_at(const YamlValue& value) {
  std::vector<Vector3d> points_mm;
  const auto items = value.list("a list of 2 or more points [[x, y, z], ...]", {2, 10000});
  constexpr double kApart_mm = 1e-6;
  for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) {
    const auto point = vector3(item, coordinate());
    if (!point) continue;
    if (!points_mm.empty() && (*point - points_mm.back()).norm() < kApart_mm)
      item.mistake("expected a point away from the one before, found the same");
    points_mm.push_back(*point);
  }
  return points_mm;
}

model::Path read_path(YamlMap& map) {
  model::Path path;
  if (const auto points = map.require("points_mm")) path.points_mm = points_at(*points);
  const auto force = map.find("force_n");
  if (force) path.force_n = vector3(*force, force_part()).value_or(Vector3d::Zero());
  const bool drags = map.has("drag_n");
  if (drags) path.drag_n = map.number("drag_n", force_above_0());
  if (const auto back = map.find("back_and_forth")) {
    path.back_and_forth = back->truth().value_or(false);
    if (!drags) back->mistake("means nothing without drag_n: a constant force acts the same either way");
  }
  if (!force && !drags && map.present()) map.mistake("lacks force_n (or drag_n, or both)");
  return path;
}

model::Milling read_milling(YamlMap& map) {
  model::Milling milling;
  const auto at = map.find("at_mm");
  const auto points = at ? map.find("points_mm") : map.require("points_mm");
  if (at && points) map.mistake("expected either at_mm or points_mm, found both");
  if (points) milling.points_mm = points_at(*points);
  if (at) milling.points_mm = {vector3(*at, coordinate()).value_or(Vector3d::Zero())};
  milling.axis = direction_at(map, "axis");
  milling.side_n = map.number("side_n", force_above_0());
  milling.axial_n = map.number_or("axial_n", force_at_least_0(), 0);
  milling.torque_nmm = map.number_or("torque_nmm", torque_at_least_0(), 0);
  return milling;
}

using Reader = model::SingleSource (*)(YamlMap&);

template <auto kRead>
model::SingleSource as_source(YamlMap& map) {
  return kRead(map);
}

struct Kind {
  std::string word;
  Reader read;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kKinds = {
      {"gravity", as_source<read_gravity>},     {"acceleration", as_source<read_acceleration>},
      {"spray", as_source<read_spray>},         {"force", as_source<read_force>},
      {"wrench", as_source<read_wrench>},       {"drilling", as_source<read_drilling>},
      {"insertion", as_source<read_insertion>}, {"path", as_source<read_path>},
      {"milling", as_source<read_milling>}};
  return kKinds;
}

}  // namespace

const std::vector<std::string>& single_kinds() {
  static const std::vector<std::string> kWords = [] {
    std::vector<std::string> words;
    for (const Kind& kind : kinds()) words.push_back(kind.word);
    return words;
  }();
  return kWords;
}

model::SingleSource read_single(const std::string& kind, YamlMap& settings) {
  return std::ranges::find(kinds(), kind, &Kind::word)->read(settings);
}

}  // namespace pinjaw::config

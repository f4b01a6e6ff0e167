#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/base/sha256.hpp"
#include "host/config/fields.hpp"
#include "host/config/read.hpp"

namespace pinjaw::config {
namespace {

using base::YamlMap;
using base::YamlValue;

/// The mapping under `key`; absent, and reported, where it is missing.
YamlMap section(base::YamlFile& file, YamlMap& top, std::string_view key) {
  const std::optional<YamlValue> value = top.require(key);
  return value ? value->map("settings {key: value}") : file.no_map();
}

model::Grid read_grid(YamlMap map) {
  model::Grid grid;
  grid.spacing_mm = map.number("spacing_mm", length_above_0());
  grid.columns = map.whole("columns", whole_between("a count of columns", 1, 64));
  grid.rows = map.whole("rows", whole_between("a count of rows", 1, 64));
  grid.edge_offset_mm = map.number("edge_offset_mm", length_at_least_0());
  map.finish();
  return grid;
}

std::vector<double> read_lengths(const YamlValue& value) {
  if (value.raw() == "any") return {};
  const auto items = value.list("any, or a list of stock lengths in mm", {1, 1000});
  if (!items) return {};
  std::vector<double> lengths;
  for (const YamlValue& item : *items) {
    const std::optional<double> length = item.number(length_above_0());
    if (!length) continue;
    if (std::find(lengths.begin(), lengths.end(), *length) != lengths.end()) {
      item.mistake(fmt::format("the length {} is listed twice", *length));
    }
    lengths.push_back(*length);
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

model::PinStock read_pins(YamlMap map) {
  model::PinStock pins;
  pins.radius_mm = map.number("radius_mm", length_above_0());
  if (const auto lengths = map.require("lengths_mm")) pins.lengths_mm = read_lengths(*lengths);
  pins.min_engagement_mm = map.number("min_engagement_mm", length_above_0());
  pins.protrusion_mm = map.number("protrusion_mm", length_at_least_0());
  pins.clearance_mm = map.number_or("clearance_mm", length_at_least_0(), pins.clearance_mm);
  pins.min_foot_margin_mm = map.number_or("min_foot_margin_mm", length_at_least_0(), pins.min_foot_margin_mm);
  map.finish();
  return pins;
}

std::vector<model::JawBody> read_bodies(const YamlValue& value) {
  const auto items = value.list("a list of boxes {x_mm, y_mm, z_mm}", {1, model::Jaws::kMaxBodies});
  if (!items) return {};
  std::vector<model::JawBody> bodies;
  for (const YamlValue& item : *items) {
    YamlMap map = item.map("a box {x_mm: [lo, hi], y_mm: [lo, hi], z_mm: [lo, hi]}");
    model::JawBody body;
    for (const auto& [key, extent] :
         {std::pair{"x_mm", &body.x_mm}, {"y_mm", &body.y_mm}, {"z_mm", &body.z_mm}}) {
      const auto range = map.require(key);
      if (!range) continue;
      *extent = interval(*range, coordinate()).value_or(geometry::Interval{});
      if (extent->lo == extent->hi) range->mistake("the box has no extent here");
    }
    map.finish();
    bodies.push_back(body);
  }
  return bodies;
}

model::Jaws read_jaws(YamlMap map) {
  model::Jaws jaws;
  if (const auto range = map.require("separation_mm")) {
    jaws.separation_mm = interval(*range, length_at_least_0()).value_or(geometry::Interval{std::nan(""), 0});
    if (jaws.separation_mm.lo == jaws.separation_mm.hi) range->mistake("the jaws have no travel");
  }
  jaws.plate_gap_mm = map.number("plate_gap_mm", length_at_least_0());
  if (const auto opening = map.find("opening_mm")) {
    base::NumberRule rule = length_above_0();
    rule.what = "a travel of 1 mm or more";
    rule.at_least = 1;
    jaws.opening_mm = opening->number(rule);
  }
  jaws.plate_thickness_mm = map.number_or("plate_thickness_mm", length_above_0(), jaws.plate_thickness_mm);
  if (const auto bodies = map.find("bodies")) jaws.bodies = read_bodies(*bodies);
  map.finish();
  return jaws;
}

model::Actuator read_actuator(YamlMap map) {
  model::Actuator actuator;
  actuator.max_squeeze_n = map.number("max_squeeze_n", force_above_0());
  actuator.force_uncertainty_n = map.number_or("force_uncertainty_n", force_at_least_0(), 0);
  if (actuator.usable_squeeze_n() <= 0) {
    map.mistake_at("force_uncertainty_n", fmt::format("2 x {} leaves nothing of max_squeeze_n {}",
                                                      actuator.force_uncertainty_n, actuator.max_squeeze_n));
  }
  map.finish();
  return actuator;
}

model::Grip read_grip(YamlMap map, const model::Actuator& actuator) {
  model::Grip grip;
  grip.light_n = map.number_or("light_n", force_above_0(), grip.light_n);
  grip.separation_tol_mm = map.number_or("separation_tol_mm", length_above_0(), grip.separation_tol_mm);
  grip.slip_tol_mm = map.number_or("slip_tol_mm", length_above_0(), grip.slip_tol_mm);
  base::NumberRule milliseconds{"milliseconds above 0 and at most 60000"};
  milliseconds.above = 0;
  milliseconds.at_most = 60000;
  grip.stable_ms = map.number_or("stable_ms", milliseconds, grip.stable_ms);
  if (map.has("light_n") && grip.light_n > actuator.usable_squeeze_n()) {
    map.mistake_at("light_n", fmt::format("{} is more than the actuator's usable {}", grip.light_n,
                                          actuator.usable_squeeze_n()));
  }
  map.finish();
  return grip;
}

/// Rules between the settings of one kit. A setting that is wrong by itself is NaN and breaks none of them.
void check_together(const model::Kit& kit, const YamlMap& pins) {
  for (const model::KitConflict conflict : model::conflicts_of(kit)) {
    switch (conflict) {
      case model::KitConflict::PinsOverlap:
        pins.mistake_at("radius_mm", fmt::format("pins of radius {} overlap in holes {} apart",
                                                 kit.pins.radius_mm, kit.grid.spacing_mm));
        break;
      case model::KitConflict::PinMeetsOtherPlate:
        pins.mistake_at(
            "protrusion_mm",
            fmt::format("a pin that protrudes {} would reach the other gripper's plate, plate_gap_mm {} away",
                        kit.pins.protrusion_mm, kit.jaws.plate_gap_mm));
        break;
      case model::KitConflict::NoPinReachesThePart:
        pins.mistake_at("lengths_mm", fmt::format("no length passes plate_gap_mm {}: no pin reaches the part",
                                                  kit.jaws.plate_gap_mm));
        break;
    }
  }
}

}  // namespace

Read<model::Kit> read_kit(const std::filesystem::path& path) {
  base::YamlFile file(path);
  YamlMap top = top_of(file, "kit");
  model::Kit kit;
  kit.name = top.text("kit", "a name");
  kit.sha256 = base::sha256(file.bytes());
  kit.grid = read_grid(section(file, top, "grid"));
  YamlMap pins = section(file, top, "pins");
  kit.pins = read_pins(pins);
  kit.jaws = read_jaws(section(file, top, "jaws"));
  // A kit whose plate the part rests on only locates; it may have no actuator.
  const bool may_lack_actuator = kit.jaws.plate_gap_mm == 0 && top.present();
  if (!may_lack_actuator || top.has("actuator")) kit.actuator = read_actuator(section(file, top, "actuator"));
  if (const auto grip = top.find("grip"))
    kit.grip = read_grip(grip->map("settings {key: value}"), kit.actuator);
  check_together(kit, pins);
  top.finish();
  return checked(file, {}, std::move(kit));
}

}  // namespace pinjaw::config

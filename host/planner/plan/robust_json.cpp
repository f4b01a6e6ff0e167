#include "host/planner/plan/robust_json.hpp"

#include <algorithm>

namespace pinjaw::planner {

namespace {

using base::JsonField;
using nlohmann::ordered_json;

ordered_json interval_json(const geometry::Interval& interval) {
  return ordered_json::array({interval.lo, interval.hi});
}

geometry::Interval read_range(const JsonField& field) {
  const std::vector<double> ends = field.numbers(2);
  if (ends[0] > ends[1]) field.mistake("expected two ascending numbers");
  return {ends[0], ends[1]};
}

/// How each figure was found: what is sampled may be passed by a point between the samples, a bound by none.
ordered_json methods() {
  return {{"worst_required_n", "friction: exact at its low end; pins and part: sampled"},
          {"location_error_mm", "sampled"},
          {"location_error_deg", "sampled"},
          {"location_bound_mm", "bound"},
          {"location_bound_deg", "bound"},
          {"usable_n", "exact at the least air pressure"}};
}

}  // namespace

ordered_json ranges_json(const model::Ranges& ranges) {
  ordered_json json;
  if (ranges.friction) json["friction"] = interval_json(*ranges.friction);
  json["pin_position_mm"] = ranges.pin_position_mm;
  json["pin_radius_mm"] = ranges.pin_radius_mm;
  json["part_size_mm"] = ranges.part_size_mm;
  json["air_pressure"] = interval_json(ranges.air_pressure);
  return json;
}

ordered_json robust_json(const model::Robust& robust) {
  ordered_json json;
  if (robust.worst_required_n) {
    json["worst_required_n"] = *robust.worst_required_n;
  } else {
    json["worst_required_n"] = nullptr;
    json["failure"] = robust.failure;
  }
  ordered_json pins = ordered_json::array();
  for (const model::PinError& error : robust.pins) {
    pins.push_back({{"towards", error.towards}, {"across", error.across}});
  }
  json["at"] = {{"friction", robust.friction}, {"pins", pins}, {"critical", robust.critical}};
  json["usable_n"] = robust.usable_n;
  if (robust.worst_required_n) json["margin_n"] = robust.margin_n;
  json["location_error_mm"] = robust.location_error_mm;
  json["location_error_deg"] = robust.location_error_deg;
  if (robust.location_bound_mm) json["location_bound_mm"] = *robust.location_bound_mm;
  if (robust.location_bound_deg) json["location_bound_deg"] = *robust.location_bound_deg;
  json["method"] = methods();
  return json;
}

model::Ranges read_ranges_json(const JsonField& field) {
  model::Ranges ranges;
  if (field.has("friction")) ranges.friction = read_range(field.at("friction"));
  ranges.pin_position_mm = field.number("pin_position_mm");
  ranges.pin_radius_mm = field.number("pin_radius_mm");
  ranges.part_size_mm = field.number("part_size_mm");
  ranges.air_pressure = read_range(field.at("air_pressure"));
  return ranges;
}

model::Robust read_robust(const JsonField& field) {
  model::Robust robust;
  if (field.has("failure")) {
    robust.failure = field.text("failure");
  } else {
    robust.worst_required_n = field.number("worst_required_n");
    robust.margin_n = field.number("margin_n");
  }
  const JsonField at = field.at("at");
  robust.friction = at.number("friction");
  robust.critical = at.text("critical");
  const std::vector<JsonField> pins = at.at("pins").list();
  if (pins.size() != robust.pins.size()) at.mistake("expected four pins");
  for (std::size_t i = 0; i < std::min(pins.size(), robust.pins.size()); ++i) {
    robust.pins[i] = {pins[i].number("towards"), pins[i].number("across")};
  }
  robust.usable_n = field.number("usable_n");
  robust.location_error_mm = field.number("location_error_mm");
  robust.location_error_deg = field.number("location_error_deg");
  if (field.has("location_bound_mm")) robust.location_bound_mm = field.number("location_bound_mm");
  if (field.has("location_bound_deg")) robust.location_bound_deg = field.number("location_bound_deg");
  return robust;
}

}  // namespace pinjaw::planner

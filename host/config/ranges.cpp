#include "host/config/ranges.hpp"

#include <fmt/format.h>

#include "host/config/fields.hpp"

namespace pinjaw::config {
namespace {

base::NumberRule error_mm() {
  base::NumberRule rule = length_at_least_0();
  rule.what = "a length from 0 to 5 mm";  // chosen: more is no error but another part
  rule.at_most = 5;
  return rule;
}

}  // namespace

model::Ranges read_ranges(base::YamlMap& task, double friction) {
  model::Ranges ranges;
  const auto value = task.find("ranges");
  if (!value) return ranges;
  base::YamlMap map =
      value->map("settings {friction, pin_position_mm, pin_radius_mm, part_size_mm, air_pressure}");
  if (const auto range = map.find("friction")) {
    base::NumberRule rule{"a coefficient above 0 and at most 2"};
    rule.above = 0;
    rule.at_most = 2;
    ranges.friction = interval(*range, rule);
    if (ranges.friction && friction > 0 && !ranges.friction->contains(friction))
      range->mistake(fmt::format("the task's friction {} is outside this range", friction));
  }
  ranges.pin_position_mm = map.number_or("pin_position_mm", error_mm(), ranges.pin_position_mm);
  ranges.pin_radius_mm = map.number_or("pin_radius_mm", error_mm(), ranges.pin_radius_mm);
  ranges.part_size_mm = map.number_or("part_size_mm", error_mm(), ranges.part_size_mm);
  if (const auto range = map.find("air_pressure")) {
    base::NumberRule rule{"a share of the nominal pressure above 0 and at most 2"};
    rule.above = 0;
    rule.at_most = 2;
    const auto share = interval(*range, rule);
    if (share && !share->contains(1)) range->mistake("the nominal pressure, 1, is outside this range");
    if (share) ranges.air_pressure = *share;
  }
  map.finish();
  return ranges;
}

}  // namespace pinjaw::config

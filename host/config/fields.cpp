#include "host/config/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pinjaw::config {

using base::NumberRule;
using base::WholeRule;
using base::YamlFile;
using base::YamlMap;
using base::YamlValue;

namespace {

NumberRule above_0(std::string what, double at_most) {
  NumberRule rule{std::move(what)};
  rule.above = 0;
  rule.at_most = at_most;
  return rule;
}

NumberRule between(std::string what, double at_least, double at_most) {
  NumberRule rule{std::move(what)};
  rule.at_least = at_least;
  rule.at_most = at_most;
  return rule;
}

}  // namespace

NumberRule length_above_0() {
  return above_0("a length above 0 and at most 10000 mm", kLongest_mm);
}
NumberRule length_at_least_0() {
  return between("a length from 0 to 10000 mm", 0, kLongest_mm);
}
NumberRule coordinate() {
  return between("a coordinate from -10000 to 10000 mm", -kLongest_mm, kLongest_mm);
}
NumberRule force_above_0() {
  return above_0("a force above 0 and at most 1e6 N", kStrongest_n);
}
NumberRule force_at_least_0() {
  return between("a force from 0 to 1e6 N", 0, kStrongest_n);
}
NumberRule seconds_above_0() {
  return above_0("seconds above 0 and at most 86400", 86400);
}
NumberRule angle_deg() {
  return between("an angle from -360 to 360 degrees", -360, 360);
}
NumberRule acceleration_g() {
  return between("an acceleration from 0 to 1000 g", 0, 1000);
}

WholeRule whole_between(std::string_view noun, std::int64_t least, std::int64_t most) {
  return {fmt::format("{} from {} to {}", noun, least, most), least, most};
}

std::optional<geometry::Interval> interval(const YamlValue& value, const NumberRule& rule) {
  const auto ends = value.numbers(2, rule, "two numbers [least, most]");
  if (!ends) return {};
  if ((*ends)[0] <= (*ends)[1]) return geometry::Interval{(*ends)[0], (*ends)[1]};
  value.mistake(fmt::format("the least ({}) is above the most ({})", (*ends)[0], (*ends)[1]));
  return {};
}

std::optional<Eigen::Vector3d> vector3(const YamlValue& value, const NumberRule& rule) {
  const auto parts = value.numbers(3, rule, "three numbers [x, y, z]");
  if (!parts) return {};
  return Eigen::Vector3d((*parts)[0], (*parts)[1], (*parts)[2]);
}

std::optional<Eigen::Vector3d> unit_vector(const YamlValue& value) {
  const auto direction = vector3(value, between("a number from -1e6 to 1e6", -1e6, 1e6));
  if (!direction) return {};
  constexpr double kShortest = 1e-6;  // chosen: below it a direction is noise
  if (direction->norm() >= kShortest) return direction->normalized();
  value.mistake("expected a direction, found a vector of length 0");
  return {};
}

std::optional<Eigen::Vector2d> point2(const YamlValue& value) {
  const auto parts = value.numbers(2, coordinate(), "a point [x, y]");
  if (!parts) return {};
  return Eigen::Vector2d((*parts)[0], (*parts)[1]);
}

YamlMap top_of(YamlFile& file, const std::string& kind) {
  // A kind's file may name files of the kinds after it, never of those before it.
  static const std::array<std::string, 7> kinds = {"sequence", "cell", "controller", "task",
                                                   "profile",  "kit",  "materials"};
  YamlMap top = file.top();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& word) { return top.has(word); });
  if (found == kinds.end() || *found == kind) return top;
  top.mistake_at_key(*found, fmt::format("expected a file that describes a {}, found a {}", kind, *found));
  return file.no_map();
}

std::optional<Choice> only_choice(const YamlValue& entry, std::string_view what,
                                  const std::vector<std::string>& words) {
  YamlMap map = entry.map(what);
  const std::vector<std::string> keys = map.keys();
  if (!map.present()) return {};
  if (keys.size() != 1) {
    entry.mistake(fmt::format("expected {}, found {} settings", what, keys.size()));
    return {};
  }
  if (std::find(words.begin(), words.end(), keys[0]) == words.end()) {
    const std::string hint = base::did_you_mean(keys[0], words);
    map.mistake_at_key(keys[0], fmt::format("expected one of {}{}", fmt::join(words, ", "), hint));
    return {};
  }
  return Choice{keys[0], *map.find(keys[0])};
}

std::optional<std::filesystem::path> named_file(const YamlValue& value) {
  const std::optional<std::string> name = value.text("the name of a file");
  if (!name) return {};
  const std::filesystem::path path = std::filesystem::path(value.place().file).parent_path() / *name;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_regular_file(status)) {
    const std::filesystem::path plain = path.lexically_normal();
    return std::filesystem::equivalent(plain, path, error) ? plain : path;
  }
  if (!std::filesystem::exists(status)) {
    value.mistake(fmt::format("there is no file {}", path.lexically_normal().string()));
  } else {
    value.mistake(fmt::format("{} is not a regular file", path.lexically_normal().string()));
  }
  return {};
}

}  // namespace pinjaw::config

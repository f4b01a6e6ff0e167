#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/base/yaml.hpp"
#include "host/geometry/plane.hpp"

/// What the readers of all kinds share: the rules of numbers, vectors, and files that name files.
namespace pinjaw::config {

constexpr double kLongest_mm = 10000;  // chosen: a kit or part of 10 m is a mistake of units
constexpr double kStrongest_n = 1e6;   // chosen: as above
constexpr double kRadPerDeg = 0.017453292519943295;

base::NumberRule length_above_0();
base::NumberRule length_at_least_0();
base::NumberRule coordinate();
base::NumberRule force_above_0();
base::NumberRule force_at_least_0();
base::NumberRule seconds_above_0();
base::NumberRule angle_deg();
base::NumberRule acceleration_g();
base::WholeRule whole_between(std::string_view noun, std::int64_t least, std::int64_t most);

/// Two ascending numbers [lo, hi], each of `rule`; nothing (reported) where it is none.
std::optional<geometry::Interval> interval(const base::YamlValue& value, const base::NumberRule& rule);
/// Three numbers of `rule`.
std::optional<Eigen::Vector3d> vector3(const base::YamlValue& value, const base::NumberRule& rule);
/// Three numbers, not all 0, brought to length 1.
std::optional<Eigen::Vector3d> unit_vector(const base::YamlValue& value);
/// Two coordinates.
std::optional<Eigen::Vector2d> point2(const base::YamlValue& value);

/// The top mapping of a file of `kind`; where it is a file of another kind, that alone is told.
base::YamlMap top_of(base::YamlFile& file, const std::string& kind);

/// The one setting of an entry such as `spray: {...}`, whose key is among `words`; nothing (reported) where
/// it is not one, or not known.
struct Choice {
  std::string word;
  base::YamlValue value;
};
std::optional<Choice> only_choice(const base::YamlValue& entry, std::string_view what,
                                  const std::vector<std::string>& words);

/// The path of the existing regular file that `value` names, from the folder of the file it stands in.
std::optional<std::filesystem::path> named_file(const base::YamlValue& value);

/// `value` named a file that `read` has read: its value, or its mistakes added to `nested`.
template <class T>
std::optional<T> take(base::Checked<T> read, base::Diagnostics& nested) {
  if (read) return std::move(*read);
  nested.add(read.error());
  return {};
}

/// The value where no mistake was found in the file or in those it names; else all of them.
template <class T>
base::Checked<T> checked(base::YamlFile& file, const base::Diagnostics& nested, T value) {
  base::Diagnostics all = file.mistakes();
  all.add(nested);
  if (all.empty()) return value;
  return tl::unexpected<base::Diagnostics>(std::move(all));
}

}  // namespace pinjaw::config

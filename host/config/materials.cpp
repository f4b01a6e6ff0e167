#include "host/config/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "host/config/built_in_materials.hpp"
#include "host/config/fields.hpp"

namespace pinjaw::config {
namespace {

using base::YamlMap;
using base::YamlValue;

void read_densities(const YamlValue& section, Materials& table) {
  YamlMap map = section.map("materials {NAME: {density_g_cm3: ...}}");
  base::NumberRule density{"a density above 0 and at most 30 g/cm3"};
  density.above = 0;
  density.at_most = 30;
  for (const std::string& name : map.keys()) {
    YamlMap material = map.find(name)->map("settings {density_g_cm3: ...}");
    table.materials.push_back({name, material.number("density_g_cm3", density)});
    material.finish();
  }
}

void read_pair(const YamlValue& item, Materials& table) {
  YamlMap map = item.map("settings {pair: [ONE, OTHER], static: ...}");
  FrictionPair pair;
  base::NumberRule coefficient{"a coefficient above 0 and at most 2"};
  coefficient.above = 0;
  coefficient.at_most = 2;
  pair.static_friction = map.number("static", coefficient);
  if (const auto names = map.require("pair")) {
    const auto words = names->list("two materials [ONE, OTHER]", {2, 2});
    if (words) {
      pair.first = (*words)[0].text("a material").value_or("");
      pair.second = (*words)[1].text("a material").value_or("");
      for (const YamlValue& word : *words) {
        if (table.density_g_cm3(word.raw()) || word.raw().empty()) continue;
        word.mistake(fmt::format("no such material{}", base::did_you_mean(word.raw(), table.names())));
      }
      if (table.static_friction(pair.first, pair.second)) names->mistake("this pair is listed before");
    }
  }
  map.finish();
  table.pairs.push_back(std::move(pair));
}

base::Checked<Materials> read_table(base::YamlFile file) {
  YamlMap top = top_of(file, "materials");
  Materials table;
  table.source = file.name();
  if (const auto section = top.require("materials")) read_densities(*section, table);
  if (const auto friction = top.find("friction")) {
    const auto items = friction->list("a list of {pair: [ONE, OTHER], static: ...}");
    for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) read_pair(item, table);
  }
  top.finish();
  return checked(file, {}, std::move(table));
}

}  // namespace

std::optional<double> Materials::density_g_cm3(const std::string& name) const {
  const auto is_it = [&](const Material& material) { return material.name == name; };
  const auto found = std::find_if(materials.begin(), materials.end(), is_it);
  if (found == materials.end()) return {};
  return found->density_g_cm3;
}

std::optional<double> Materials::static_friction(const std::string& one, const std::string& other) const {
  for (const FrictionPair& pair : pairs) {
    const bool same =
        (pair.first == one && pair.second == other) || (pair.first == other && pair.second == one);
    if (same) return pair.static_friction;
  }
  return {};
}

std::vector<std::string> Materials::names() const {
  std::vector<std::string> names;
  for (const Material& material : materials) names.push_back(material.name);
  return names;
}

std::string Materials::no_such_material(const std::string& name) const {
  return fmt::format("no material \"{}\" in {}{}; known: {}", name, source, base::did_you_mean(name, names()),
                     fmt::join(names(), ", "));
}

std::string Materials::no_such_pair(const std::string& one, const std::string& other) const {
  std::vector<std::string> known;
  for (const FrictionPair& pair : pairs) {
    const bool has_either =
        pair.first == one || pair.first == other || pair.second == one || pair.second == other;
    if (has_either) known.push_back(pair.first + " on " + pair.second);
  }
  const bool both_known = density_g_cm3(one) && density_g_cm3(other);
  const std::string hint = both_known ? "" : base::did_you_mean(other, names());
  return fmt::format("{} has no friction of {} on {}{}; known of these: {}", source, one, other, hint,
                     known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")));
}

base::Checked<Materials> read_materials(const std::filesystem::path& path) {
  return read_table(base::YamlFile(path));
}

const Materials& built_in_materials() {
  static const Materials table = [] {
    base::Checked<Materials> read = read_table(base::YamlFile(kBuiltInMaterials, "the built-in materials"));
    if (!read) throw std::logic_error(base::render(read.error(), "pinjaw was built with them"));
    return *read;
  }();
  return table;
}

}  // namespace pinjaw::config

#include "host/config/part_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "host/config/fields.hpp"
#include "host/config/read.hpp"

namespace pinjaw::config {
namespace {

using base::YamlMap;
using base::YamlValue;

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension;
}

bool is_profile(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".yaml" || extension == ".yml";
}

bool is_cad(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".step" || extension == ".stp" || extension == ".stl";
}

void read_mass(YamlMap& map, const Materials& materials, model::PartSource& part) {
  const auto mass = map.find("mass_kg");
  const auto material = map.find("material");
  if (mass) {
    base::NumberRule rule{"a mass above 0 and at most 1000 kg"};
    rule.above = 0;
    rule.at_most = 1000;
    part.mass_kg = mass->number(rule);
  }
  if (material) {
    part.material = material->text("a material").value_or("");
    part.density_g_cm3 = materials.density_g_cm3(part.material);
    if (!part.density_g_cm3 && !part.material.empty()) {
      material->mistake(materials.no_such_material(part.material));
    }
  }
  if (mass && material) map.mistake_at_key("mass_kg", "expected either mass_kg or material, found both");
  if (!mass && !material && map.present()) map.mistake("lacks material (or mass_kg)");
}

}  // namespace

Materials materials_for(const std::filesystem::path& folder,
                        const std::optional<std::filesystem::path>& table, base::Diagnostics& nested) {
  std::optional<std::filesystem::path> found = table;
  for (const std::filesystem::path& near : {folder, folder / ".."}) {
    std::error_code ignored;
    const std::filesystem::path candidate = (near / "materials.yaml").lexically_normal();
    if (!found && std::filesystem::is_regular_file(candidate, ignored)) found = candidate;
  }
  if (!found) return built_in_materials();
  return take(read_materials(*found), nested).value_or(built_in_materials());
}

std::optional<std::filesystem::path> read_shape_file(const YamlValue& value, bool or_profile) {
  std::optional<std::filesystem::path> file = named_file(value);
  if (!file || is_cad(*file) || (or_profile && is_profile(*file))) return file;
  const std::string_view kinds = or_profile ? ".step, .stp, .stl or .yaml" : ".step, .stp or .stl";
  value.mistake(fmt::format("expected a {} file, found \"{}\"", kinds, value.raw()));
  return {};
}

model::PartSource read_part_source(const YamlValue& value, const Materials& materials,
                                   base::Diagnostics& nested) {
  YamlMap map = value.map("settings {file: ..., up: ..., material: ...}");
  model::PartSource part;
  if (const auto file = map.require("file")) part.file = read_shape_file(*file, true).value_or("");
  if (is_profile(part.file)) part.profile = take(read_profile(part.file), nested);
  if (const auto up = map.find("up")) part.up = unit_vector(*up).value_or(Eigen::Vector3d::UnitZ());
  read_mass(map, materials, part);
  map.finish();
  return part;
}

}  // namespace pinjaw::config

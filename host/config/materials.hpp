#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/base/diagnostics.hpp"

namespace pinjaw::config {

struct Material {
  std::string name;
  double density_g_cm3 = 0;
};

/// Static friction between two materials, in either order.
struct FrictionPair {
  std::string first;
  std::string second;
  double static_friction = 0;
};

/// `materials.yaml`: densities, and a static friction coefficient for each pair.
struct Materials {
  std::string source;  ///< the file, or "the built-in materials"
  std::vector<Material> materials;
  std::vector<FrictionPair> pairs;

  [[nodiscard]] std::optional<double> density_g_cm3(const std::string& name) const;
  [[nodiscard]] std::optional<double> static_friction(const std::string& one, const std::string& other) const;
  [[nodiscard]] std::vector<std::string> names() const;

  /// What to tell of a name that is no material: the nearest one, and all that are known.
  [[nodiscard]] std::string no_such_material(const std::string& name) const;
  /// What to tell of a pair without a coefficient: the pairs that one of the two has.
  [[nodiscard]] std::string no_such_pair(const std::string& one, const std::string& other) const;
};

base::Checked<Materials> read_materials(const std::filesystem::path& path);

/// The table that comes with pinjaw (configs/materials.yaml when it was built).
const Materials& built_in_materials();

}  // namespace pinjaw::config

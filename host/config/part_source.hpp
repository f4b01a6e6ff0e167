#pragma once

#include <optional>

#include "host/base/yaml.hpp"
#include "host/config/materials.hpp"
#include "host/model/task.hpp"

namespace pinjaw::config {

/// The table of materials for a file in `folder`: `table` where the file names one, else the nearest
/// `materials.yaml` in the folder or the one above it, else the built-in one. Mistakes go into `nested`.
Materials materials_for(const std::filesystem::path& folder,
                        const std::optional<std::filesystem::path>& table, base::Diagnostics& nested);

/// `part: {file, up, material | mass_kg}`; a profile part is read too, its mistakes go into `nested`.
model::PartSource read_part_source(const base::YamlValue& value, const Materials& materials,
                                   base::Diagnostics& nested);

/// A CAD file (.step, .stp, .stl) that exists; `or_profile`: or a profile (.yaml, .yml).
std::optional<std::filesystem::path> read_shape_file(const base::YamlValue& value, bool or_profile);

}  // namespace pinjaw::config

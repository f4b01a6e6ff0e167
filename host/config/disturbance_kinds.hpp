#pragma once

#include <string>
#include <vector>

#include "host/base/yaml.hpp"
#include "host/model/disturbance.hpp"

namespace pinjaw::config {

/// The kinds of disturbance that are one source: `gravity`, `spray`, ...; `together` is not among them.
const std::vector<std::string>& single_kinds();

/// Reads the settings of a source of `kind`, which is one of single_kinds(). Its name is the caller's to
/// read; so is the end of the settings.
model::SingleSource read_single(const std::string& kind, base::YamlMap& settings);

}  // namespace pinjaw::config

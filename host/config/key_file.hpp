#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "host/base/expected.hpp"
#include "host/base/yaml.hpp"
#include "host/model/authentication.hpp"

namespace pinjaw::config {

/// The 16 bytes of a file that holds 32 hexadecimal digits and nothing else but spaces around them. A file
/// that others than its owner's group can read or write is refused; no failure tells what a file holds.
base::Expected<std::array<std::uint8_t, 16>> read_key_file(const std::filesystem::path& path);

/// `authentication: {key_file: FILE, can_fd: true}` of a controller or a cell.
std::optional<model::Authentication> read_authentication(const base::YamlValue& value);

}  // namespace pinjaw::config

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "host/base/expected.hpp"

namespace pinjaw::base {

/// SHA-256 (FIPS 180-4) of the bytes, as 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);

/// SHA-256 of a file's content.
Expected<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace pinjaw::base

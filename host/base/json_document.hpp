#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "host/base/diagnostics.hpp"

namespace pinjaw::base {

/// Chosen: a plan with every design of a large kit takes a tenth; parsed it takes up to ten times as much.
inline constexpr std::size_t kMaxJsonBytes = 256U << 20U;

/// A JSON file that a program wrote, parsed, with the text that places its mistakes.
struct JsonDocument {
  std::string name;  ///< of the file, as diagnostics call it
  std::string text;
  nlohmann::json value;
};

/// Reads a file whose top-level `format` must be `format`, or tells why it is none: unreadable, not JSON,
/// another kind.
Checked<JsonDocument> read_json_document(const std::filesystem::path& path, const std::string& format);

}  // namespace pinjaw::base

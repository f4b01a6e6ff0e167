#include "host/base/json_document.hpp"

#include "host/base/files.hpp"
#include "host/base/json_fields.hpp"
#include "host/base/json_places.hpp"

namespace pinjaw::base {

Checked<JsonDocument> read_json_document(const std::filesystem::path& path, const std::string& format) {
  JsonDocument document{path.string(), {}, {}};
  auto bytes = read_file(path, kMaxJsonBytes);
  if (!bytes) return tl::unexpected(Diagnostics({{document.name, 0, 0}, "", bytes.error().message}));
  document.text = std::move(*bytes);
  auto value = parse_json(document.text, document.name);
  if (!value) return tl::unexpected(value.error());
  document.value = std::move(*value);

  Diagnostics unread;
  if (JsonField(&document.value, "", &document.name, &unread).text("format") != format) {
    const Diagnostics other_kind({{document.name, 0, 0}, "format", "expected " + format});
    return tl::unexpected(placed_in_json(other_kind, document.text));
  }
  return document;
}

}  // namespace pinjaw::base

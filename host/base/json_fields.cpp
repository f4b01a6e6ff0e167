#include "host/base/json_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pinjaw::base {

namespace {

std::string shown(const nlohmann::json& value) {
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  if (value.is_object()) return "an object";
  std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  constexpr std::size_t kMost = 40;
  if (text.size() > kMost) text = text.substr(0, kMost) + "…";
  return text;
}

Place place_of_byte(std::string_view text, std::size_t byte, const std::string& file) {
  Place place{file, 1, 1};
  for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
    if (text[i] == '\n') {
      ++place.line;
      place.column = 1;
    } else {
      ++place.column;
    }
  }
  return place;
}

/// Where a value begins that lies deeper than kMaxJsonDepth; the parser does not limit depth itself.
std::optional<std::size_t> first_deep_byte(std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\') ++i;
    if (c == '"') in_string = !in_string;
    if (in_string) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kMaxJsonDepth) return i + 1;
  }
  return std::nullopt;
}

tl::unexpected<Diagnostics> not_json(Place place, std::string why) {
  return tl::unexpected(Diagnostics(Diagnostic{std::move(place), "", std::move(why)}));
}

/// The parser's sentence without its number and place; it may quote as much of the file as it has read.
std::string sentence_of(std::string_view what) {
  constexpr std::size_t kLongest = 200;
  const std::size_t start = what.find(": ", what.find("column"));
  std::string text(start == std::string_view::npos ? what : what.substr(start + 2));
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return "not JSON: " + text;
}

}  // namespace

bool JsonField::has(std::string_view key) const {
  return value_ != nullptr && value_->is_object() && value_->contains(key);
}

JsonField JsonField::at(std::string_view key) const {
  std::string path = path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
  if (value_ == nullptr) return {nullptr, std::move(path), file_, mistakes_};
  if (!value_->is_object()) {
    expected("an object");
    return {nullptr, std::move(path), file_, mistakes_};
  }
  const auto found = value_->find(key);
  JsonField field(found == value_->end() ? nullptr : &*found, std::move(path), file_, mistakes_);
  if (found == value_->end()) field.mistake("missing");
  return field;
}

double JsonField::number(const NumberRule& rule) const {
  if (value_ == nullptr) return 0;
  const double value = value_->is_number() ? value_->get<double>() : std::nan("");
  if (std::isfinite(value) && rule.allows(value)) return value;
  expected(rule.what);
  return 0;
}

std::int64_t JsonField::whole(const WholeRule& rule) const {
  if (value_ == nullptr) return 0;
  constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
  const bool fits =
      value_->is_number_integer() && (!value_->is_number_unsigned() || value_->get<std::uint64_t>() <= kMost);
  if (fits && rule.allows(value_->get<std::int64_t>())) return value_->get<std::int64_t>();
  expected(rule.what);
  return 0;
}

std::string JsonField::text() const {
  if (value_ == nullptr) return {};
  if (value_->is_string()) return value_->get<std::string>();
  expected("a text");
  return {};
}

bool JsonField::truth() const {
  if (value_ == nullptr) return false;
  if (value_->is_boolean()) return value_->get<bool>();
  expected("true or false");
  return false;
}

std::vector<std::string> JsonField::keys() const {
  std::vector<std::string> names;
  if (value_ == nullptr) return names;
  if (!value_->is_object()) {
    expected("an object");
    return names;
  }
  for (const auto& [name, value] : value_->items()) names.push_back(name);
  return names;
}

std::vector<JsonField> JsonField::list() const {
  std::vector<JsonField> entries;
  if (value_ == nullptr) return entries;
  if (!value_->is_array()) {
    expected("a list");
    return entries;
  }
  entries.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) {
    entries.emplace_back(&(*value_)[i], fmt::format("{}[{}]", path_, i), file_, mistakes_);
  }
  return entries;
}

std::vector<double> JsonField::numbers(std::size_t count, const NumberRule& rule) const {
  const std::vector<JsonField> entries = list();
  std::vector<double> values(count);
  if (value_ == nullptr || !value_->is_array()) return values;
  if (entries.size() != count) {
    mistake(fmt::format("expected {} numbers, found {}", count, entries.size()));
    return values;
  }
  for (std::size_t i = 0; i < count; ++i) values[i] = entries[i].number(rule);
  return values;
}

std::size_t JsonField::one_of(const std::vector<std::string>& words) const {
  if (value_ == nullptr) return 0;
  const std::string word = value_->is_string() ? value_->get<std::string>() : std::string();
  const auto found = std::ranges::find(words, word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  expected(fmt::format("one of {}", fmt::join(words, ", ")));
  return 0;
}

void JsonField::mistake(std::string message) const {
  mistakes_->add({*file_, 0, 0}, path_, std::move(message));
}

void JsonField::expected(std::string_view what) const {
  mistake(fmt::format("expected {}, found {}", what, shown(*value_)));
}

Checked<nlohmann::json> parse_json(std::string_view text, const std::string& file) {
  if (const auto byte = first_deep_byte(text))
    return not_json(place_of_byte(text, *byte, file), "nested too deeply");
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    return not_json(place_of_byte(text, error.byte, file), sentence_of(error.what()));
  } catch (const nlohmann::json::out_of_range& error) {  // of a number that no double holds
    const std::string sentence = error.what();
    const std::size_t from = sentence.find('\'') + 1;
    const std::size_t byte = text.find(sentence.substr(from, sentence.find('\'', from) - from));
    return not_json(place_of_byte(text, byte + 1, file), "a number too large to be read");
  }
}

}  // namespace pinjaw::base

#include "host/base/json_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pinjaw::base {

namespace {

std::string shown(const nlohmann::json& value) {
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

double JsonField::number() const {
  if (value_ == nullptr) return 0;
  if (value_->is_number() && std::isfinite(value_->get<double>())) return value_->get<double>();
  expected("a number");
  return 0;
}

std::int64_t JsonField::whole() const {
  if (value_ == nullptr) return 0;
  if (value_->is_number_integer()) return value_->get<std::int64_t>();
  expected("a whole number");
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

std::vector<double> JsonField::numbers(std::size_t count) const {
  std::vector<double> values;
  for (const JsonField& entry : list()) values.push_back(entry.number());
  if (value_ != nullptr && value_->is_array() && values.size() != count) {
    mistake(fmt::format("expected {} numbers, found {}", count, values.size()));
  }
  values.resize(count);
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
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    std::string message = error.what();
    if (const auto colon = message.find(": ", message.find("column")); colon != std::string::npos) {
      message = message.substr(colon + 2);
    }
    return tl::unexpected(
        Diagnostics(Diagnostic{place_of_byte(text, error.byte, file), "", "not JSON: " + message}));
  }
}

}  // namespace pinjaw::base

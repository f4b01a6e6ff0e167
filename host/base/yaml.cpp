#include "host/base/yaml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "host/base/files.hpp"
#include "host/base/yaml_tree.hpp"

namespace pinjaw::base {
namespace {

/// The text as it can stand in a message: one line, not long.
std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 60;  // chosen: a line of a terminal with the place before it
  std::string line;
  for (const char each : text.substr(0, kLongest))
    line += each == '\n' || each == '\t' || each == '\r' ? ' ' : each;
  while (text.size() > kLongest && !line.empty() && (static_cast<unsigned char>(line.back()) & 0x80U) != 0) {
    line.pop_back();
  }
  return fmt::format("\"{}{}\"", line, text.size() > kLongest ? "..." : "");
}

std::string found(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::Nothing:
      return "nothing";
    case YamlNode::Kind::Plain:
      return shown(node.text);
    case YamlNode::Kind::Quoted:
      return "the quoted text " + shown(node.text);
    case YamlNode::Kind::List:
      return fmt::format("a list of {}", node.items.size());
    case YamlNode::Kind::Map:
      return "a mapping";
  }
  return "?";
}

/// A decimal number: all of the text, finite, no hexadecimal, no infinity or NaN.
std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with("+-")) return {};
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::optional<std::int64_t> parse_whole(std::string_view text) {
  if (text.starts_with("+-")) return {};
  if (text.starts_with('+')) text.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

const YamlEntry* entry_of(const YamlNode* node, std::string_view key) {
  if (node == nullptr) return nullptr;
  const auto is_it = [key](const YamlEntry& entry) { return entry.key == key; };
  const auto entry = std::find_if(node->entries.begin(), node->entries.end(), is_it);
  return entry == node->entries.end() ? nullptr : &*entry;
}

}  // namespace

YamlValue::YamlValue(const YamlNode* node, std::string path, Diagnostics* mistakes, const std::string* file)
    : node_(node), path_(std::move(path)), mistakes_(mistakes), file_(file) {}

bool YamlValue::is_map() const {
  return node_->kind == YamlNode::Kind::Map;
}
bool YamlValue::is_list() const {
  return node_->kind == YamlNode::Kind::List;
}
bool YamlValue::is_scalar() const {
  return node_->kind == YamlNode::Kind::Plain || node_->kind == YamlNode::Kind::Quoted;
}

void YamlValue::expected(std::string_view what) const {
  mistake(fmt::format("expected {}, found {}", what, found(*node_)));
}

std::optional<double> YamlValue::number(const NumberRule& rule) const {
  const std::optional<double> value =
      node_->kind == YamlNode::Kind::Plain ? parse_number(node_->text) : std::nullopt;
  if (value && rule.allows(*value)) return value;
  expected(rule.what);
  return {};
}

std::optional<std::int64_t> YamlValue::whole(const WholeRule& rule) const {
  const std::optional<std::int64_t> value =
      node_->kind == YamlNode::Kind::Plain ? parse_whole(node_->text) : std::nullopt;
  if (value && rule.allows(*value)) return value;
  expected(rule.what);
  return {};
}

std::optional<std::string> YamlValue::text(std::string_view what) const {
  if (is_scalar() && !node_->text.empty()) return node_->text;
  expected(what);
  return {};
}

std::optional<bool> YamlValue::truth() const {
  if (node_->kind == YamlNode::Kind::Plain && node_->text == "true") return true;
  if (node_->kind == YamlNode::Kind::Plain && node_->text == "false") return false;
  expected("true or false");
  return {};
}

std::optional<std::size_t> YamlValue::one_of(const std::vector<std::string>& words) const {
  const auto word = is_scalar() ? std::find(words.begin(), words.end(), node_->text) : words.end();
  if (word != words.end()) return static_cast<std::size_t>(word - words.begin());
  std::string what;
  for (std::size_t i = 0; i < words.size(); ++i) {
    what += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  }
  const std::string hint = is_scalar() ? did_you_mean(node_->text, words) : "";
  mistake(fmt::format("expected {}, found {}{}", what, found(*node_), hint));
  return {};
}

std::optional<std::vector<YamlValue>> YamlValue::list(std::string_view what, const CountRule& rule) const {
  if (!is_list() || node_->items.size() < rule.at_least || node_->items.size() > rule.at_most) {
    expected(what);
    return {};
  }
  std::vector<YamlValue> values;
  for (std::size_t i = 0; i < node_->items.size(); ++i) {
    values.emplace_back(&node_->items[i], fmt::format("{}[{}]", path_, i), mistakes_, file_);
  }
  return values;
}

std::optional<std::vector<double>> YamlValue::numbers(std::size_t count, const NumberRule& rule,
                                                      std::string_view what) const {
  const auto items = list(what, {count, count});
  if (!items) return {};
  std::vector<double> values;
  for (const YamlValue& item : *items) {
    if (const std::optional<double> value = item.number(rule)) values.push_back(*value);
  }
  if (values.size() != count) return {};
  return values;
}

YamlMap YamlValue::map(std::string_view what) const {
  if (!is_map()) expected(what);
  return {is_map() ? node_ : nullptr, path_, mistakes_, file_};
}

std::string YamlValue::raw() const {
  return node_->text;
}

void YamlValue::mistake(std::string message) const {
  mistakes_->add(place(), path_, std::move(message));
}

Place YamlValue::place() const {
  return {*file_, node_->line, node_->column};
}

YamlMap::YamlMap(const YamlNode* node, std::string path, Diagnostics* mistakes, const std::string* file)
    : node_(node), path_(std::move(path)), mistakes_(mistakes), file_(file) {}

std::string YamlMap::path_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

bool YamlMap::has(std::string_view key) const {
  return entry_of(node_, key) != nullptr;
}

std::optional<YamlValue> YamlMap::find(std::string_view key) {
  known_.emplace_back(key);
  const YamlEntry* entry = entry_of(node_, key);
  if (entry == nullptr) return {};
  return YamlValue(&entry->value, path_of(key), mistakes_, file_);
}

std::optional<YamlValue> YamlMap::require(std::string_view key) {
  std::optional<YamlValue> value = find(key);
  if (!value && present()) mistake(fmt::format("lacks {}", key));
  return value;
}

double YamlMap::number(std::string_view key, const NumberRule& rule) {
  const std::optional<YamlValue> value = require(key);
  return (value ? value->number(rule) : std::nullopt).value_or(std::nan(""));
}

double YamlMap::number_or(std::string_view key, const NumberRule& rule, double otherwise) {
  const std::optional<YamlValue> value = find(key);
  if (!value) return otherwise;
  return value->number(rule).value_or(std::nan(""));
}

int YamlMap::whole(std::string_view key, const WholeRule& rule) {
  const std::optional<YamlValue> value = require(key);
  return static_cast<int>((value ? value->whole(rule) : std::nullopt).value_or(0));
}

std::string YamlMap::text(std::string_view key, std::string_view what) {
  const std::optional<YamlValue> value = require(key);
  return (value ? value->text(what) : std::nullopt).value_or("");
}

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> keys;
  if (node_ == nullptr) return keys;
  for (const YamlEntry& entry : node_->entries) keys.push_back(entry.key);
  return keys;
}

void YamlMap::mistake_at(std::string_view key, std::string message) const {
  const YamlEntry* entry = entry_of(node_, key);
  if (entry == nullptr) return mistake(std::move(message));
  mistakes_->add({*file_, entry->value.line, entry->value.column}, path_of(key), std::move(message));
}

void YamlMap::mistake_at_key(std::string_view key, std::string message) const {
  const YamlEntry* entry = entry_of(node_, key);
  if (entry == nullptr) return mistake(std::move(message));
  mistakes_->add({*file_, entry->line, entry->column}, path_of(key), std::move(message));
}

void YamlMap::mistake(std::string message) const {
  if (node_ == nullptr) return;
  mistakes_->add({*file_, node_->line, node_->column}, path_, std::move(message));
}

void YamlMap::finish() const {
  for (const std::string& key : keys()) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    std::string shown_key = key;
    if (shown_key.size() > 40) shown_key = shown_key.substr(0, 40) + "...";
    mistake_at_key(key, "no such setting" + did_you_mean(key, known_));
  }
}

struct YamlFile::Content {
  std::string name;
  std::string bytes;
  YamlNode root;
  bool parsed = false;
  Diagnostics mistakes;

  void parse() { parsed = parse_yaml(bytes, name, root, mistakes); }
};

YamlFile::YamlFile(const std::filesystem::path& path) : content_(std::make_unique<Content>()) {
  content_->name = path.string();
  Expected<std::string> bytes = read_file(path, kMaxBytes);
  if (!bytes) {
    content_->mistakes.add({content_->name, 0, 0}, "", bytes.error().message);
    return;
  }
  content_->bytes = std::move(*bytes);
  content_->parse();
}

YamlFile::YamlFile(std::string_view text, std::string name) : content_(std::make_unique<Content>()) {
  content_->name = std::move(name);
  content_->bytes = text;
  content_->parse();
}

YamlFile::~YamlFile() = default;
YamlFile::YamlFile(YamlFile&&) noexcept = default;
YamlFile& YamlFile::operator=(YamlFile&&) noexcept = default;

YamlMap YamlFile::top() {
  const YamlValue value(&content_->root, "", &content_->mistakes, &content_->name);
  if (content_->parsed) return value.map("settings (key: value)");
  return no_map();
}

YamlMap YamlFile::no_map() {
  return {nullptr, "", &content_->mistakes, &content_->name};
}

const std::string& YamlFile::bytes() const {
  return content_->bytes;
}
const std::string& YamlFile::name() const {
  return content_->name;
}
Diagnostics& YamlFile::mistakes() {
  return content_->mistakes;
}

}  // namespace pinjaw::base

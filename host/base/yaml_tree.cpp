#include "host/base/yaml_tree.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "host/base/yaml.hpp"

namespace pinjaw::base {
namespace {

/// Why parsing ended early; thrown through the parser, caught in parse_yaml.
struct Refusal {
  YAML::Mark mark;
  std::string message;
};

/// Builds the tree from the parser's events, and stops where a limit is passed.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& file, Diagnostics& mistakes) : file_(file), mistakes_(mistakes) {}

  [[nodiscard]] YamlNode& root() { return root_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    begin(mark, "", anchor, YamlNode::Kind::Nothing);
    end();
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw Refusal{mark, "aliases (*name) are not allowed here; write the value again"};
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    begin(mark, tag, anchor, tag == "!" ? YamlNode::Kind::Quoted : YamlNode::Kind::Plain);
    open_.back().node.text = value;
    end();
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(mark, tag, anchor, YamlNode::Kind::List);
  }
  void OnSequenceEnd() override { end(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(mark, tag, anchor, YamlNode::Kind::Map);
  }
  void OnMapEnd() override { end(); }

 private:
  struct Open {
    YamlNode node;
    std::optional<YamlEntry> key;  ///< of a map, read and waiting for its value
  };

  void begin(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YamlNode::Kind kind) {
    if (anchor != 0)
      throw Refusal{mark, "anchors (&name) are not allowed here; write the value in each place"};
    if (!tag.empty() && tag != "?" && tag != "!")
      throw Refusal{mark, fmt::format("tags ({}) are not allowed here", tag)};
    if (open_.size() > YamlFile::kMaxDepth) throw Refusal{mark, "nested too deeply"};
    if (++values_ > YamlFile::kMaxValues) throw Refusal{mark, "too many values for one file"};
    YamlNode node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    open_.push_back({std::move(node), {}});
  }

  void end() {
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (open_.back().node.kind == YamlNode::Kind::List) {
      open_.back().node.items.push_back(std::move(node));
    } else if (!open_.back().key) {
      take_key(std::move(node));
    } else {
      take_value(std::move(node));
    }
  }

  void take_key(YamlNode node) {
    if (node.kind != YamlNode::Kind::Plain && node.kind != YamlNode::Kind::Quoted) {
      throw Refusal{{}, fmt::format("a key must be a word (line {})", node.line)};
    }
    open_.back().key = YamlEntry{std::move(node.text), node.line, node.column, {}};
  }

  void take_value(YamlNode node) {
    YamlEntry entry = std::move(*open_.back().key);
    open_.back().key.reset();
    entry.value = std::move(node);
    std::vector<YamlEntry>& entries = open_.back().node.entries;
    const auto same = [&](const YamlEntry& other) { return other.key == entry.key; };
    const auto first = std::find_if(entries.begin(), entries.end(), same);
    if (first == entries.end()) {
      if (entries.size() == YamlFile::kMaxKeys)
        throw Refusal{{}, fmt::format("too many settings in one mapping (line {})", entry.line)};
      entries.push_back(std::move(entry));
      return;
    }
    mistakes_.add({file_, entry.line, entry.column}, path_of(entry.key),
                  fmt::format("given twice; first in line {}", first->line));
  }

  /// Key path of `key` in the map that is being read.
  [[nodiscard]] std::string path_of(const std::string& key) const {
    std::string path;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
      if (!open_[i].key) path += fmt::format("[{}]", open_[i].node.items.size());
      if (open_[i].key) path += fmt::format("{}{}", path.empty() ? "" : ".", open_[i].key->key);
    }
    return fmt::format("{}{}{}", path, path.empty() ? "" : ".", key);
  }

  const std::string& file_;
  Diagnostics& mistakes_;
  std::vector<Open> open_;
  std::size_t values_ = 0;
  YamlNode root_;
};

Place place_of(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null() || mark.line < 0) return {file, 0, 0};
  return {file, mark.line + 1, mark.column + 1};
}

/// Length of the UTF-8 sequence at the start of `text`; 0 where it is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  return length;
}

/// Where the first byte lies that no text file has; nothing in a text file.
std::optional<Place> first_foreign_byte(std::string_view text, const std::string& file) {
  Place place{file, 1, 1};
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    const auto first = static_cast<unsigned char>(text[i]);
    const bool control = (first < 0x20 && first != '\t' && first != '\n' && first != '\r') || first == 0x7F;
    if (length == 0 || control) return place;
    place.line += first == '\n' ? 1 : 0;
    place.column = first == '\n' ? 1 : place.column + 1;
    i += length;
  }
  return {};
}

}  // namespace

bool parse_yaml(std::string_view text, const std::string& file, YamlNode& root, Diagnostics& mistakes) {
  if (const std::optional<Place> foreign = first_foreign_byte(text, file)) {
    mistakes.add(*foreign, "", "not a text file: expected UTF-8 without control characters");
    return false;
  }
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    TreeBuilder builder(file, mistakes);
    if (!parser.HandleNextDocument(builder)) {
      mistakes.add({file, 0, 0}, "", "the file is empty");
      return false;
    }
    root = std::move(builder.root());
    Diagnostics ignored;
    TreeBuilder rest(file, ignored);
    if (!parser.HandleNextDocument(rest)) return true;
    mistakes.add(
        {{file, rest.root().line, rest.root().column}, "", "a second document; expected one a file"});
  } catch (const Refusal& refusal) {
    mistakes.add(place_of(file, refusal.mark), "", refusal.message);
  } catch (const YAML::Exception& error) {
    mistakes.add(place_of(file, error.mark), "", "not valid YAML: " + error.msg);
  }
  return false;
}

}  // namespace pinjaw::base

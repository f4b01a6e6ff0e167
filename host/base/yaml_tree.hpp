#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/base/diagnostics.hpp"

namespace pinjaw::base {

struct YamlEntry;

/// One value of a parsed file, with its place. What the library of the parser says of it, and no more.
struct YamlNode {
  enum class Kind { Nothing, Plain, Quoted, List, Map };
  Kind kind = Kind::Nothing;
  int line = 0;
  int column = 0;
  std::string text;                ///< of Plain and Quoted
  std::vector<YamlNode> items;     ///< of List
  std::vector<YamlEntry> entries;  ///< of Map, in the order of the file, each key once
};

struct YamlEntry {
  std::string key;
  int line = 0;
  int column = 0;
  YamlNode value;
};

/// Parses `text`, called `file` in diagnostics, into a tree within YamlFile's limits. Returns false, and says
/// why in `mistakes`, where there is no tree; keys given twice are mistakes too, but leave a tree.
bool parse_yaml(std::string_view text, const std::string& file, YamlNode& root, Diagnostics& mistakes);

}  // namespace pinjaw::base

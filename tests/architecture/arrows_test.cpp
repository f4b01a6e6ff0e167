// Keeps the arrows of docs/architecture.md: who may include whom, and what portable code may use.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/places.hpp"

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = pinjaw::test::source_dir();

struct Rule {
  std::set<std::string> may_include;
  bool portable = false;
};

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> result;
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

/// The page's list, one `folder[, folder] : allowed folders [| portable]` a line between the two fences.
std::map<std::string, Rule> arrows() {
  std::ifstream page(kRoot / "docs/architecture.md");
  std::map<std::string, Rule> rules;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      inside = line == "```arrows";
      continue;
    }
    const auto colon = line.find(" :");
    if (!inside || colon == std::string::npos) continue;
    Rule rule;
    std::string allowed = line.substr(colon + 2);
    if (const auto bar = allowed.find('|'); bar != std::string::npos) {
      rule.portable = allowed.find("portable", bar) != std::string::npos;
      allowed.resize(bar);
    }
    for (const std::string& word : words(allowed)) rule.may_include.insert(word);
    std::string folders = line.substr(0, colon);
    std::ranges::replace(folders, ',', ' ');
    for (const std::string& folder : words(folders)) rules[folder] = rule;
  }
  return rules;
}

struct Include {
  std::string file;
  std::string folder;
  std::string what;
  bool system = false;
};

/// Longest folder of the list that holds `path`; empty where none does.
std::string folder_of(const std::string& path, const std::map<std::string, Rule>& rules) {
  std::string best;
  for (const auto& [folder, rule] : rules) {
    if (path.starts_with(folder + "/") && folder.size() > best.size()) best = folder;
  }
  return best;
}

std::vector<fs::path> source_files() {
  std::vector<fs::path> files;
  for (const char* top : {"protocol", "firmware_sim", "host"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top)) {
      const std::string ending = entry.path().extension().string();
      if (ending == ".cpp" || ending == ".hpp" || ending == ".h") files.push_back(entry.path());
    }
  }
  return files;
}

std::vector<Include> includes(const std::map<std::string, Rule>& rules) {
  static const std::regex kPattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> found;
  for (const fs::path& path : source_files()) {
    const std::string name = fs::relative(path, kRoot).string();
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, kPattern)) continue;
      found.push_back({name, folder_of(name, rules), match[2], match[1] == "<"});
    }
  }
  return found;
}

bool is_allowed(const std::set<std::string>& may_include, const std::string& target) {
  if (may_include.contains(target)) return true;
  return std::ranges::any_of(may_include, [&](const std::string& pattern) {
    return pattern.ends_with("/*") && target.starts_with(pattern.substr(0, pattern.size() - 1));
  });
}

TEST(Architecture, the_page_lists_every_folder_that_holds_code) {
  const auto rules = arrows();
  ASSERT_GT(rules.size(), 15U);
  for (const fs::path& path : source_files()) {
    const std::string name = fs::relative(path, kRoot).string();
    EXPECT_NE(folder_of(name, rules), "") << name << " lies in no folder of the list";
  }
}

TEST(Architecture, every_include_follows_an_arrow) {
  const auto rules = arrows();
  int checked = 0;
  for (const Include& include : includes(rules)) {
    if (include.system) continue;
    const std::string target = folder_of(include.what, rules);
    ASSERT_NE(target, "") << include.file << " includes " << include.what
                          << ", which is not named from the root";
    ++checked;
    if (target == include.folder) continue;
    EXPECT_TRUE(is_allowed(rules.at(include.folder).may_include, target))
        << include.file << ": " << include.folder << " must not know " << target;
  }
  EXPECT_GT(checked, 100);
}

TEST(Architecture, portable_code_uses_only_the_listed_standard_headers) {
  static const std::set<std::string> kAllowed = {"array",    "bit",  "cstddef",     "cstdint", "limits",
                                                 "optional", "span", "type_traits", "utility", "algorithm"};
  const auto rules = arrows();
  int checked = 0;
  for (const Include& include : includes(rules)) {
    if (!rules.at(include.folder).portable || !include.system) continue;
    ++checked;
    EXPECT_TRUE(kAllowed.contains(include.what)) << include.file << " includes <" << include.what << ">";
  }
  EXPECT_GT(checked, 5);
}

TEST(Architecture, portable_code_has_no_heap_virtual_floating_point_or_static_mutable_data) {
  static const std::regex kForbidden(
      R"(\b(new|delete|malloc|free|virtual|double|float|throw|try|dynamic_cast|typeid|thread_local)\b|^\s*static (?!constexpr|_?assert|inline constexpr))");
  const auto rules = arrows();
  for (const fs::path& path : source_files()) {
    const std::string name = fs::relative(path, kRoot).string();
    if (!rules.at(folder_of(name, rules)).portable) continue;
    std::ifstream stream(path);
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
      ++number;
      line = std::regex_replace(line, std::regex(R"(//.*$|"([^"\\]|\\.)*")"), "");
      EXPECT_FALSE(std::regex_search(line, kForbidden)) << name << ":" << number << ": " << line;
    }
  }
}

TEST(Architecture, third_party_types_stay_in_the_folder_named_for_them) {
  const std::vector<std::pair<std::string, std::set<std::string>>> homes = {
      {"linux/can", {"protocol/socketcan"}},
      {"yaml-cpp", {"host/base"}},
      {"ccd/", {"host/geometry"}},
      {"nlopt", {"host/planner/force", "host/planner/robust"}},
      {"STEPControl", {"host/part"}},
      {"cairo", {"host/report"}},
      {"CLI/", {"host/app", "firmware_sim/app"}}};
  const auto rules = arrows();
  for (const Include& include : includes(rules)) {
    if (!include.system) continue;
    for (const auto& [prefix, folders] : homes) {
      if (!include.what.starts_with(prefix)) continue;
      EXPECT_TRUE(folders.contains(include.folder)) << include.file << " includes <" << include.what << ">";
      EXPECT_TRUE(prefix == "CLI/" || include.file.ends_with(".cpp"))
          << include.file << ": <" << include.what << "> belongs in a .cpp file";
    }
  }
}

}  // namespace

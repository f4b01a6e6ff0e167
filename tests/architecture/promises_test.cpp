// Keeps docs/safety.md and the tests together: no promise without a test, no test for no promise.
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

using Sources = std::set<std::string>;
using ByPromise = std::map<std::string, Sources>;

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    found.push_back(it->str(1));
  return found;
}

/// `| id | promise | sources | figure |`, sources in back quotes under tests/.
ByPromise rows_of(const std::string& page) {
  ByPromise rows;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| ") || line.starts_with("| id ") || line.starts_with("| --- ")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(1));
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    const std::vector<std::string> id = matches(cells.at(0), "(\\S+)");
    const std::vector<std::string> named =
        cells.size() > 2 ? matches(cells[2], "`([^`]+)`") : std::vector<std::string>{};
    EXPECT_TRUE(rows.emplace(id.at(0), Sources(named.begin(), named.end())).second)
        << id[0] << " comes twice";
  }
  return rows;
}

bool is_source(const fs::path& path) {
  return path.extension() == ".cpp" || path.extension() == ".py" || path.extension() == ".pml" ||
         path.extension() == ".sh";
}

/// What a source says it proves: `Promises: R1, I2.` in a comment, which may run over several lines.
std::vector<std::string> promises_of(const std::string& source) {
  const std::regex line("Promises: ([^.]+)\\.");
  std::smatch match;
  if (!std::regex_search(source, match, line)) return {};
  return matches(match.str(1), "([A-Z][A-Za-z0-9-]*)");
}

/// Sources whose tests must all be for something.
bool must_promise(const std::string& path) {
  if (!path.ends_with("_test.cpp")) return false;
  return path.starts_with("protocol/wire/") || path.starts_with("firmware_sim/");
}

struct Tests {
  ByPromise by_promise;
  Sources without;
};

Tests read_tests() {
  const fs::path root = pinjaw::test::source_dir("tests");
  Tests tests;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file() || !is_source(entry.path())) continue;
    const std::string name = fs::relative(entry.path(), root).string();
    if (name.starts_with("architecture/")) continue;
    const std::vector<std::string> promises = promises_of(text_of(entry.path()));
    for (const std::string& promise : promises) tests.by_promise[promise].insert(name);
    if (promises.empty() && must_promise(name)) tests.without.insert(name);
  }
  return tests;
}

std::string cell(const Sources& sources) {
  std::string text;
  for (const std::string& source : sources) text += (text.empty() ? "`" : " `") + source + "`";
  return text;
}

TEST(Promises, each_is_proved_by_the_sources_that_its_row_names) {
  const ByPromise rows = rows_of(text_of(pinjaw::test::source_dir("docs/safety.md")));
  const Tests tests = read_tests();
  EXPECT_GT(rows.size(), 20U);
  for (const auto& [id, named] : rows) {
    const auto proved = tests.by_promise.find(id);
    if (proved == tests.by_promise.end()) {
      ADD_FAILURE() << "no test proves " << id;
    } else {
      EXPECT_EQ(named, proved->second)
          << "docs/safety.md: the row of " << id << " should name " << cell(proved->second);
    }
  }
}

TEST(Promises, no_source_proves_what_is_not_promised) {
  const ByPromise rows = rows_of(text_of(pinjaw::test::source_dir("docs/safety.md")));
  for (const auto& [id, sources] : read_tests().by_promise) {
    EXPECT_TRUE(rows.contains(id)) << cell(sources) << " proves " << id
                                   << ", which docs/safety.md does not promise";
  }
}

TEST(Promises, every_test_of_protocol_and_firmware_is_for_one) {
  const Tests tests = read_tests();
  EXPECT_TRUE(tests.without.empty()) << "no 'Promises: ID, ID.' in " << cell(tests.without);
}

}  // namespace

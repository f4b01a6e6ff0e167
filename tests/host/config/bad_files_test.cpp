#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "host/base/files.hpp"
#include "host/config/materials.hpp"
#include "host/config/read.hpp"
#include "tests/support/places.hpp"

/// Every FILE.yaml in tests/bad_files/KIND/ is read as that kind; what is told must be FILE.expected, word
/// for word, with places counted from tests/bad_files/. PINJAW_WRITE_EXPECTED=1 writes the files anew, to be
/// read by a person.
namespace pinjaw::config {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = test::source_dir("tests/bad_files");

using Reader = std::function<base::Diagnostics(const fs::path&)>;

template <class T>
Reader mistakes_of(Read<T> (*read)(const fs::path&)) {
  return [read](const fs::path& path) {
    const Read<T> value = read(path);
    return value ? base::Diagnostics() : value.error();
  };
}

const std::map<std::string, Reader>& readers() {
  static const std::map<std::string, Reader> table = {{"kit", mistakes_of(read_kit)},
                                                      {"profile", mistakes_of(read_profile)},
                                                      {"task", mistakes_of(read_task)},
                                                      {"cell", mistakes_of(read_cell)},
                                                      {"sequence", mistakes_of(read_sequence)},
                                                      {"controller", mistakes_of(read_controller)},
                                                      {"materials", mistakes_of(read_materials)}};
  return table;
}

/// The text with the checkout's own path left out.
std::string portable(std::string text) {
  for (const std::string& prefix : {kFolder.string() + "/", test::source_dir() + "/"}) {
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
      text.erase(at, prefix.size());
  }
  return text;
}

std::vector<fs::path> bad_files() {
  std::vector<fs::path> files;
  for (const auto& [kind, reader] : readers()) {
    for (const auto& entry : fs::directory_iterator(kFolder / kind)) {
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

class BadFile : public testing::TestWithParam<fs::path> {};

TEST_P(BadFile, tells_every_mistake_with_its_place) {
  const fs::path& path = GetParam();
  const base::Diagnostics mistakes = readers().at(path.parent_path().filename().string())(path);
  const std::string told = portable(base::render(mistakes, "nothing was read"));
  const fs::path expected = fs::path(path).replace_extension(".expected");
  if (std::getenv("PINJAW_WRITE_EXPECTED") != nullptr) {
    ASSERT_TRUE(base::write_file_whole(expected, told));
  }
  EXPECT_FALSE(mistakes.empty());
  EXPECT_EQ(told, base::read_file(expected).value_or("(no such file)"));
}

INSTANTIATE_TEST_SUITE_P(Files, BadFile, testing::ValuesIn(bad_files()), [](const auto& file) {
  return file.param.parent_path().filename().string() + "_" + file.param.stem().string();
});

TEST(BadFiles, a_folder_a_missing_and_an_endless_file_are_told_as_such) {
  const auto told = [](const fs::path& path) {
    const auto kit = read_kit(path);
    return kit ? std::string() : base::render(kit.error(), "nothing was planned");
  };
  EXPECT_EQ(told("/"), "/: error: is a folder, not a file\n1 mistake; nothing was planned\n");
  EXPECT_EQ(
      told("no/such.yaml"),
      "no/such.yaml: error: cannot be read: No such file or directory\n1 mistake; nothing was planned\n");
  EXPECT_EQ(told("/dev/zero"), "/dev/zero: error: is not a regular file\n1 mistake; nothing was planned\n");
}

}  // namespace
}  // namespace pinjaw::config

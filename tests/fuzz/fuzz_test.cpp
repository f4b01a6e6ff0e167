#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "host/base/random.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/places.hpp"

/// Every target answers every file of its corpus (tests/fuzz/corpus/TARGET/, where the reproducers of past
/// bugs are kept) and of its seeds, and some thousand damaged forms of them. A crash leaves its input in the
/// folder that the last line names. `./dev fuzz` looks further, with libFuzzer.
namespace pinjaw::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = test::source_dir();

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

std::vector<std::string> inputs_of(const Target& target) {
  std::vector<fs::path> files;
  std::vector<std::string> places = target.seeds;
  places.push_back("tests/fuzz/corpus/" + target.name);
  for (const std::string& place : places) {
    if (fs::is_directory(kSource / place)) {
      for (const auto& entry : fs::directory_iterator(kSource / place)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
      }
    } else {
      files.push_back(kSource / place);
    }
  }
  std::ranges::sort(files);
  std::vector<std::string> inputs;
  for (const fs::path& file : files) inputs.push_back(content_of(file));
  return inputs;
}

/// The words of a libFuzzer dictionary: one "quoted" a line, the escapes \\, \" and \xAB.
std::vector<std::string> words_of(const Target& target) {
  std::ifstream file(kSource / "tests/fuzz" / target.dictionary);
  std::vector<std::string> words;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with('"')) continue;
    std::string word;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      if (line[i] != '\\') {
        word += line[i];
      } else if (line[i + 1] == 'x') {
        word += static_cast<char>(std::stoi(line.substr(i + 2, 2), nullptr, 16));
        i += 3;
      } else {
        word += line[++i];
      }
    }
    words.push_back(word);
  }
  return words;
}

/// Damages bytes as accidents and mischief do: changed, lost, repeated and foreign pieces.
class Damage {
 public:
  Damage(std::uint64_t seed, std::vector<std::string> words) : random_(seed), words_(std::move(words)) {}

  std::string done_to(std::string bytes, const std::string& other) {
    for (std::size_t hits = 1 + below(4); hits > 0; --hits) hit(bytes, other);
    return bytes;
  }

 private:
  std::size_t below(std::size_t count) { return count == 0 ? 0 : random_.bits() % count; }

  void hit(std::string& bytes, const std::string& other) {
    const std::size_t at = below(bytes.size() + 1);
    const std::size_t length = std::min(below(40), bytes.size() - at);
    switch (below(6)) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(random_.bits());
        return;
      case 1:
        bytes.erase(at, length);
        return;
      case 2:
        bytes.insert(below(bytes.size() + 1), bytes.substr(at, length));
        return;
      case 3:
        bytes.replace(at, length, words_[below(words_.size())]);
        return;
      case 4:
        bytes.insert(at, words_[below(words_.size())]);
        return;
      default: {
        const std::size_t from = below(other.size() + 1);
        bytes.replace(at, length, other.substr(from, below(200)));
      }
    }
  }

  base::Random random_;
  std::vector<std::string> words_;
};

class Reader : public testing::TestWithParam<Target> {};

TEST_P(Reader, answers_every_file_of_its_corpus) {
  const auto inputs = inputs_of(GetParam());
  EXPECT_FALSE(inputs.empty());
  for (const std::string& input : inputs) GetParam().answer(input);
}

TEST_P(Reader, answers_damaged_files) {
  // chosen: a second of CPU for each target; a STEP file is read in a process of its own
  const int rounds = GetParam().name == "step"       ? 40
                     : GetParam().name == "stl"      ? 200
                     : GetParam().name == "sequence" ? 300
                                                     : 1500;
  const auto inputs = inputs_of(GetParam());
  const auto words = words_of(GetParam());
  ASSERT_FALSE(words.empty());
  constexpr std::uint64_t kSeed = 14;
  Damage damage(kSeed, words);
  base::Random random(kSeed);
  for (int round = 0; round < rounds; ++round) {
    const std::string& input = inputs[random.bits() % inputs.size()];
    const std::string& other = inputs[random.bits() % inputs.size()];
    GetParam().answer(damage.done_to(input, other));
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, Reader, testing::ValuesIn(targets()), [](const auto& target) {
  std::string name = target.param.name;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace pinjaw::fuzz

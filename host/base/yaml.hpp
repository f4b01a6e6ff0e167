#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/diagnostics.hpp"
#include "host/base/rules.hpp"

/// A strict reader of YAML (of which JSON is a part). Every value knows its place and key path; each mistake
/// goes into the file's diagnostics, and reading goes on, so that all of a file's mistakes are told at once.
namespace pinjaw::base {

struct YamlNode;  // the tree, yaml.cpp's own
class YamlMap;

/// How many entries a list must have.
struct CountRule {
  std::size_t at_least = 0;
  std::size_t at_most = 100000;
};

/// A value of a file, or of a missing setting. Cheap to copy; lives as long as its YamlFile.
///
/// Getters of a wrong or missing value record the mistake (once) and return nothing.
class YamlValue {
 public:
  YamlValue(const YamlNode* node, std::string path, Diagnostics* mistakes, const std::string* file);

  [[nodiscard]] bool is_map() const;
  [[nodiscard]] bool is_list() const;
  /// A plain or quoted scalar, numbers included.
  [[nodiscard]] bool is_scalar() const;

  /// A finite number that the rule allows; never a quoted one.
  [[nodiscard]] std::optional<double> number(const NumberRule& rule) const;
  [[nodiscard]] std::optional<std::int64_t> whole(const WholeRule& rule) const;
  /// A scalar that is not empty, as written. `what` names it in messages.
  [[nodiscard]] std::optional<std::string> text(std::string_view what) const;
  /// `true` or `false`.
  [[nodiscard]] std::optional<bool> truth() const;
  /// Position in `words` of the one that is written.
  [[nodiscard]] std::optional<std::size_t> one_of(const std::vector<std::string>& words) const;
  /// The entries; nothing where it is not a list or has a wrong count.
  [[nodiscard]] std::optional<std::vector<YamlValue>> list(std::string_view what,
                                                           const CountRule& rule = {}) const;
  /// `count` numbers; nothing where one of them is wrong.
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::size_t count, const NumberRule& rule,
                                                           std::string_view what) const;
  /// The settings; an empty map (whose `present()` is false) where it is none.
  [[nodiscard]] YamlMap map(std::string_view what) const;
  /// The scalar as written, whatever its form; empty for maps and lists. Records nothing.
  [[nodiscard]] std::string raw() const;

  /// Records a mistake at this value.
  void mistake(std::string message) const;
  [[nodiscard]] Place place() const;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  friend class YamlMap;
  void expected(std::string_view what) const;

  const YamlNode* node_;
  std::string path_;
  Diagnostics* mistakes_;
  const std::string* file_;
};

/// The settings of one mapping. Settings asked for are known; `finish` reports all others.
class YamlMap {
 public:
  YamlMap(const YamlNode* node, std::string path, Diagnostics* mistakes, const std::string* file);

  /// False where the value was no mapping (which has been reported): nothing in it is then missing.
  [[nodiscard]] bool present() const { return node_ != nullptr; }
  [[nodiscard]] bool has(std::string_view key) const;

  /// The setting, or nothing where it is not given.
  [[nodiscard]] std::optional<YamlValue> find(std::string_view key);
  /// The setting; a missing one is reported.
  [[nodiscard]] std::optional<YamlValue> require(std::string_view key);

  /// A number; where it is missing or wrong (which is reported) NaN, which compares false with everything, so
  /// that rules between settings stay silent about it.
  [[nodiscard]] double number(std::string_view key, const NumberRule& rule);
  [[nodiscard]] double number_or(std::string_view key, const NumberRule& rule, double otherwise);
  /// A whole number; 0 where it is missing or wrong (which is reported).
  [[nodiscard]] int whole(std::string_view key, const WholeRule& rule);
  [[nodiscard]] std::string text(std::string_view key, std::string_view what);

  /// The keys in the order of the file.
  [[nodiscard]] std::vector<std::string> keys() const;
  /// Records a mistake at the value of `key`, or at the mapping where that is not given.
  void mistake_at(std::string_view key, std::string message) const;
  /// Records a mistake at the word `key` itself.
  void mistake_at_key(std::string_view key, std::string message) const;
  /// Records a mistake at the mapping itself.
  void mistake(std::string message) const;

  /// Reports every key never asked for, with the known one that was probably meant.
  void finish() const;

 private:
  [[nodiscard]] std::string path_of(std::string_view key) const;

  const YamlNode* node_;
  std::string path_;
  Diagnostics* mistakes_;
  const std::string* file_;
  std::vector<std::string> known_;
};

/// One parsed file. Hostile files end in diagnostics: nesting, size and counts of values and keys are
/// limited; anchors, aliases, tags and several documents are refused; a key given twice is reported.
class YamlFile {
 public:
  static constexpr std::size_t kMaxBytes = 4U << 20U;  ///< chosen: a hundred times the longest file of ours
  static constexpr int kMaxDepth = 32;                 ///< chosen: ours nest to 7
  static constexpr std::size_t kMaxValues = 200000;    ///< chosen: bounds memory to some 50 MB
  static constexpr std::size_t kMaxKeys = 4000;        ///< of one mapping; chosen: ours have up to 20

  /// Reads and parses the file. What cannot be parsed leaves a file without a root and with diagnostics.
  explicit YamlFile(const std::filesystem::path& path);
  /// Parses `text`, called `name` in diagnostics.
  YamlFile(std::string_view text, std::string name);
  ~YamlFile();
  YamlFile(YamlFile&&) noexcept;
  YamlFile& operator=(YamlFile&&) noexcept;
  YamlFile(const YamlFile&) = delete;
  YamlFile& operator=(const YamlFile&) = delete;

  /// The top mapping; absent (`present()` false) where parsing failed or the top is something else.
  [[nodiscard]] YamlMap top();
  /// An absent mapping: whatever is asked of it is neither there nor missing.
  [[nodiscard]] YamlMap no_map();
  [[nodiscard]] const std::string& bytes() const;
  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] Diagnostics& mistakes();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace pinjaw::base

#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/diagnostics.hpp"
#include "host/base/rules.hpp"

/// Reads JSON that a program wrote, field by field: a wrong or missing field is a mistake with the field's
/// path.
namespace pinjaw::base {

/// A value of a JSON document, with its path. Getters of a wrong or missing value record the mistake, once,
/// and return a neutral value, so that a reader runs to the end and tells all mistakes.
class JsonField {
 public:
  JsonField(const nlohmann::json* value, std::string path, const std::string* file, Diagnostics* mistakes)
      : value_(value), path_(std::move(path)), file_(file), mistakes_(mistakes) {}

  [[nodiscard]] bool has(std::string_view key) const;
  [[nodiscard]] JsonField at(std::string_view key) const;
  [[nodiscard]] double number(const NumberRule& rule = {"a number"}) const;
  [[nodiscard]] std::int64_t whole(const WholeRule& rule = {"a whole number"}) const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool truth() const;
  [[nodiscard]] std::vector<JsonField> list() const;
  /// Of an object, in their order in the document's value.
  [[nodiscard]] std::vector<std::string> keys() const;
  /// Exactly `count` numbers.
  [[nodiscard]] std::vector<double> numbers(std::size_t count, const NumberRule& rule = {"a number"}) const;
  /// Position in `words` of the one that is written; 0 with a mistake where it is none of them.
  [[nodiscard]] std::size_t one_of(const std::vector<std::string>& words) const;

  [[nodiscard]] double number(std::string_view key) const { return at(key).number(); }
  [[nodiscard]] std::int64_t whole(std::string_view key) const { return at(key).whole(); }
  [[nodiscard]] std::string text(std::string_view key) const { return at(key).text(); }

  void mistake(std::string message) const;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void expected(std::string_view what) const;

  const nlohmann::json* value_;  ///< nothing where the field is missing, which has been reported
  std::string path_;
  const std::string* file_;
  Diagnostics* mistakes_;
};

/// Values of a JSON document hold each other to this depth at most; chosen: ours nest to 7.
inline constexpr int kMaxJsonDepth = 64;

/// Parses `text`, called `file` in diagnostics; a syntax error tells line and column, and so does a value
/// that lies deeper than kMaxJsonDepth.
Checked<nlohmann::json> parse_json(std::string_view text, const std::string& file);

}  // namespace pinjaw::base

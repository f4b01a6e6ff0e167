#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace pinjaw::base {

/// Where in a file somebody wrote something. Lines and columns count from 1; 0 means the file as a whole.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
  friend bool operator==(const Place&, const Place&) = default;
};

/// One mistake of an operator: where, in which setting, and what was expected.
struct Diagnostic {
  Place place;
  std::string key;  ///< path from the file's top, e.g. `pins[3].radius_mm`; empty for the file as a whole
  std::string message;
  friend bool operator==(const Diagnostic&, const Diagnostic&) = default;
};

/// All the mistakes found, in the order found, each once.
class Diagnostics {
 public:
  static constexpr std::size_t kMost = 1000;  ///< chosen: nobody reads more; bounds hostile files

  Diagnostics() = default;
  explicit Diagnostics(Diagnostic only) { add(std::move(only)); }

  void add(Diagnostic diagnostic);
  void add(Place place, std::string key, std::string message);
  void add(const Diagnostics& others);

  [[nodiscard]] bool empty() const { return items_.empty(); }
  /// How many were found, those beyond kMost, which are only counted, among them.
  [[nodiscard]] std::size_t size() const { return items_.size() + only_counted_; }
  [[nodiscard]] auto begin() const { return items_.begin(); }
  [[nodiscard]] auto end() const { return items_.end(); }

 private:
  std::vector<Diagnostic> items_;
  std::size_t only_counted_ = 0;
};

/// A value read from files, or every mistake that kept it from being read.
template <class T>
using Checked = tl::expected<T, Diagnostics>;

/// `file:line:column: error: key: message`, without what is empty.
std::string to_string(const Diagnostic& diagnostic);

/// One line a mistake, sorted by place within each file, then `N mistakes; CONSEQUENCE`, e.g. "nothing was
/// planned".
std::string render(const Diagnostics& diagnostics, std::string_view consequence);

/// The word of `known` that `word` was probably meant to be; empty where none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// `; did you mean WORD?`, or nothing where none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace pinjaw::base

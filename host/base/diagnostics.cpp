#include "host/base/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace pinjaw::base {
namespace {

/// Insertions, deletions, changes and swaps of neighbours that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> before(width), last(width), now(width);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({change, last[j] + 1, now[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last[b.size()];
}

std::string_view without_unit(std::string_view word) {
  return word.substr(0, word.rfind('_'));
}

/// True for `radius` or `radius_in` where `radius_mm` is known, and for `degrees` where `deg` is: the unit is
/// missing, another, or written out.
bool differs_in_unit(std::string_view word, std::string_view known) {
  if (known.size() >= 3 && word.starts_with(known)) return true;
  if (known.find('_') == std::string_view::npos) return false;
  return word == without_unit(known) || without_unit(word) == without_unit(known);
}

}  // namespace

void Diagnostics::add(Diagnostic diagnostic) {
  if (std::find(items_.begin(), items_.end(), diagnostic) != items_.end()) return;
  if (items_.size() < kMost) {
    items_.push_back(std::move(diagnostic));
  } else {
    ++only_counted_;
  }
}

void Diagnostics::add(Place place, std::string key, std::string message) {
  Diagnostic diagnostic;
  diagnostic.place = std::move(place);
  diagnostic.key = std::move(key);
  diagnostic.message = std::move(message);
  add(std::move(diagnostic));
}

void Diagnostics::add(const Diagnostics& others) {
  for (const Diagnostic& other : others) add(other);
  only_counted_ += others.only_counted_;
}

std::string to_string(const Diagnostic& diagnostic) {
  const Place& place = diagnostic.place;
  const std::string where = place.line > 0 ? fmt::format("{}:{}:{}: ", place.file, place.line, place.column)
                            : place.file.empty() ? std::string()
                                                 : place.file + ": ";
  const std::string key = diagnostic.key.empty() ? diagnostic.key : diagnostic.key + ": ";
  return fmt::format("{}error: {}{}", where, key, diagnostic.message);
}

std::string render(const Diagnostics& diagnostics, std::string_view consequence) {
  std::vector<std::string> files;
  const auto rank_of = [&files](const std::string& file) {
    const auto found = std::find(files.begin(), files.end(), file);
    return found - files.begin();
  };
  std::vector<Diagnostic> sorted(diagnostics.begin(), diagnostics.end());
  for (const Diagnostic& each : sorted) {
    if (std::find(files.begin(), files.end(), each.place.file) == files.end())
      files.push_back(each.place.file);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Diagnostic& a, const Diagnostic& b) {
    return std::make_tuple(rank_of(a.place.file), a.place.line, a.place.column) <
           std::make_tuple(rank_of(b.place.file), b.place.line, b.place.column);
  });
  std::string text;
  for (const Diagnostic& each : sorted) text += to_string(each) + "\n";
  const std::size_t unshown = diagnostics.size() - sorted.size();
  if (unshown > 0) text += fmt::format("and {} more\n", unshown);
  const std::string_view noun = diagnostics.size() == 1 ? "mistake" : "mistakes";
  return text + fmt::format("{} {}; {}\n", diagnostics.size(), noun, consequence);
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t kLongest = 64;  // chosen: longer words are no misspellings of ours
  if (word.empty() || word.size() > kLongest) return {};
  std::string nearest;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    if (candidate == word) continue;
    const std::size_t distance = differs_in_unit(word, candidate) ? 1 : edit_distance(word, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? nearest : fmt::format("; did you mean {}?", nearest);
}

}  // namespace pinjaw::base

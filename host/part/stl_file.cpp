#include "host/part/stl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

namespace pinjaw::part {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 of any content, 4 of count
constexpr std::size_t kFacetBytes = 50;   // normal, three corners, 2 of attribute
constexpr std::size_t kNormalBytes = 12;

bool same_word(std::string_view a, std::string_view lower) {
  return std::ranges::equal(a, lower, [](char x, char y) {
    return ('A' <= x && x <= 'Z' ? static_cast<char>(x - 'A' + 'a') : x) == y;
  });
}

/// Little-endian, whatever machine reads it.
std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return word;
}

float number_at(std::string_view bytes, std::size_t at) {
  return std::bit_cast<float>(word_at(bytes, at));
}

/// Why a coordinate is none; empty where it is one.
std::string flaw_of(double coordinate_mm) {
  if (!std::isfinite(coordinate_mm)) return "expected a number, found " + fmt::format("{}", coordinate_mm);
  if (std::abs(coordinate_mm) > kFarthestMm) {
    return fmt::format("expected a length up to {} mm, found {}", kFarthestMm, coordinate_mm);
  }
  return {};
}

std::string too_many(const std::string& file, int most_facets) {
  return fmt::format("{}: the STL file holds more than {} facets; export it coarser", file, most_facets);
}

base::Expected<std::vector<StlSolid>> read_binary(std::string_view bytes, const std::string& file,
                                                  int most_facets) {
  const std::size_t count = word_at(bytes, kHeaderBytes - 4);
  const std::size_t expected = kHeaderBytes + count * kFacetBytes;
  if (bytes.size() < expected) {
    return base::failure(
        fmt::format("{}: the STL file is cut short: its header states {} facets, which take {} bytes; "
                    "found {}",
                    file, count, expected, bytes.size()));
  }
  if (bytes.size() > expected) {
    return base::failure(
        fmt::format("{}: the STL file's header states {} facets, which take {} bytes; found {}", file, count,
                    expected, bytes.size()));
  }
  if (count == 0) return base::failure(file + ": the STL file holds no facet");
  if (count > static_cast<std::size_t>(most_facets)) return base::failure(too_many(file, most_facets));
  StlSolid solid;
  solid.facets.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    StlFacet facet;
    std::size_t at = kHeaderBytes + i * kFacetBytes + kNormalBytes;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis, at += 4) {
        const double value_mm = number_at(bytes, at);
        if (const std::string flaw = flaw_of(value_mm); !flaw.empty()) {
          return base::failure(
              fmt::format("{}: facet {}, corner {}, {}: {}", file, i + 1, corner + 1, "xyz"[axis], flaw));
        }
        facet.corners_mm[corner][axis] = value_mm;
      }
    }
    solid.facets.push_back(facet);
  }
  return std::vector{std::move(solid)};
}

/// Words of a text with their places, and the first mistake made with them.
class Words {
 public:
  Words(std::string_view text, const std::string& file) : text_(text), file_(file) { next(); }

  [[nodiscard]] std::string_view word() const { return word_; }  ///< empty at the end of the text
  [[nodiscard]] const std::string& mistake() const { return mistake_; }

  void next() {
    while (at_ < text_.size() && is_space(text_[at_])) step();
    line_ = here_line_;
    column_ = here_column_;
    const std::size_t from = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) step();
    word_ = text_.substr(from, at_ - from);
  }

  /// The rest of the line after the current word, without its outer spaces; goes on to the next line's word.
  std::string rest_of_line() {
    const std::size_t from = std::min(at_, text_.size());
    const std::size_t end = std::min(text_.find_first_of("\r\n", from), text_.size());
    std::string_view rest = text_.substr(from, end - from);
    while (!rest.empty() && is_space(rest.front())) rest.remove_prefix(1);
    while (!rest.empty() && is_space(rest.back())) rest.remove_suffix(1);
    while (at_ < end) step();
    next();
    return std::string(rest);
  }

  [[nodiscard]] bool is(std::string_view lower) const { return same_word(word_, lower); }

  /// Passes over `lower`, or tells that it was expected.
  bool take(std::string_view lower) {
    if (!is(lower)) return expected(lower);
    next();
    return true;
  }

  /// Passes over a number; any float's text will do where `any`.
  std::optional<double> number(bool any) {
    std::string_view digits = word_;
    if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool whole = end == digits.data() + digits.size() && !digits.empty();
    if (!whole || (error != std::errc{} && !any)) {
      expected("a number");
      return std::nullopt;
    }
    if (const std::string flaw = any ? std::string() : flaw_of(value); !flaw.empty()) {
      tell(flaw);
      return std::nullopt;
    }
    next();
    return value;
  }

  bool expected(std::string_view what) {
    constexpr std::size_t kMostShown = 40;
    if (word_.empty()) return tell(fmt::format("the STL file is cut short: expected {}", what));
    return tell(fmt::format("expected {}, found \"{}\"", what, shown(word_.substr(0, kMostShown))));
  }

  bool tell(const std::string& what) {
    if (mistake_.empty()) mistake_ = fmt::format("{}:{}:{}: {}", file_, line_, column_, what);
    return false;
  }

 private:
  static bool is_space(char c) { return c == ' ' || ('\t' <= c && c <= '\r'); }

  /// Bytes that are no printable ASCII as `?`, so that a message is a line of text.
  static std::string shown(std::string_view word) {
    std::string text(word);
    std::ranges::replace_if(
        text, [](char c) { return c < '!' || c > '~'; }, '?');
    return text;
  }

  void step() {
    if (text_[at_++] == '\n') {
      ++here_line_;
      here_column_ = 1;
    } else {
      ++here_column_;
    }
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int here_line_ = 1;
  int here_column_ = 1;
  int line_ = 1;
  int column_ = 1;
  std::string_view word_;
  std::string mistake_;
};

/// `facet normal x y z  outer loop  vertex x y z  vertex x y z  vertex x y z  endloop  endfacet`
std::optional<StlFacet> facet_from(Words& words) {
  if (!words.take("facet") || !words.take("normal")) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    if (!words.number(true)) return std::nullopt;  // exporters write nan for facets without area
  }
  if (!words.take("outer") || !words.take("loop")) return std::nullopt;
  StlFacet facet;
  for (Vector3d& corner_mm : facet.corners_mm) {
    if (!words.take("vertex")) return std::nullopt;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value_mm = words.number(false);
      if (!value_mm) return std::nullopt;
      corner_mm[axis] = *value_mm;
    }
  }
  if (!words.take("endloop") || !words.take("endfacet")) return std::nullopt;
  return facet;
}

base::Expected<std::vector<StlSolid>> read_ascii(std::string_view text, const std::string& file,
                                                 int most_facets) {
  Words words(text, file);
  std::vector<StlSolid> solids;
  std::size_t count = 0;
  while (!words.word().empty()) {
    if (!words.is("solid")) {
      words.expected("solid");
      return base::failure(words.mistake());
    }
    StlSolid solid{.name = words.rest_of_line(), .facets = {}};
    while (words.is("facet")) {
      if (++count > static_cast<std::size_t>(most_facets)) return base::failure(too_many(file, most_facets));
      const auto facet = facet_from(words);
      if (!facet) return base::failure(words.mistake());
      solid.facets.push_back(*facet);
    }
    if (!words.is("endsolid")) {
      words.expected("facet or endsolid");
      return base::failure(words.mistake());
    }
    words.rest_of_line();
    if (!solid.facets.empty()) solids.push_back(std::move(solid));
  }
  if (solids.empty()) return base::failure(file + ": the STL file holds no facet");
  return solids;
}

bool begins_with_solid(std::string_view bytes) {
  const auto first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && same_word(bytes.substr(first, 5), "solid");
}

/// No binary file of a size that can be read is without a zero in its count.
bool is_text(std::string_view bytes) {
  return bytes.substr(0, kHeaderBytes).find('\0') == std::string_view::npos;
}

}  // namespace

base::Expected<std::vector<StlSolid>> read_stl(std::string_view bytes, const std::string& file,
                                               int most_facets) {
  if (bytes.empty()) return base::failure(file + ": the file is empty");
  const bool counts_agree =
      bytes.size() >= kHeaderBytes &&
      bytes.size() == kHeaderBytes + kFacetBytes * static_cast<std::size_t>(word_at(bytes, kHeaderBytes - 4));
  if (!counts_agree && is_text(bytes) && begins_with_solid(bytes))
    return read_ascii(bytes, file, most_facets);
  if (bytes.size() < kHeaderBytes || is_text(bytes)) {
    return base::failure(
        fmt::format("{}: not an STL file: it neither begins with solid nor has the {} bytes of a "
                    "binary header",
                    file, kHeaderBytes));
  }
  return read_binary(bytes, file, most_facets);
}

}  // namespace pinjaw::part

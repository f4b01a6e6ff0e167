#include "tests/support/figures.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/support/nightly.hpp"

namespace pinjaw::test {
namespace {

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result + '"';
}

/// 12345678 as 12,345,678.
std::string grouped(std::int64_t value) {
  std::string digits = std::to_string(value);
  const std::size_t first = value < 0 ? 1 : 0;
  for (std::size_t i = digits.size(); i > first + 3;) {
    i -= 3;
    digits.insert(i, ",");
  }
  return digits;
}

}  // namespace

void figure(std::string_view promise, std::string_view what, std::string_view value, std::string_view unit) {
  const std::string line = "{\"promise\": " + quoted(promise) + ", \"what\": " + quoted(what) +
                           ", \"value\": " + quoted(value) + ", \"unit\": " + quoted(unit) +
                           (nightly() ? ", \"night\": true}\n" : "}\n");
  std::printf("figure %s", line.c_str());
  const char* path = std::getenv("PINJAW_FIGURES");
  if (path == nullptr || *path == '\0') return;
  std::ofstream(path, std::ios::app) << line;  // one write, so that programs side by side do not mix
}

void figure(std::string_view promise, std::string_view what, double value, std::string_view unit) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  figure(promise, what, std::string_view(text), unit);
}

void figure(std::string_view promise, std::string_view what, std::int64_t value, std::string_view unit) {
  figure(promise, what, std::string_view(grouped(value)), unit);
}

}  // namespace pinjaw::test

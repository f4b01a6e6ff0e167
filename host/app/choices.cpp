#include "host/app/choices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace pinjaw::app {

namespace {

template <class T>
std::optional<T> number_in(const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

CLI::Validator whole_in(WholeRange range) {
  return {[range](const std::string& text) {
            const auto value = number_in<std::int64_t>(text);
            if (value && *value >= range.lo && *value <= range.hi) return std::string();
            return fmt::format("expected a whole number from {} to {}, found {}", range.lo, range.hi, text);
          },
          ""};
}

CLI::Validator force_up_to(double most_n) {
  return {[most_n](const std::string& text) {
            const auto value = number_in<double>(text);
            if (value && *value >= 0 && *value <= most_n) return std::string();
            return fmt::format("expected newtons from 0 to {:g}, found {}", most_n, text);
          },
          ""};
}

CLI::Validator file_name() {
  return {[](const std::string& text) {
            return text.empty() ? "expected the name of a file, found nothing" : "";
          },
          ""};
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, "|"));
}

CLI::Validator word_of(std::vector<std::string> words) {
  return {[words = std::move(words)](const std::string& text) {
            if (std::ranges::find(words, text) != words.end()) return std::string();
            return fmt::format("expected {}{}, found {}{}", words.size() > 2 ? "one of " : "",
                               fmt::join(words, words.size() > 2 ? ", " : " or "), text,
                               base::did_you_mean(text, words));
          },
          ""};
}

std::string example(const std::string& lines) {
  return "Example:\n" + lines + "\n\nOptions of every command and the exit codes: pinjaw --help";
}

}  // namespace pinjaw::app

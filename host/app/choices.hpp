#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/base/diagnostics.hpp"

/// Options whose help and whose mistakes read as sentences.
namespace pinjaw::app {

/// A whole number of a range; a mistake says which.
struct WholeRange {
  std::int64_t lo = 0;
  std::int64_t hi = 0;
};
CLI::Validator whole_in(WholeRange range);

/// A force in newtons that a message can carry.
CLI::Validator force_up_to(double most_n);

/// A file's name; an empty one is what an unset variable of a script gives.
CLI::Validator file_name();

/// `words` as they stand in a help: "a|b|c".
std::string joined(const std::vector<std::string>& words);

/// One of `words`; a mistake lists them and names the nearest.
CLI::Validator word_of(std::vector<std::string> words);

/// An option that is one of a few words, each with its value.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& name, T& target,
                        std::vector<std::pair<std::string, T>> choices, const std::string& help) {
  std::vector<std::string> words;
  std::string standing;
  for (const auto& [word, value] : choices) {
    words.push_back(word);
    if (value == target) standing = word;
  }
  const auto take = [&target, choices = std::move(choices)](const std::string& given) {
    for (const auto& [word, value] : choices) {
      if (word == given) target = value;
    }
  };
  return command.add_option_function<std::string>(name, take, help)
      ->type_name(joined(words))
      ->check(word_of(words))
      ->default_str(standing);
}

/// What stands under a command's help: how it is used, where the other options are told.
std::string example(const std::string& lines);

}  // namespace pinjaw::app

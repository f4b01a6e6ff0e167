#include "host/app/usage.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "host/base/diagnostics.hpp"

namespace pinjaw::app {

namespace {

/// The commands that were given, outermost first.
std::vector<const CLI::App*> given(const CLI::App& app) {
  std::vector<const CLI::App*> chain = {&app};
  while (!chain.back()->get_subcommands().empty()) chain.push_back(chain.back()->get_subcommands().back());
  return chain;
}

std::string spoken(const std::vector<const CLI::App*>& chain) {
  std::string words;
  for (const CLI::App* app : chain) words += (words.empty() ? "" : " ") + app->get_name();
  return words;
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> options_of(const std::vector<const CLI::App*>& chain) {
  std::vector<std::string> names;
  for (const CLI::App* app : chain) {
    for (const CLI::Option* option : app->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  return names;
}

std::string sentence(const CLI::App& app, const CLI::Error& error) {
  const auto chain = given(app);
  const CLI::App& innermost = *chain.back();
  const std::vector<std::string> extra = app.remaining(true);
  const std::vector<std::string> commands = commands_of(innermost);
  if (!commands.empty() && !extra.empty() && !extra.front().starts_with('-')) {
    return fmt::format("there is no command {} {}{}", spoken(chain), extra.front(),
                       base::did_you_mean(extra.front(), commands));
  }
  const auto option =
      std::ranges::find_if(extra, [](const std::string& word) { return word.starts_with('-'); });
  if (option != extra.end()) {
    const std::string name = option->substr(0, option->find('='));
    return fmt::format("there is no option {}{}", name, base::did_you_mean(name, options_of(chain)));
  }
  if (!commands.empty() && error.get_name() == "RequiredError") {
    return fmt::format("which command? {} takes {}", spoken(chain), fmt::join(commands, ", "));
  }
  if (!extra.empty())
    return fmt::format("{} takes no further argument, found {}", spoken(chain), extra.front());
  if (error.get_name() == "ArgumentMismatch") {
    const std::string message = error.what();
    return fmt::format("{} needs a value", message.substr(0, message.find(':')));
  }
  return error.what();
}

}  // namespace

std::string usage_message(const CLI::App& app, const CLI::Error& error) {
  return fmt::format("pinjaw: {}\nRun '{} --help' for what it takes.\n", sentence(app, error),
                     spoken(given(app)));
}

}  // namespace pinjaw::app

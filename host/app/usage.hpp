#pragma once

#include <string>

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace pinjaw::app {

/// What is wrong with a command line, in one sentence, and where to read on.
std::string usage_message(const CLI::App& app, const CLI::Error& error);

}  // namespace pinjaw::app

#pragma once

#include "host/app/context.hpp"

/// One function a command: it declares the command's options and what happens when it is given.
namespace pinjaw::app {

void add_plan(CLI::App& app, Context& context);
void add_planar(CLI::App& app, Context& context);
void add_features(CLI::App& app, Context& context);
void add_why(CLI::App& app, Context& context);
void add_check(CLI::App& app, Context& context);
void add_cell(CLI::App& app, Context& context);
void add_sheet(CLI::App& app, Context& context);
void add_kit(CLI::App& app, Context& context);
void add_send(CLI::App& app, Context& context);
void add_jaw(CLI::App& app, Context& context);
void add_run(CLI::App& app, Context& context);
void add_dbc(CLI::App& app, Context& context);
void add_explain(CLI::App& app, Context& context);

/// Puts an example under the help of each.
void add_examples(CLI::App& app);

/// All of them, in the order of the help.
void add_commands(CLI::App& app, Context& context);

}  // namespace pinjaw::app

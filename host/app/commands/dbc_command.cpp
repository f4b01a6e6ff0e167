#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "protocol/describe/describe.hpp"

namespace pinjaw::app {

namespace {

struct DbcOptions {
  std::string output;
  std::vector<int> nodes;
};

void run_dbc(Context& context, const DbcOptions& options) {
  std::vector<std::uint8_t> nodes;
  for (const int node : options.nodes) nodes.push_back(static_cast<std::uint8_t>(node));
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  if (nodes.empty()) nodes = describe::all_nodes();
  context.write_result(options.output, context.json ? describe::to_json() : describe::to_dbc(nodes));
}

}  // namespace

void add_dbc(CLI::App& app, Context& context) {
  auto options = std::make_shared<DbcOptions>();
  CLI::App* command = app.add_subcommand("dbc", "the messages of the bus as a DBC file (JSON with --json)");
  command->add_option("-o,--output", options->output, "without it the DBC goes to stdout")->type_name("FILE");
  command->add_option("--nodes", options->nodes, "only these nodes, e.g. 1,2,3")
      ->type_name("N,...")
      ->delimiter(',')
      ->check(whole_in({1, 14}));
  command->callback([&context, options] { run_dbc(context, *options); });
}

}  // namespace pinjaw::app

// pinjaw: designs modular pin grippers and runs them. The command line.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "host/app/commands/commands.hpp"
#include "host/app/context.hpp"

namespace {

using pinjaw::app::Context;
using pinjaw::app::ExitCode;
using pinjaw::app::ProgressMode;

constexpr const char* kFooter = R"(Exit codes: 0 done; 1 the answer is no; 2 usage; 3 bad input file; 4 controller refused or fault;
5 bus or node unavailable, or timeout; 6 force would exceed a limit; 70 a bug; 130 interrupted.

Examples:
  pinjaw plan configs/tasks/valve-pedestal.yaml -o plan.json
  pinjaw why configs/tasks/valve-pedestal.yaml
  pinjaw sheet plan.json --design best -o sheet.svg
  pinjaw cell configs/cells/acc.yaml -o cell.json
  pinjaw run configs/sequences/acc-cleaning.yaml --report run.json --log run.log)";

void add_globals(CLI::App& app, Context& context) {
  app.add_option("--bus", context.bus, "sim: (in process, virtual time) or can:IFACE")
      ->envname("PINJAW_BUS")
      ->type_name("BUS")
      ->capture_default_str();
  app.add_option("--world", context.world, "Unix socket of a pinjaw-jaw's world")->type_name("PATH");
  app.add_flag("--json", context.json, "the result as JSON");
  app.add_flag("--quiet", context.quiet, "no remarks and no progress on stderr");
  app.add_option("--progress", context.progress, "auto, none or json")
      ->transform(CLI::CheckedTransformer(std::map<std::string, ProgressMode>{
          {"auto", ProgressMode::Auto}, {"none", ProgressMode::None}, {"json", ProgressMode::Json}}))
      ->default_str("auto");
  app.add_option("--seed", context.seed, "seed of everything random in a run")->capture_default_str();
}

/// A second interrupt must work too, so the handler only ends the process: every output file is written whole or not.
void end_on_interrupt(int /*signal*/) { std::_Exit(static_cast<int>(ExitCode::Interrupted)); }

ExitCode run(int argc, char** argv) {
  Context context;
  CLI::App app("pinjaw designs modular pin grippers and runs them", "pinjaw");
  app.set_version_flag("--version", PINJAW_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  app.footer(kFooter);
  add_globals(app, context);
  pinjaw::app::add_commands(app, context);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? ExitCode::Done : ExitCode::Usage;
  }
  return context.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, end_on_interrupt);
  try {
    return static_cast<int>(run(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pinjaw: a bug: %s\n", error.what());
  }
  return static_cast<int>(ExitCode::Bug);
}

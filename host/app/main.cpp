// pinjaw: designs modular pin grippers and runs them. The command line.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <limits>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/context.hpp"
#include "host/app/interrupt.hpp"
#include "host/app/usage.hpp"

namespace {

using pinjaw::app::Context;
using pinjaw::app::ExitCode;
using pinjaw::app::ProgressMode;

constexpr const char* kFooter =
    R"(Exit codes: 0 done; 1 the answer is no; 2 usage; 3 bad input file; 4 controller refused or fault;
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
  app.add_option("--key-file", context.key_file,
                 "the key that the controllers of the cell ask for: 32 hexadecimal digits")
      ->envname("PINJAW_KEY_FILE")
      ->type_name("FILE")
      ->check(pinjaw::app::file_name());
  app.add_flag("--can-fd", context.can_fd, "with a key: CAN FD, and a MAC in every frame");
  app.add_flag("--json", context.json, "the result on stdout as JSON");
  app.add_flag("--quiet", context.quiet, "no remarks and no progress on stderr");
  pinjaw::app::add_choice<ProgressMode>(
      app, "--progress", context.progress,
      {{"auto", ProgressMode::Auto}, {"none", ProgressMode::None}, {"json", ProgressMode::Json}},
      "on stderr: a live line where that is a terminal, nothing, or a JSON object a line");
  app.add_option("--seed", context.seed, "seed of everything random in a run")
      ->type_name("N")
      ->check(pinjaw::app::whole_in({0, std::numeric_limits<std::int64_t>::max()}))
      ->capture_default_str();
}

ExitCode run(int argc, char** argv) {
  Context context;
  CLI::App app("pinjaw designs modular pin grippers and runs them", "pinjaw");
  app.set_version_flag("--version", "pinjaw " PINJAW_VERSION);
  app.get_formatter()->label("REQUIRED", "(required)");
  app.require_subcommand(1);
  app.fallthrough();
  app.footer(kFooter);
  app.failure_message([](const CLI::App* failed, const CLI::Error& error) {
    return pinjaw::app::usage_message(*failed, error);
  });
  add_globals(app, context);
  pinjaw::app::add_commands(app, context);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (app.exit(error) != 0) return ExitCode::Usage;
  }
  context.finish();
  return context.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  pinjaw::app::end_when_interrupted();
  try {
    return static_cast<int>(run(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pinjaw: a bug: %s\n", error.what());
  }
  return static_cast<int>(ExitCode::Bug);
}

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/config/read.hpp"
#include "host/planner/plan/planar_json.hpp"
#include "host/planner/planar/planar.hpp"

namespace pinjaw::app {

namespace {

struct PlanarOptions {
  std::string profile;
  std::string kit;
  std::string output;
  int threads = 0;
};

void run_planar(Context& context, const PlanarOptions& options) {
  if (!context.can_write(options.output, options.profile)) return;
  const auto profile = config::read_profile(options.profile);
  const auto kit = config::read_kit(options.kit);
  base::Diagnostics mistakes;
  if (!profile) mistakes.add(profile.error());
  if (!kit) mistakes.add(kit.error());
  if (!mistakes.empty()) return context.fail(mistakes, "nothing was planned");

  const std::vector<model::Feature> features = model::features_of(*profile);
  planner::PlanarOptions planar;
  planar.outline = &*profile;
  planar.threads = options.threads;
  const planner::PlanarResult result = planner::plan_planar_fixtures(features, *kit, planar);
  const std::string summary = fmt::format("{} planar fixtures, each and its twin", result.fixtures.size());
  if (!context.deliver(options.output, planner::to_json(result.fixtures, features, *kit), summary)) return;
  if (result.fixtures.empty()) context.exit_code = ExitCode::No;
}

}  // namespace

void add_planar(CLI::App& app, Context& context) {
  auto options = std::make_shared<PlanarOptions>();
  CLI::App* command = app.add_subcommand("planar", "every planar fixture of a profile");
  command->add_option("PROFILE", options->profile, "profile file")
      ->type_name("")
      ->check(file_name())
      ->required();
  command->add_option("--kit", options->kit, "kit file")->type_name("KIT")->required();
  command->add_option("-o,--output", options->output, "JSON; without it to stdout")->type_name("FILE");
  add_threads(*command, options->threads);
  command->callback([&context, options] { run_planar(context, *options); });
}

}  // namespace pinjaw::app

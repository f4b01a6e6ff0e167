#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/config/read.hpp"
#include "host/planner/features/features.hpp"
#include "host/planner/plan/planar_json.hpp"
#include "host/planner/plan/scene.hpp"
#include "host/report/features_drawing.hpp"

namespace pinjaw::app {

namespace {

struct Options {
  std::string task;
  std::string output;
};

std::vector<std::pair<std::string, int>> counts_of(const planner::FeatureCounts& counts,
                                                   const part::EdgeCounts& edges) {
  return {{"edges", edges.total},
          {"left_out_seams", edges.seams},
          {"left_out_degenerate", edges.degenerate},
          {"candidates", counts.candidates},
          {"left_out_upright", counts.left_out_upright},
          {"left_out_tilted", counts.left_out_tilted},
          {"left_out_freeform", counts.left_out_freeform},
          {"edgelets", counts.edgelets},
          {"visible", counts.visible},
          {"features", counts.features},
          {"reachable", counts.reachable}};
}

bool is_known_ending(const std::string& output) {
  return output.empty() || output == "-" || output.ends_with(".json") || output.ends_with(".svg");
}

void run_features(Context& context, const Options& options) {
  if (!is_known_ending(options.output)) {
    return context.fail(ExitCode::Usage,
                        "--output: expected a name that ends in .json or .svg, found " + options.output);
  }
  if (!context.can_write(options.output, options.task)) return;
  const auto task = config::read_task(options.task);
  if (!task) return context.fail(task.error(), "nothing was planned");
  const auto scene = planner::read_scene(*task);
  if (!scene) return context.fail(ExitCode::BadFile, scene.error().message);

  const planner::Features found = planner::find_features(scene->turned, task->kit.pins);
  const auto counts = counts_of(found.counts, scene->part.edge_counts);
  const bool drawing = options.output.ends_with(".svg");
  const std::string document = planner::features_json(task->name, found.features, counts);
  std::string bytes = document;
  if (drawing) {
    bytes = report::features_svg(
        {task->name, found.features, planner::outlines(scene->turned).from_below, task->kit.pins.radius_mm});
  }
  std::string summary;
  for (const auto& [name, count] : counts) summary += fmt::format("{:<20}{:>7}\n", name, count);
  summary.pop_back();
  if (!context.write_result(options.output, bytes)) return;
  if (options.output.empty() || options.output == "-") {
    context.note(summary);
  } else {
    context.print(context.json ? document : summary);
  }
  if (found.features.empty()) context.exit_code = ExitCode::No;
}

}  // namespace

void add_features(CLI::App& app, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("features", "the edges of a part that a pin can touch");
  command->add_option("TASK", options->task, "task file")->type_name("")->check(file_name())->required();
  command->add_option("-o,--output", options->output, "FILE.json or FILE.svg; without it JSON to stdout")
      ->type_name("FILE");
  command->callback([&context, options] { run_features(context, *options); });
}

}  // namespace pinjaw::app

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

using Counts = std::vector<std::pair<std::string, int>>;

/// What was read: the edges of a STEP file, or the facets of a mesh.
Counts read_counts(const part::Part& part) {
  if (!part.mesh_counts) {
    return {{"edges", part.edge_counts.total},
            {"left_out_seams", part.edge_counts.seams},
            {"left_out_degenerate", part.edge_counts.degenerate}};
  }
  const part::MeshCounts& mesh = *part.mesh_counts;
  return {{"facets", mesh.facets},
          {"dropped_degenerate", mesh.degenerate},
          {"dropped_repeated", mesh.repeated},
          {"turned", mesh.turned},
          {"shells", mesh.shells},
          {"open_edges", mesh.open_edges},
          {"crowded_edges", mesh.crowded_edges},
          {"edges", part.contour_counts.edges},
          {"left_out_gentle", part.contour_counts.gentle},
          {"left_out_jagged", part.contour_counts.jagged}};
}

Counts counts_of(const planner::FeatureCounts& counts, const part::Part& part) {
  Counts all = read_counts(part);
  all.insert(all.end(), {{"candidates", counts.candidates},
                         {"left_out_upright", counts.left_out_upright},
                         {"left_out_tilted", counts.left_out_tilted},
                         {"left_out_freeform", counts.left_out_freeform},
                         {"edgelets", counts.edgelets},
                         {"visible", counts.visible},
                         {"features", counts.features},
                         {"reachable", counts.reachable}});
  return all;
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
  const auto counts = counts_of(found.counts, scene->part);
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

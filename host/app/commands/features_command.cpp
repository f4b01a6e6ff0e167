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
#include "host/report/part_edges.hpp"

namespace pinjaw::app {

namespace {

struct FeaturesOptions {
  std::string task;
  std::string output;
};

using Counts = std::vector<std::pair<std::string, int>>;

/// What was read of a mesh, and the edges of it that no contour stands for.
Counts mesh_counts_of(const part::Part& part) {
  if (!part.mesh_counts) return {};
  const part::MeshCounts& mesh = *part.mesh_counts;
  const part::ContourCounts& contours = part.contour_counts;
  return {{"facets", mesh.facets},
          {"dropped_degenerate", mesh.degenerate},
          {"dropped_repeated", mesh.repeated},
          {"turned", mesh.turned},
          {"shells", mesh.shells},
          {"open_edges", mesh.open_edges},
          {"crowded_edges", mesh.crowded_edges},
          {"edges", contours.edges},
          {"left_out_upright", contours.upright},
          {"left_out_gentle", contours.gentle},
          {"left_out_jagged", contours.jagged}};
}

/// What became of one kind of source, as a line of the summary: only what occurred.
std::string fates_text(const std::string& kind, const planner::FateCounts& counts) {
  std::string text = fmt::format("{:<12}{:>7}\n", kind, counts.total);
  for (const planner::Fate fate : planner::kFates) {
    if (counts[fate] > 0)
      text += fmt::format("{:>12}{:>7}  {}\n", "", counts[fate], planner::meaning_of(fate));
  }
  return text;
}

std::string summary_of(const planner::FeatureCounts& counts, const Counts& mesh) {
  std::string text;
  for (const auto& [name, count] : mesh) text += fmt::format("{:<20}{:>7}\n", name, count);
  if (mesh.empty()) {
    text += fates_text("edges", counts.edges) + fates_text("walls", counts.walls) +
            fates_text("silhouettes", counts.silhouettes);
  } else {
    text += fates_text("contours", counts.contours);
  }
  return text + fmt::format("{:<12}{:>7}  in {} edgelets, {} of them visible\n{:<12}{:>7}", "features",
                            counts.features, counts.edgelets, counts.visible, "reachable", counts.reachable);
}

/// The part's size, so that a file in the wrong unit shows, and its mass where it is known.
std::string size_text(const part::Part& part) {
  const geometry::Surface& surface = part.surface;
  std::string text = fmt::format("{:<12}{:>7.4g} x {:.4g} x {:.4g} mm", "part", surface.x_range_mm().length(),
                                 surface.y_range_mm().length(), surface.z_range_mm().length());
  if (part.mass_kg > 0) text += fmt::format(", {:.3g} kg", part.mass_kg);
  return text + "\n";
}

bool is_known_ending(const std::string& output) {
  return output.empty() || output == "-" || output.ends_with(".json") || output.ends_with(".svg");
}

void run_features(Context& context, const FeaturesOptions& options) {
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
  const Counts mesh_counts = mesh_counts_of(scene->part);
  const bool drawing = options.output.ends_with(".svg");
  const std::string document = planner::features_json(task->name, found.features, found.counts, mesh_counts);
  std::string bytes = document;
  if (drawing) {
    bytes = report::features_svg(
        {task->name, found.features, report::sheet_edges(scene->turned), task->kit.pins.radius_mm});
  }
  const std::string summary = size_text(scene->part) + summary_of(found.counts, mesh_counts);
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
  auto options = std::make_shared<FeaturesOptions>();
  CLI::App* command = app.add_subcommand("features", "the edges of a part that a pin can touch");
  command->add_option("TASK", options->task, "task file")->type_name("")->check(file_name())->required();
  command->add_option("-o,--output", options->output, "FILE.json or FILE.svg; without it JSON to stdout")
      ->type_name("FILE");
  command->callback([&context, options] { run_features(context, *options); });
}

}  // namespace pinjaw::app

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/cell/read_cell.hpp"
#include "host/planner/plan/plan_json.hpp"
#include "host/report/part_edges.hpp"
#include "host/report/sheet.hpp"

namespace pinjaw::app {

namespace {

struct SheetOptions {
  std::string plan;
  std::string station;
  std::string design = "best";
  std::string output;
};

/// One design and what it was made for, wherever it was written down.
struct Planned {
  model::Task task;
  std::string part_sha256;
  model::FrictionModel friction_model = model::FrictionModel::Pyramid;
  model::Design design;
};

std::optional<report::PictureFormat> format_of(const std::string& file) {
  if (file.ends_with(".svg")) return report::PictureFormat::Svg;
  if (file.ends_with(".pdf")) return report::PictureFormat::Pdf;
  if (file.ends_with(".png")) return report::PictureFormat::Png;
  return std::nullopt;
}

std::optional<Planned> from_plan(Context& context, const SheetOptions& options) {
  const auto plan = planner::read_plan(options.plan);
  if (!plan) {
    context.fail(plan.error(), "nothing was drawn");
    return std::nullopt;
  }
  const model::Design* design = find_design(plan->designs, options.design);
  if (design == nullptr) {
    fail_without_design(context, options.design, options.plan, plan->designs.size());
    return std::nullopt;
  }
  return Planned{planner::task_of(*plan), plan->part.sha256, plan->friction_model, *design};
}

std::optional<Planned> from_cell_plan(Context& context, const SheetOptions& options) {
  const auto plan = cell::read_cell_plan(options.plan);
  if (!plan) {
    context.fail(plan.error(), "nothing was drawn");
    return std::nullopt;
  }
  const auto facts = std::ranges::find(plan->stations, options.station, &cell::StationFacts::station);
  if (facts == plan->stations.end()) {
    context.fail(ExitCode::No, options.plan + " has no station " + options.station);
    return std::nullopt;
  }
  const auto chosen = options.design == "best"
                          ? plan->designs.begin()
                          : std::ranges::find(plan->designs, options.design, &cell::CellDesign::id);
  if (chosen == plan->designs.end()) {
    fail_without_design(context, options.design, options.plan, plan->designs.size());
    return std::nullopt;
  }
  Planned planned;
  planned.task.name = facts->task;
  planned.task.part.file = plan->part_file;
  planned.task.part.up = plan->up;
  planned.task.kit = facts->kit;
  planned.task.side = facts->side;
  planned.task.friction = facts->friction.mu;
  planned.part_sha256 = plan->part_sha256;
  planned.friction_model = facts->friction.model;
  planned.design =
      std::ranges::find(chosen->stations, options.station, &cell::StationDesign::station)->design;
  return planned;
}

void run_sheet(Context& context, const SheetOptions& options) {
  const auto format = format_of(options.output);
  if (!format) {
    return context.fail(ExitCode::Usage,
                        "--output: expected a name that ends in .svg, .pdf or .png, found " + options.output);
  }
  if (!context.can_write(options.output, options.plan)) return;
  const auto planned =
      options.station.empty() ? from_plan(context, options) : from_cell_plan(context, options);
  if (!planned) return;
  const auto scene = planner::read_scene(planned->task);
  if (!scene) return context.fail(ExitCode::BadFile, options.plan + ": part: " + scene.error().message);

  report::Sheet sheet;
  sheet.task = planned->task.name;
  sheet.part = scene->part.name;
  sheet.part_sha256 = planned->part_sha256;
  sheet.side = planned->task.side == model::Side::Below ? "below" : "above";
  sheet.friction = planned->task.friction;
  sheet.friction_model = planned->friction_model == model::FrictionModel::Pyramid ? "pyramid" : "cone";
  sheet.kit = planned->task.kit;
  sheet.design = planned->design;
  sheet.edges = report::sheet_edges(scene->turned);
  sheet.grips = planned->design.pins.size() == 4;
  const auto bytes = report::written(report::sheet_picture(sheet), *format);
  if (!bytes) return context.fail(ExitCode::Bug, bytes.error().message);
  if (context.write_result(options.output, *bytes)) {
    context.note(fmt::format("{}: design {}", options.output, planned->design.id));
  }
}

}  // namespace

void add_sheet(CLI::App& app, Context& context) {
  auto options = std::make_shared<SheetOptions>();
  CLI::App* command =
      app.add_subcommand("sheet", "set-up sheet of a design at 1:1, for whoever puts the pins in");
  command->add_option("PLAN", options->plan, "plan JSON; with --station, cell plan JSON")
      ->type_name("")
      ->check(file_name())
      ->required();
  command->add_option("--station", options->station, "station of a cell plan")->type_name("NAME");
  command->add_option("--design", options->design, "id of a design, or best")
      ->type_name("ID")
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "FILE.svg, FILE.pdf or FILE.png")
      ->type_name("FILE")
      ->required();
  command->callback([&context, options] { run_sheet(context, *options); });
}

}  // namespace pinjaw::app

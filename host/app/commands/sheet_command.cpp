#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/planner/plan/plan_json.hpp"
#include "host/report/part_edges.hpp"
#include "host/report/sheet.hpp"

namespace pinjaw::app {

namespace {

struct Options {
  std::string plan;
  std::string design = "best";
  std::string output;
};

std::optional<report::PictureFormat> format_of(const std::string& file) {
  if (file.ends_with(".svg")) return report::PictureFormat::Svg;
  if (file.ends_with(".pdf")) return report::PictureFormat::Pdf;
  if (file.ends_with(".png")) return report::PictureFormat::Png;
  return std::nullopt;
}

void run_sheet(Context& context, const Options& options) {
  const auto format = format_of(options.output);
  if (!format) {
    return context.fail(ExitCode::Usage,
                        "--output: expected a name that ends in .svg, .pdf or .png, found " + options.output);
  }
  if (!context.can_write(options.output, options.plan)) return;
  const auto plan = planner::read_plan(options.plan);
  if (!plan) return context.fail(plan.error(), "nothing was drawn");
  const model::Design* design = find_design(plan->designs, options.design);
  if (design == nullptr)
    return fail_without_design(context, options.design, options.plan, plan->designs.size());
  const auto scene = planner::read_scene(planner::task_of(*plan));
  if (!scene) return context.fail(ExitCode::BadFile, options.plan + ": part: " + scene.error().message);

  report::Sheet sheet;
  sheet.task = plan->task;
  sheet.part = scene->part.name;
  sheet.part_sha256 = plan->part.sha256;
  sheet.side = plan->side == model::Side::Below ? "below" : "above";
  sheet.friction = plan->friction;
  sheet.friction_model = plan->friction_model == model::FrictionModel::Pyramid ? "pyramid" : "cone";
  sheet.kit = plan->kit;
  sheet.design = *design;
  sheet.edges = report::sheet_edges(scene->turned);
  sheet.grips = design->pins.size() == 4;
  const auto bytes = report::written(report::sheet_picture(sheet), *format);
  if (!bytes) return context.fail(ExitCode::Bug, bytes.error().message);
  if (context.write_result(options.output, *bytes))
    context.note(fmt::format("{}: design {}", options.output, design->id));
}

}  // namespace

void add_sheet(CLI::App& app, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("sheet", "set-up sheet of a design at 1:1, for whoever puts the pins in");
  command->add_option("PLAN", options->plan, "plan JSON")->type_name("")->check(file_name())->required();
  command->add_option("--design", options->design, "id of a design, or best")
      ->type_name("ID")
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "FILE.svg, FILE.pdf or FILE.png")
      ->type_name("FILE")
      ->required();
  command->callback([&context, options] { run_sheet(context, *options); });
}

}  // namespace pinjaw::app

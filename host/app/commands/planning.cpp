#include "host/app/commands/planning.hpp"

#include <CLI/CLI.hpp>
#include <map>

#include "host/config/read.hpp"

namespace pinjaw::app {

namespace {

constexpr int kMostThreads = 1024;

/// "all" or a whole number above 0.
std::string top_mistake(const std::string& text) {
  if (text == "all") return {};
  const bool digits = !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
  if (digits && std::stoul(text) > 0) return {};
  return "expected a whole number above 0 or all, found " + text;
}

}  // namespace

void add_planning_options(CLI::App& command, PlanningOptions& options) {
  command.add_option("--top", options.top, "designs that the plan keeps, or all")
      ->check(CLI::Validator(top_mistake, "N|all"))
      ->capture_default_str();
  command.add_option("--friction", options.plan.friction, "pyramid (the paper's) or cone (exact)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, model::FrictionModel>{
          {"pyramid", model::FrictionModel::Pyramid}, {"cone", model::FrictionModel::Cone}}))
      ->default_str("pyramid");
  command.add_option("--loading", options.plan.loading_2d, "3d, or 2d: pins as tall as the part")
      ->transform(CLI::CheckedTransformer(std::map<std::string, bool>{{"3d", false}, {"2d", true}}))
      ->default_str("3d");
  command.add_option("--threads", options.plan.threads, "threads; 0: as many as there are")
      ->check(CLI::Range(0, kMostThreads))
      ->capture_default_str();
}

std::optional<planner::Plan> plan_task(Context& context, const std::string& task_file, const PlanningOptions& options) {
  const auto task = config::read_task(task_file);
  if (!task) {
    context.fail(task.error(), "nothing was planned");
    return std::nullopt;
  }
  const auto scene = planner::read_scene(*task);
  if (!scene) {
    context.fail(ExitCode::BadFile, scene.error().message);
    return std::nullopt;
  }
  planner::PlanOptions plan_options = options.plan;
  plan_options.top = options.top == "all" ? 0 : std::stoul(options.top);
  auto plan = planner::make_plan(*task, *scene, plan_options, context.progress_sink());
  if (!plan) {
    context.fail(ExitCode::BadFile, task_file + ": " + plan.error().message);
    return std::nullopt;
  }
  return std::move(*plan);
}

}  // namespace pinjaw::app

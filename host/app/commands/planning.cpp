#include "host/app/commands/planning.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "host/app/choices.hpp"
#include "host/config/read.hpp"

namespace pinjaw::app {

namespace {

constexpr int kMostThreads = 1024;

/// "all" or a whole number above 0.
std::string top_mistake(const std::string& text) {
  if (text == "all") return {};
  const bool digits =
      !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
  if (digits && std::stoul(text) > 0) return {};
  return "expected a whole number above 0 or all, found " + text;
}

}  // namespace

void add_planning_options(CLI::App& command, PlanningOptions& options) {
  command.add_option("--top", options.top, "designs that the plan keeps")
      ->check(CLI::Validator(top_mistake, ""))
      ->type_name("N|all")
      ->capture_default_str();
  add_choice<model::FrictionModel>(
      command, "--friction", options.plan.friction,
      {{"pyramid", model::FrictionModel::Pyramid}, {"cone", model::FrictionModel::Cone}},
      "the paper's linear pyramid, or the exact Coulomb cone");
  add_choice<bool>(command, "--loading", options.plan.loading_2d, {{"3d", false}, {"2d", true}},
                   "2d: as if the pins were as tall as the part");
  add_threads(command, options.plan.threads);
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "0: as many as the machine has")
      ->type_name("N")
      ->check(whole_in({0, kMostThreads}))
      ->capture_default_str();
}

const model::Design* find_design(const std::vector<model::Design>& designs, const std::string& id) {
  if (id == "best") return designs.empty() ? nullptr : designs.data();
  const auto found = std::ranges::find(designs, id, &model::Design::id);
  return found == designs.end() ? nullptr : &*found;
}

void fail_without_design(Context& context, const std::string& id, const std::string& file,
                         std::size_t designs) {
  context.fail(ExitCode::No, designs == 0
                                 ? fmt::format("{} has no designs", file)
                                 : fmt::format("{} has {} designs, none is called {}", file, designs, id));
}

std::optional<Job> read_job(Context& context, const std::string& task_file, const PlanningOptions& options) {
  auto task = config::read_task(task_file);
  if (!task) {
    context.fail(task.error(), "nothing was planned");
    return std::nullopt;
  }
  auto scene = planner::read_scene(*task);
  if (!scene) {
    context.fail(ExitCode::BadFile, scene.error().message);
    return std::nullopt;
  }
  Job job{std::move(*task), std::move(*scene), options.plan};
  job.options.top = options.top == "all" ? 0 : std::stoul(options.top);
  return job;
}

std::optional<planner::Plan> plan_job(Context& context, const Job& job, const std::string& task_file) {
  auto plan = planner::make_plan(job.task, job.scene, job.options, context.progress_sink());
  if (!plan) {
    context.fail(ExitCode::BadFile, task_file + ": " + plan.error().message);
    return std::nullopt;
  }
  return std::move(*plan);
}

std::optional<planner::Plan> plan_task(Context& context, const std::string& task_file,
                                       const PlanningOptions& options) {
  const auto job = read_job(context, task_file, options);
  if (!job) return std::nullopt;
  return plan_job(context, *job, task_file);
}

}  // namespace pinjaw::app

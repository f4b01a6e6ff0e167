#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/app/plan_text.hpp"
#include "host/planner/plan/exact.hpp"
#include "host/planner/plan/plan_json.hpp"
#include "host/planner/plan/rank.hpp"

namespace pinjaw::app {

namespace {

struct PlanOptions {
  std::string task;
  std::string output;
  std::optional<int> certify;
  std::optional<int> robust;
  std::optional<int> exact;
  planner::Rank rank = planner::Rank::Nominal;
  PlanningOptions planning;
};

constexpr int kLookedInto =
    10;  // where --certify, --robust or --exact has no number: as many as the summary shows
constexpr int kMostLookedInto = 1000000;

/// The plan with how robust its best designs are and what they come to on exact faces, where that was asked
/// for.
std::optional<planner::Plan> plan_as_asked(Context& context, const PlanOptions& options) {
  auto job = read_job(context, options.task, options.planning);
  if (!job) return std::nullopt;
  const bool by_worst = options.rank == planner::Rank::Robust;
  const planner::RobustOptions robust{static_cast<std::size_t>(options.robust.value_or(kLookedInto)),
                                      options.rank, job->options.top};
  if (by_worst) job->options.top = 0;  // the most robust may stand anywhere
  auto plan = plan_job(context, *job, options.task);
  if (!plan) return std::nullopt;
  if (options.robust || by_worst)
    planner::tell_robustness(*plan, job->scene, job->task.ranges, robust, context.progress_sink());
  if (options.exact) {
    const auto told = planner::tell_exactly(*plan, job->scene, static_cast<std::size_t>(*options.exact));
    if (!told) {
      context.fail(ExitCode::BadFile, options.task + ": " + told.error().message);
      return std::nullopt;
    }
  }
  return plan;
}

void run_plan(Context& context, const PlanOptions& options) {
  if (!context.can_write(options.output, options.task)) return;
  const auto plan = plan_as_asked(context, options);
  if (!plan) return;
  constexpr std::size_t kShown = 10;
  const std::string summary =
      funnel_text(plan->funnel) + "\n" + designs_text(*plan, kShown) + certified_text(*plan) +
      robust_text(*plan) + exact_text(*plan) +
      "\nThe squeeze is what can balance the load, the sum of both jaws; it is not a guarantee.";
  if (!context.deliver(options.output, planner::to_json(*plan), summary)) return;
  if (plan->designs.empty()) context.exit_code = ExitCode::No;
}

}  // namespace

void add_plan(CLI::App& app, Context& context) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command =
      app.add_subcommand("plan", "every pin layout that holds the part, smallest squeeze first");
  command->add_option("TASK", options->task, "task file")->type_name("")->check(file_name())->required();
  command->add_option("-o,--output", options->output, "plan JSON; without it the JSON goes to stdout")
      ->type_name("FILE");
  const auto add_count = [&](const char* name, std::optional<int>& count, const char* help) {
    command->add_option(name, count, help)
        ->type_name("[N]")
        ->expected(0, 1)
        ->default_str(std::to_string(kLookedInto))
        ->check(whole_in({1, kMostLookedInto}));
  };
  add_count("--certify", options->certify,
            "for the best N designs (10), find the worst spray anywhere a jet reaches the part");
  add_count("--robust", options->robust,
            "how the N best designs (10) fare over the task's ranges of friction, pins, part and air");
  add_count("--exact", options->exact,
            "what the N best designs (10) come to on the exact faces of the part, not on its triangles");
  add_choice<planner::Rank>(
      *command, "--rank", options->rank,
      {{"nominal", planner::Rank::Nominal}, {"robust", planner::Rank::Robust}},
      "by the required squeeze, or first the N designs whose worst over the ranges is least");
  add_planning_options(*command, options->planning);
  command->callback([&context, options] {
    options->planning.plan.certify = static_cast<std::size_t>(options->certify.value_or(0));
    run_plan(context, *options);
  });
}

}  // namespace pinjaw::app

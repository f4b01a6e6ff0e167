#include <CLI/CLI.hpp>
#include <memory>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/app/plan_text.hpp"
#include "host/planner/plan/plan_json.hpp"

namespace pinjaw::app {

namespace {

struct Options {
  std::string task;
  std::string output;
  PlanningOptions planning;
};

void run_plan(Context& context, const Options& options) {
  if (!context.can_write(options.output, options.task)) return;
  const auto plan = plan_task(context, options.task, options.planning);
  if (!plan) return;
  constexpr std::size_t kShown = 10;
  const std::string summary =
      funnel_text(plan->funnel) + "\n" + designs_text(*plan, kShown) +
      "\nThe squeeze is what can balance the load, the sum of both jaws; it is not a guarantee.";
  if (!context.deliver(options.output, planner::to_json(*plan), summary)) return;
  if (plan->designs.empty()) context.exit_code = ExitCode::No;
}

}  // namespace

void add_plan(CLI::App& app, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("plan", "every pin layout that holds the part, smallest squeeze first");
  command->add_option("TASK", options->task, "task file")->type_name("")->check(file_name())->required();
  command->add_option("-o,--output", options->output, "plan JSON; without it the JSON goes to stdout")
      ->type_name("FILE");
  add_planning_options(*command, options->planning);
  command->callback([&context, options] { run_plan(context, *options); });
}

}  // namespace pinjaw::app

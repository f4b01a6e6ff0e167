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
  std::string certify;
};

constexpr std::size_t kCertified = 10;  // where --certify has no number

/// "" or a whole number above 0.
std::string certify_mistake(const std::string& text) {
  const bool digits = text.size() < 6 && text.find_first_not_of("0123456789") == std::string::npos;
  if (text.empty() || (digits && std::stoul(text) > 0)) return {};
  return "expected a count of designs above 0 (or nothing, with --certify after the task), found " + text;
}

void run_plan(Context& context, const Options& options) {
  if (!context.can_write(options.output, options.task)) return;
  const auto plan = plan_task(context, options.task, options.planning);
  if (!plan) return;
  constexpr std::size_t kShown = 10;
  const std::string summary =
      funnel_text(plan->funnel) + "\n" + designs_text(*plan, kShown) + certified_text(*plan) +
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
  CLI::Option* certify =
      command
          ->add_option("--certify", options->certify,
                       "for the best N designs (10), find the worst spray anywhere a jet reaches the part")
          ->type_name("[N]")
          ->expected(0, 1)
          ->check(CLI::Validator(certify_mistake, ""));
  command->callback([&context, options, certify] {
    if (certify->count() > 0) {
      options->planning.plan.certify = options->certify.empty() ? kCertified : std::stoul(options->certify);
    }
    run_plan(context, *options);
  });
}

}  // namespace pinjaw::app

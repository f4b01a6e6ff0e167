#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "host/app/commands/commands.hpp"
#include "host/planner/plan/check.hpp"
#include "host/planner/plan/plan_json.hpp"

namespace pinjaw::app {

namespace {

struct Options {
  std::string plan;
  std::string design;
  bool all = false;
};

/// Prints the failed claims (all of them with --all); true where every claim holds.
bool report_claims(const Context& context, const std::vector<planner::Claim>& claims, bool all) {
  bool holds = true;
  for (const planner::Claim& claim : claims) {
    holds = holds && claim.holds;
    if (claim.holds && !all) continue;
    const std::string subject = claim.subject.empty() ? "plan" : claim.subject;
    const std::string found = claim.holds ? std::string() : ": " + claim.found;
    context.print(fmt::format("{:<4} {}: {}{}", claim.holds ? "ok" : "NO", subject, claim.claim, found));
  }
  return holds;
}

void run_check(Context& context, const Options& options) {
  const auto plan = planner::read_plan(options.plan);
  if (!plan) return context.fail(plan.error(), "nothing was checked");
  const auto scene = planner::read_scene(planner::task_of(*plan));
  if (!scene) return context.fail(ExitCode::BadFile, options.plan + ": part: " + scene.error().message);

  const std::vector<planner::Claim> whole = planner::check_plan(*plan, *scene);
  std::size_t claims = whole.size();
  bool holds = report_claims(context, whole, options.all);
  std::size_t designs = 0;
  for (const model::Design& design : plan->designs) {
    const bool wanted = options.design.empty() || design.id == options.design ||
                        (options.design == "best" && &design == &plan->designs.front());
    if (!wanted) continue;
    ++designs;
    const std::vector<planner::Claim> of_design = planner::check_design(*plan, *scene, design);
    claims += of_design.size();
    holds = report_claims(context, of_design, options.all) && holds;
  }
  if (designs == 0) return context.fail(ExitCode::No, "no design " + options.design + " in " + options.plan);
  context.print(fmt::format("{}: {} claims of {} designs {}", options.plan, claims, designs,
                            holds ? "hold" : "were recomputed, some do not hold"));
  if (!holds) context.exit_code = ExitCode::No;
}

}  // namespace

void add_check(CLI::App& app, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("check", "recompute every claim of a plan from its stated numbers");
  command->add_option("PLAN", options->plan, "plan JSON")->required();
  command->add_option("--design", options->design, "only this design (an id, or best)");
  command->add_flag("--all", options->all, "print the claims that hold, too");
  command->callback([&context, options] { run_check(context, *options); });
}

}  // namespace pinjaw::app

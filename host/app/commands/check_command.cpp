#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/planner/plan/check.hpp"
#include "host/planner/plan/plan_json.hpp"

namespace pinjaw::app {

namespace {

struct CheckOptions {
  std::string plan;
  std::string design;
  bool all = false;
};

/// The claims of a plan, as they are recomputed.
class Verdict {
 public:
  void add(std::vector<planner::Claim> claims) {
    claims_.insert(claims_.end(), claims.begin(), claims.end());
  }
  [[nodiscard]] bool holds() const { return std::ranges::all_of(claims_, &planner::Claim::holds); }
  [[nodiscard]] std::size_t size() const { return claims_.size(); }

  /// The claims that do not hold, with `all` the others too.
  [[nodiscard]] std::string text(bool all) const {
    std::string lines;
    for (const planner::Claim& claim : claims_) {
      if (claim.holds && !all) continue;
      lines += fmt::format("{:<4} {}: {}{}\n", claim.holds ? "ok" : "NO",
                           claim.subject.empty() ? "plan" : claim.subject, claim.claim,
                           claim.holds ? "" : ": " + claim.found);
    }
    return lines;
  }
  [[nodiscard]] nlohmann::ordered_json json(bool all) const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const planner::Claim& claim : claims_) {
      if (claim.holds && !all) continue;
      list.push_back({{"subject", claim.subject},
                      {"claim", claim.claim},
                      {"holds", claim.holds},
                      {"found", claim.found}});
    }
    return list;
  }

 private:
  std::vector<planner::Claim> claims_;
};

void run_check(Context& context, const CheckOptions& options) {
  const auto plan = planner::read_plan(options.plan);
  if (!plan) return context.fail(plan.error(), "nothing was checked");
  const model::Design* only = options.design.empty() ? nullptr : find_design(plan->designs, options.design);
  if (!options.design.empty() && only == nullptr) {
    return fail_without_design(context, options.design, options.plan, plan->designs.size());
  }
  const auto scene = planner::read_scene(planner::task_of(*plan));
  if (!scene) return context.fail(ExitCode::BadFile, options.plan + ": part: " + scene.error().message);

  Verdict verdict;
  verdict.add(planner::check_plan(*plan, *scene));
  std::size_t designs = 0;
  for (const model::Design& design : plan->designs) {
    if (only != nullptr && &design != only) continue;
    ++designs;
    verdict.add(planner::check_design(*plan, *scene, design));
  }
  if (context.json) {
    const nlohmann::ordered_json document = {
        {"format", "pinjaw-check/1"}, {"plan", options.plan},      {"holds", verdict.holds()},
        {"designs", designs},         {"checked", verdict.size()}, {"claims", verdict.json(options.all)}};
    context.print(document.dump(1));
  } else {
    context.print(verdict.text(options.all) +
                  fmt::format("{}: {} claims of {} designs {}", options.plan, verdict.size(), designs,
                              verdict.holds() ? "hold" : "were recomputed, some do not hold"));
  }
  if (!verdict.holds()) context.exit_code = ExitCode::No;
}

}  // namespace

void add_check(CLI::App& app, Context& context) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "recompute every claim of a plan from its stated numbers");
  command->add_option("PLAN", options->plan, "plan JSON")->type_name("")->check(file_name())->required();
  command->add_option("--design", options->design, "only this design (an id, or best)")->type_name("ID");
  command->add_flag("--all", options->all, "print the claims that hold, too");
  command->callback([&context, options] { run_check(context, *options); });
}

}  // namespace pinjaw::app

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/app/plan_text.hpp"
#include "host/planner/plan/check.hpp"
#include "host/planner/plan/check_feet.hpp"
#include "host/planner/plan/exact.hpp"
#include "host/planner/plan/plan_json.hpp"

namespace pinjaw::app {

namespace {

struct CheckOptions {
  std::string plan;
  std::string design;
  bool all = false;
  std::string exact = "10";  // as many as the summary of a plan shows
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

constexpr const char* kNone = "none";
constexpr int kMostExact = 1000000;

/// "all", "none" or a whole number.
std::string exact_mistake(const std::string& text) {
  if (text == "all" || text == kNone || whole_in({0, kMostExact})(text).empty()) return {};
  return fmt::format("expected a whole number from 0 to {}, all or none, found {}", kMostExact, text);
}

/// Of `designs` the best so many, and those that say what they come to on exact faces; none where none is
/// asked.
std::vector<const model::Design*> to_recheck(const std::vector<const model::Design*>& designs,
                                             const std::string& exact) {
  std::size_t best = designs.size();
  if (exact == kNone)
    best = 0;
  else if (exact != "all")
    best = static_cast<std::size_t>(std::stoul(exact));
  if (best == 0) return {};
  std::vector<const model::Design*> chosen;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    if (i < best || designs[i]->exact) chosen.push_back(designs[i]);
  }
  return chosen;
}

nlohmann::ordered_json exact_json(const planner::ExactReport& report) {
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  double largest_mm = 0;
  for (const planner::ExactDesign& design : report.designs) {
    largest_mm = std::max(largest_mm, design.summary.largest_difference_mm);
    for (const planner::ExactFigure& figure : design.figures) {
      if (figure.difference_mm() < kToldDifference_mm) continue;
      figures.push_back({{"subject", figure.subject},
                         {"what", figure.what},
                         {"mesh_mm", figure.mesh_mm},
                         {"exact_mm", figure.brep_mm}});
    }
  }
  return {{"designs", report.designs.size()},
          {"tolerance_mm", report.tolerance_mm},
          {"largest_difference_mm", largest_mm},
          {"differences", figures},
          {"without_faces", report.without_faces}};
}

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
  std::vector<const model::Design*> designs;
  for (const model::Design& design : plan->designs) {
    if (only != nullptr && &design != only) continue;
    designs.push_back(&design);
    verdict.add(planner::check_design(*plan, *scene, design));
  }
  verdict.add(planner::check_feet(*plan, *scene, designs));
  const auto rechecked = to_recheck(designs, options.exact);
  const auto exact = planner::recheck_exactly(*plan, *scene, rechecked);
  if (!exact) return context.fail(ExitCode::BadFile, options.plan + ": part: " + exact.error().message);
  for (const planner::ExactDesign& design : exact->designs) verdict.add(design.claims);
  if (context.json) {
    const nlohmann::ordered_json document = {
        {"format", "pinjaw-check/1"}, {"plan", options.plan},      {"holds", verdict.holds()},
        {"designs", designs.size()},  {"checked", verdict.size()}, {"claims", verdict.json(options.all)},
        {"exact", exact_json(*exact)}};
    context.print(document.dump(1));
  } else {
    const std::string recheck = rechecked.empty() ? std::string("no design re-checked on the exact B-rep\n")
                                                  : exact_text(*exact, rechecked.size());
    context.print(verdict.text(options.all) + recheck +
                  fmt::format("{}: {} claims of {} designs {}", options.plan, verdict.size(), designs.size(),
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
  command
      ->add_option("--exact", options->exact,
                   "re-check the best N designs on the exact faces of the part, not on its triangles")
      ->type_name("N|all|none")
      ->check(CLI::Validator(exact_mistake, ""))
      ->capture_default_str();
  command->add_flag("--all", options->all, "print the claims that hold, too");
  command->callback([&context, options] { run_check(context, *options); });
}

}  // namespace pinjaw::app

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/app/plan_text.hpp"
#include "host/app/time_limit.hpp"
#include "host/app/why_text.hpp"
#include "host/planner/force/force.hpp"

namespace pinjaw::app {

namespace {

constexpr int kDefaultSeconds = 60;  // chosen: as long as a person waits for advice
constexpr int kMostSeconds = 86400;

struct WhyOptions {
  std::string task;
  std::string design;
  int seconds = kDefaultSeconds;
  PlanningOptions planning;
};

/// What one contact of a design carries under the load that binds it.
struct Share {
  model::Hole hole;
  double z_mm = 0;  ///< part frame turned by the side
  double push_n = 0;
  double friction_n = 0;
};

std::vector<Share> shares_of(const planner::Plan& plan, const model::Design& design,
                             const model::Disturbance& critical) {
  const planner::Grasp grasp = planner::grasp_of(design, plan.friction);
  planner::SqueezeSolver solver(grasp);
  const auto forces =
      solver.balancing_forces_n(planner::turned(critical.wrench, plan.side), plan.friction_model);
  std::vector<Share> shares;
  if (!forces) return shares;
  for (std::size_t i = 0; i < forces->size(); ++i) {
    const planner::PointContact& contact = grasp.contacts[i];
    const geometry::Vector3d normal(contact.n_P.x(), contact.n_P.y(), 0);
    const double push_n = (*forces)[i].dot(normal);
    shares.push_back({design.pins[static_cast<std::size_t>(contact.pin)].hole, contact.p_P_mm.z(), push_n,
                      ((*forces)[i] - push_n * normal).norm()});
  }
  return shares;
}

std::string design_text(const model::Design& design, const model::Disturbance* critical,
                        const std::vector<Share>& shares) {
  std::string text = fmt::format("design {}: needs {:.2f} N of {:.1f} N usable, for {}\n", design.id,
                                 design.squeeze.required_n, design.squeeze.usable_n, design.squeeze.critical);
  if (critical == nullptr) return text;
  const auto& w = critical->wrench;
  text += fmt::format(
      "  wrench about the part's origin: force {:.2f} {:.2f} {:.2f} N, torque {:.1f} {:.1f} {:.1f} N mm\n",
      w[0], w[1], w[2], w[3], w[4], w[5]);
  constexpr double kIdle_n = 1e-9;  // chosen: the program's own rounding
  for (const Share& share : shares) {
    text += fmt::format("  pin {}-C{}-R{} at z {:7.2f}: pushes {:7.2f} N, friction {:6.2f} N{}\n",
                        share.hole.jaw == model::JawSide::Left ? 'L' : 'R', share.hole.column, share.hole.row,
                        share.z_mm, share.push_n, share.friction_n, share.push_n < kIdle_n ? "  (idle)" : "");
  }
  return text;
}

nlohmann::ordered_json design_json(const model::Design& design, const model::Disturbance* critical,
                                   const std::vector<Share>& shares) {
  nlohmann::ordered_json contacts = nlohmann::ordered_json::array();
  for (const Share& share : shares) {
    contacts.push_back({{"jaw", share.hole.jaw == model::JawSide::Left ? "left" : "right"},
                        {"col", share.hole.column},
                        {"row", share.hole.row},
                        {"z_mm", share.z_mm},
                        {"push_n", share.push_n},
                        {"friction_n", share.friction_n}});
  }
  nlohmann::ordered_json wrench;
  if (critical != nullptr) wrench = std::vector<double>(critical->wrench.begin(), critical->wrench.end());
  return {{"id", design.id},
          {"required_n", design.squeeze.required_n},
          {"usable_n", design.squeeze.usable_n},
          {"critical", design.squeeze.critical},
          {"wrench", wrench},
          {"contacts", contacts}};
}

/// The binding disturbance of a design and what each contact carries under it.
void print_design(const Context& context, const planner::Plan& plan, const model::Design& design) {
  const auto found = std::ranges::find(plan.disturbances, design.squeeze.critical, &model::Disturbance::name);
  const model::Disturbance* critical = found == plan.disturbances.end() ? nullptr : &*found;
  const std::vector<Share> shares =
      critical == nullptr ? std::vector<Share>() : shares_of(plan, design, *critical);
  context.print(context.json ? design_json(design, critical, shares).dump(1)
                             : design_text(design, critical, shares));
}

/// The near misses of a plan and, where it has no design, what would help; within the time allowed.
void print_advice(Context& context, const Job& job, const planner::Plan& plan, int seconds) {
  const TimeLimit limit{std::chrono::seconds(seconds)};
  planner::Variant variant{job.task, job.options};
  variant.options.stop = limit.token();
  const auto sink = context.progress_sink();
  Advice advice;
  advice.misses = planner::nearest_misses(job.task, job.scene, plan, variant.options, sink);
  if (!context.json) context.print(losses_text(plan) + misses_text(advice.misses));
  if (plan.designs.empty()) {
    const auto told = [&context](const planner::Suggestion& suggestion) {
      if (!context.json) context.print(suggestion_text(suggestion));
    };
    if (!context.json) context.print(kSuggestionsHeading);
    advice.suggestions = planner::suggest(variant, job.scene, plan, advice.misses, told, sink);
  }
  context.print(context.json ? why_json(plan, advice) : rest_text(advice));
}

void run_why(Context& context, WhyOptions options) {
  options.planning.top = "all";
  const auto job = read_job(context, options.task, options.planning);
  if (!job) return;
  auto plan = plan_job(context, *job, options.task);
  if (!plan) return;
  if (plan->designs.empty()) context.exit_code = ExitCode::No;
  if (options.design.empty()) return print_advice(context, *job, *plan, options.seconds);
  const model::Design* design = find_design(plan->designs, options.design);
  if (design == nullptr)
    return fail_without_design(context, options.design, options.task, plan->designs.size());
  print_design(context, *plan, *design);
}

}  // namespace

void add_why(CLI::App& app, Context& context) {
  auto options = std::make_shared<WhyOptions>();
  CLI::App* command = app.add_subcommand(
      "why", "what each phase left out, by how much, and what would help; what limits one design");
  command->add_option("TASK", options->task, "task file")->type_name("")->check(file_name())->required();
  command->add_option("--design", options->design, "id of a design, or best")->type_name("ID");
  command->add_option("--seconds", options->seconds, "time for near misses and suggestions; 0: none")
      ->type_name("N")
      ->check(whole_in({0, kMostSeconds}))
      ->capture_default_str();
  add_planning_options(*command, options->planning);
  command->callback([&context, options] { run_why(context, *options); });
}

}  // namespace pinjaw::app

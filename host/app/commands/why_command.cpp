#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/app/plan_text.hpp"
#include "host/planner/force/force.hpp"

namespace pinjaw::app {

namespace {

struct Options {
  std::string task;
  std::string design;
  PlanningOptions planning;
};

/// The binding disturbance of a design and what each contact carries under it.
void print_design(const Context& context, const planner::Plan& plan, const model::Design& design) {
  const auto critical = std::ranges::find(plan.disturbances, design.squeeze.critical, &model::Disturbance::name);
  context.print(fmt::format("design {}: needs {:.2f} N of {:.1f} N usable, for {}", design.id,
                            design.squeeze.required_n, design.squeeze.usable_n, design.squeeze.critical));
  if (critical == plan.disturbances.end()) return;
  const auto& w = critical->wrench;
  context.print(fmt::format("  wrench about the part's origin: force {:.2f} {:.2f} {:.2f} N, torque {:.1f} {:.1f} {:.1f} N mm",
                            w[0], w[1], w[2], w[3], w[4], w[5]));
  const planner::Grasp grasp = planner::grasp_of(design, plan.friction);
  planner::SqueezeSolver solver(grasp);
  const auto forces = solver.balancing_forces_n(planner::turned(critical->wrench, plan.side), plan.friction_model);
  if (!forces) return;
  for (std::size_t i = 0; i < forces->size(); ++i) {
    const planner::PointContact& contact = grasp.contacts[i];
    const model::PinDesign& pin = design.pins[static_cast<std::size_t>(contact.pin)];
    const geometry::Vector3d normal(contact.n_P.x(), contact.n_P.y(), 0);
    const double normal_n = (*forces)[i].dot(normal);
    const double sideways_n = ((*forces)[i] - normal_n * normal).norm();
    context.print(fmt::format("  pin {}-C{}-R{} at z {:7.2f}: pushes {:7.2f} N, friction {:6.2f} N{}",
                              pin.hole.jaw == model::JawSide::Left ? 'L' : 'R', pin.hole.column, pin.hole.row,
                              contact.p_P_mm.z(), normal_n, sideways_n, normal_n < 1e-9 ? "  (idle)" : ""));
  }
}

void run_why(Context& context, Options options) {
  options.planning.top = "all";
  const auto plan = plan_task(context, options.task, options.planning);
  if (!plan) return;
  if (options.design.empty()) {
    context.print(losses_text(*plan));
  } else {
    const auto found = options.design == "best" ? plan->designs.begin()
                                                : std::ranges::find(plan->designs, options.design, &model::Design::id);
    if (found == plan->designs.end()) return context.fail(ExitCode::No, "no design " + options.design);
    print_design(context, *plan, *found);
  }
  if (plan->designs.empty()) context.exit_code = ExitCode::No;
}

}  // namespace

void add_why(CLI::App& app, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("why", "what each phase left out and why; what limits one design");
  command->add_option("TASK", options->task, "task file")->required();
  command->add_option("--design", options->design, "id of a design, or best");
  add_planning_options(*command, options->planning);
  command->callback([&context, options] { run_why(context, *options); });
}

}  // namespace pinjaw::app

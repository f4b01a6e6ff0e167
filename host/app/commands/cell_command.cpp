#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/app/plan_text.hpp"
#include "host/cell/cell_plan.hpp"
#include "host/config/read.hpp"

namespace pinjaw::app {

namespace {

struct CellOptions {
  std::string cell;
  std::string output;
  PlanningOptions planning;
};

std::string summary_of(const cell::CellPlan& plan) {
  std::string text;
  for (const cell::StationPlan& station : plan.stations) {
    text += fmt::format("{}\n{}\n", station.station, funnel_text(station.plan.funnel));
  }
  for (const cell::PairCount& pair : plan.pairs) {
    text += fmt::format("{:>12} pairs {} to {}\n", pair.count, pair.giver, pair.receiver);
  }
  text += fmt::format("{:>12} combinations of all stations\n\n", plan.triples);
  if (plan.designs.empty()) return text + "no combination of designs fits all handoffs";
  constexpr std::size_t kShown = 10;
  text += fmt::format("{:<10} {:>14}  designs\n", "design", "max squeeze N");
  for (std::size_t i = 0; i < std::min(kShown, plan.designs.size()); ++i) {
    const cell::CellDesign& design = plan.designs[i];
    text += fmt::format("{:<10} {:>14.1f} ", design.id, design.max_required_n);
    for (const cell::StationDesign& station : design.stations) {
      text += fmt::format(" {} {}", station.station, station.design.id);
    }
    text += "\n";
  }
  text.pop_back();
  return text;
}

void run_cell(Context& context, const CellOptions& options) {
  if (options.planning.top == "all") {
    return context.fail(ExitCode::Usage,
                        "--top: a cell may have billions of combinations; give a number, not all");
  }
  if (!context.can_write(options.output, options.cell)) return;
  const auto cell = config::read_cell(options.cell);
  if (!cell) return context.fail(cell.error(), "nothing was planned");
  cell::CellOptions cell_options;
  cell_options.plan = options.planning.plan;
  cell_options.top = std::stoul(options.planning.top);
  const auto plan = cell::make_cell_plan(*cell, cell_options, context.progress_sink());
  if (!plan) return context.fail(ExitCode::BadFile, options.cell + ": " + plan.error().message);
  if (!context.deliver(options.output, cell::to_json(*plan), summary_of(*plan))) return;
  if (plan->designs.empty()) context.exit_code = ExitCode::No;
}

}  // namespace

void add_cell(CLI::App& app, Context& context) {
  auto options = std::make_shared<CellOptions>();
  CLI::App* command =
      app.add_subcommand("cell", "designs for every station of a cell that can hand the part over");
  command->add_option("CELL", options->cell, "cell file")->type_name("")->check(file_name())->required();
  command->add_option("-o,--output", options->output, "cell plan JSON; without it the JSON goes to stdout")
      ->type_name("FILE");
  add_planning_options(*command, options->planning);
  command->callback([&context, options] { run_cell(context, *options); });
}

}  // namespace pinjaw::app

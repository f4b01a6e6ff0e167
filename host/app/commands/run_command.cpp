#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/venue.hpp"
#include "host/cell/cell_plan.hpp"
#include "host/cell/read_cell.hpp"
#include "host/config/read.hpp"
#include "host/sequence/run.hpp"
#include "protocol/bus/statistics.hpp"

namespace pinjaw::app {

namespace {

constexpr double kLongestRunS = 24 * 3600.0;

struct RunOptions {
  std::string sequence;
  std::string plan;
  std::string report;
  std::string log;
  bool dry = false;
};

/// The sequence with everything that playing it needs, made ready before any controller is spoken to.
struct Prepared {
  model::Sequence sequence;
  planner::Scene scene;
  cell::CellDesign design;
  sequence::Crew crew;
  std::vector<sequence::StepScript> scripts;
};

/// Designs of the cell from a plan that was written before; nothing where it is no such plan or of another
/// cell.
std::optional<std::vector<cell::CellDesign>> saved_designs(Context& context, const std::string& file,
                                                           const model::Cell& cell,
                                                           const planner::Scene& scene) {
  auto plan = cell::read_cell_plan(file);
  if (!plan) {
    context.fail(plan.error(), "nothing was run");
    return std::nullopt;
  }
  if (const auto fits = cell::made_for(*plan, cell, scene.part.sha256); !fits) {
    context.fail(ExitCode::BadFile, fits.error().message);
    return std::nullopt;
  }
  return std::move(plan->designs);
}

/// The cell's best design, or as many as `pinjaw cell` lists, for `wanted` to be among them.
std::optional<std::vector<cell::CellDesign>> planned_designs(Context& context, const model::Cell& cell,
                                                             const std::string& wanted) {
  cell::CellOptions options;
  if (wanted == "best") options.top = 1;
  auto plan = cell::make_cell_plan(cell, options, context.progress_sink());
  if (!plan) {
    context.fail(ExitCode::BadFile, plan.error().message);
    return std::nullopt;
  }
  return std::move(plan->designs);
}

/// The cell's best design, or the one the sequence names.
std::optional<cell::CellDesign> choose_design(Context& context, const RunOptions& options,
                                              const model::Sequence& sequence, const planner::Scene& scene) {
  const auto designs = options.plan.empty() ? planned_designs(context, sequence.cell, sequence.design)
                                            : saved_designs(context, options.plan, sequence.cell, scene);
  if (!designs) return std::nullopt;
  const auto chosen = sequence.design == "best"
                          ? designs->begin()
                          : std::ranges::find(*designs, sequence.design, &cell::CellDesign::id);
  if (chosen == designs->end()) {
    context.fail(ExitCode::No, designs->empty() ? "no combination of designs fits all handoffs of the cell"
                                                : "no design " + sequence.design + " among the best " +
                                                      std::to_string(designs->size()) +
                                                      "; name the cell plan that lists it with --plan");
    return std::nullopt;
  }
  return *chosen;
}

std::optional<Prepared> prepare(Context& context, const RunOptions& options) {
  const std::string& file = options.sequence;
  auto sequence = config::read_sequence(file);
  if (!sequence) {
    context.fail(sequence.error(), "nothing was run");
    return std::nullopt;
  }
  auto scene = planner::read_scene(sequence->cell.stations.front().task);
  if (!scene) {
    context.fail(ExitCode::BadFile, scene.error().message);
    return std::nullopt;
  }
  auto design = choose_design(context, options, *sequence, *scene);
  if (!design) return std::nullopt;
  auto crew = sequence::Crew::of(sequence->cell, *design, *scene);
  if (!crew) {
    context.fail(ExitCode::BadFile, crew.error().message);
    return std::nullopt;
  }
  auto scripts = sequence::script_of(*sequence, *crew, *scene);
  if (!scripts) {
    context.fail(ExitCode::BadFile, file + ": " + scripts.error().message);
    return std::nullopt;
  }
  return Prepared{std::move(*sequence), std::move(*scene), std::move(*design), std::move(*crew),
                  std::move(*scripts)};
}

bool drops_frames(const model::Sequence& sequence) {
  return std::ranges::any_of(sequence.faults,
                             [](const model::ScriptedFault& fault) { return fault.drop_share > 0; });
}

std::unique_ptr<Venue> open_venue(Context& context, const model::Sequence& sequence,
                                  const std::optional<model::Authentication>& key) {
  if (context.bus == "sim:") {
    if (context.world.empty()) return open_sim_venue(sequence.cell, context.seed, key);
    context.fail(ExitCode::Usage, "--world goes with --bus can:IFACE; sim: has a world of its own");
    return nullptr;
  }
  const auto interface = can_interface(context.bus);
  if (!interface) {
    context.fail(ExitCode::Usage, "no such bus: " + context.bus + "; expected sim: or can:IFACE");
    return nullptr;
  }
  if (drops_frames(sequence)) {
    context.fail(ExitCode::Usage, "the sequence drops frames, which only sim: can do");
    return nullptr;
  }
  auto venue = open_can_venue(*interface, context.world);
  if (!venue) {
    context.fail(ExitCode::Unavailable, venue.error().message);
    return nullptr;
  }
  return std::move(*venue);
}

std::string summary_of(const sequence::RunReport& report) {
  std::string text = fmt::format("{:<32} {:>8} {:>8}  result\n", "step", "from s", "to s");
  for (const sequence::StepReport& step : report.steps) {
    const std::string again = step.tries > 1 ? fmt::format(" (try {})", step.tries) : "";
    text += fmt::format("{:<32} {:>8.2f} {:>8.2f}  {}{}\n", step.step, step.from_s, step.to_s, step.result,
                        again);
  }
  if (report.plant) {
    for (const bench::NodeTruth& node : report.plant->nodes) {
      if (node.passive) continue;
      text += fmt::format("node {} squeezed the part with {:.1f} N at most (limit {:.0f} N)\n", node.node,
                          node.max_squeeze_n, node.limit_n);
    }
    text += fmt::format("the part {}; at every instant at least {} held it\n",
                        report.plant->dropped ? "WAS DROPPED" : "was never dropped",
                        report.plant->min_holders.value_or(0));
  }
  if (report.undersampled)
    text += "undersampled: a drawn load needed more squeeze than the plan's required_n\n";
  text += fmt::format("{} frames", report.bus.frames);
  if (report.bus.load_percent) text += fmt::format(", {:.1f} % bus load", *report.bus.load_percent);
  const std::string troubles = bus::to_text(report.bus.statistics);
  if (!troubles.empty()) text += "; " + troubles;
  return text + fmt::format("\n{}", report.result == sequence::RunResult::Done ? "done" : "aborted");
}

/// A part that was dropped is never a success, whatever the controllers said.
ExitCode code_of(const sequence::RunReport& report, const std::optional<sequence::Trouble>& trouble) {
  if (report.result == sequence::RunResult::Done) {
    return report.plant && report.plant->dropped ? ExitCode::No : ExitCode::Done;
  }
  if (!trouble) return ExitCode::No;  // the host was killed
  switch (*trouble) {
    case sequence::Trouble::ForceLimit:
      return ExitCode::ForceLimit;
    case sequence::Trouble::Silent:
      return ExitCode::Unavailable;
    case sequence::Trouble::Refused:
      return ExitCode::Refused;
    case sequence::Trouble::World:
      break;
  }
  return ExitCode::No;
}

void print_script(const Context& context, const Prepared& prepared) {
  context.print(
      fmt::format("cell design {}, {:.1f} N at most", prepared.design.id, prepared.design.max_required_n));
  for (const sequence::StepScript& script : prepared.scripts) {
    const std::string needs = script.needed_n > 0 ? fmt::format(", needs up to {:.1f} N (planned {:.1f} N)",
                                                                script.needed_n, script.required_n)
                                                  : "";
    context.print(fmt::format("{}: {} actions{}", script.name, script.actions.size(), needs));
  }
}

void run_sequence(Context& context, const RunOptions& options) {
  if (!context.can_write(options.report, options.sequence)) return;
  if (!context.can_write(options.log, options.sequence)) return;
  auto prepared = prepare(context, options);
  if (!prepared) return;
  if (options.dry) return print_script(context, *prepared);
  auto host = context.host_settings(prepared->sequence.cell.authentication);
  if (!host) return;
  std::optional<model::Authentication> authentication;
  if (host->key) authentication = model::Authentication{.key = *host->key, .can_fd = host->can_fd};
  const std::unique_ptr<Venue> venue = open_venue(context, prepared->sequence, authentication);
  if (!venue) return;

  // on a simulated bus the seed settles everything; on a real one each start is a host of its own
  if (context.bus == "sim:") {
    host->epoch = static_cast<std::uint16_t>(context.seed % 0xFFFF + 1);
    host->nonces = context.seed;
  }
  const auto lose = [&venue](double share, double seconds) { venue->lose_frames(share, seconds); };
  sequence::Run run(prepared->sequence, prepared->crew, std::move(prepared->scripts),
                    {&venue->bus(), venue->world(), lose}, *host);
  std::int64_t now_us = 0;
  while (!run.over() && static_cast<double>(now_us) < kLongestRunS * 1e6) {
    now_us = venue->tick_us();
    run.step(now_us);
  }
  sequence::RunReport report = run.report();
  report.design = prepared->design.id;
  report.bus.load_percent = venue->load_percent();
  if (!options.report.empty() && !context.write_result(options.report, sequence::to_json(report))) return;
  if (!options.log.empty() && !context.write_result(options.log, venue->log())) return;
  context.print(context.json ? sequence::to_json(report) : summary_of(report));
  context.exit_code = code_of(report, run.trouble());
}

}  // namespace

void add_run(CLI::App& app, Context& context) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "play a scripted sequence on the controllers of a cell");
  command->add_option("SEQUENCE", options->sequence, "sequence file")
      ->type_name("")
      ->check(file_name())
      ->required();
  command
      ->add_option("--plan", options->plan,
                   "cell plan of `pinjaw cell -o`; without it the cell is planned anew")
      ->type_name("FILE");
  command->add_option("--report", options->report, "run report JSON")->type_name("FILE");
  command->add_option("--log", options->log, "every frame, as candump writes them")->type_name("FILE");
  command->add_flag("--dry", options->dry, "plan and check everything, speak to nobody");
  command->callback([&context, options] { run_sequence(context, *options); });
}

}  // namespace pinjaw::app

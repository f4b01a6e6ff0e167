#include "host/cell/cell_plan.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <optional>

#include "host/base/sha256.hpp"
#include "host/cell/join.hpp"
#include "host/cell/pallet.hpp"

namespace pinjaw::cell {
namespace {

/// A station's plan and the lowest z of the part as its gripper sees it.
struct Planned {
  planner::Plan plan;
  double part_low_mm = 0;
};

base::Expected<Planned> plan_station(const model::Cell& cell, const model::Station& station,
                                     const CellOptions& options, const planner::ProgressSink& progress) {
  model::Task task = station.task;
  task.part = cell.part;
  const auto scene = planner::read_scene(task);
  if (!scene) return tl::unexpected(scene.error());
  planner::PlanOptions all = options.plan;
  all.top = 0;
  planner::ProgressSink named;
  if (progress) {
    named = [&](const planner::Progress& at) {
      progress({station.name + ": " + at.phase, at.done, at.total});
    };
  }
  auto plan = station.grips ? planner::make_plan(task, *scene, all, named)
                            : make_pallet_plan(task, *scene, all, named);
  if (!plan) return tl::unexpected(plan.error());
  return Planned{std::move(*plan), scene->turned.surface.z_range_mm().lo};
}

std::optional<std::size_t> station_index(const model::Cell& cell, const std::string& name) {
  for (std::size_t i = 0; i < cell.stations.size(); ++i) {
    if (cell.stations[i].name == name) return i;
  }
  return std::nullopt;
}

base::Expected<std::vector<StationPair>> handoffs_of(const model::Cell& cell) {
  std::vector<StationPair> handoffs;
  for (const model::Handoff& handoff : cell.handoffs) {
    const auto giver = station_index(cell, handoff.giver);
    const auto receiver = station_index(cell, handoff.receiver);
    if (!giver || !receiver) {
      return base::failure(
          fmt::format("cell {}: handoff [{}, {}] names a station that the cell does not have", cell.name,
                      handoff.giver, handoff.receiver));
    }
    handoffs.push_back({*giver, *receiver});
  }
  return handoffs;
}

base::Expected<HandoffTree> tree_of(const model::Cell& cell, const References& references) {
  const auto handoffs = handoffs_of(cell);
  if (!handoffs) return tl::unexpected(handoffs.error());
  const TreeOutcome outcome =
      handoff_tree(cell.stations.size(), *handoffs, {references.theta, references.offset});
  if (outcome.fault == TreeFault::NotConnected) {
    return base::failure(fmt::format("cell {}: its handoffs do not connect all stations", cell.name));
  }
  if (outcome.fault == TreeFault::Cycle) {
    return base::failure(fmt::format(
        "cell {}: its handoffs form a ring or list one twice; a part goes back the way it came", cell.name));
  }
  return outcome.tree;
}

References references_of(const model::Cell& cell) {
  std::vector<PlanBounds> bounds;
  for (const model::Station& station : cell.stations) bounds.emplace_back(station.task.side, station.adjust);
  return references_of(std::span<const PlanBounds>(bounds));
}

std::size_t handoffs_at(const model::Cell& cell, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::count_if(cell.handoffs, [&](const model::Handoff& handoff) {
    return handoff.giver == name || handoff.receiver == name;
  }));
}

std::string id_of(const CellDesign& design) {
  std::string text;
  for (const StationDesign& station : design.stations) {
    text += fmt::format("{} {} {} {:.6f};", station.station, station.design.id,
                        station.design.pins.front().hole.row, station.design.jaw_separation_mm);
  }
  constexpr std::size_t kDigits = 8;  // as a station's design
  return base::sha256(text).substr(0, kDigits);
}

CellDesign design_of(const model::Cell& cell, const std::vector<StationPlan>& plans,
                     const std::vector<StationSetups>& setups, const References& references,
                     const Choice& choice) {
  const auto setup = [&](std::size_t i) -> const Setup& {
    return setups[i].setup(choice.stations[i].design, choice.stations[i].stance);
  };
  const geometry::Pose2 X_HP =
      part_in_handoff_frame(setup(references.theta).hold, setups[references.theta].bounds,
                            setup(references.offset).hold, setups[references.offset].bounds);
  CellDesign design;
  design.max_required_n = choice.score_n;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const model::Station& station = cell.stations[i];
    const model::Design& own = plans[i].plan.designs[choice.stations[i].design];
    design.stations.push_back({station.name, planner::moved(own, station.task.kit, setup(i).stance),
                               adjustment_for(setup(i).hold, station.task.side, X_HP)});
  }
  design.id = id_of(design);
  return design;
}

}  // namespace

base::Expected<CellPlan> make_cell_plan(const model::Cell& cell, const CellOptions& options,
                                        const planner::ProgressSink& progress) {
  std::optional<tbb::global_control> limit;
  if (options.plan.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(options.plan.threads));
  }
  const References references = references_of(cell);
  const auto tree = tree_of(cell, references);
  if (!tree) return tl::unexpected(tree.error());

  CellPlan plan;
  plan.cell = cell.name;
  std::vector<StationSetups> setups;
  for (const model::Station& station : cell.stations) {
    auto planned = plan_station(cell, station, options, progress);
    if (!planned) return tl::unexpected(planned.error());
    const bool chooses = handoffs_at(cell, station.name) == 1 && setups.size() != references.offset;
    setups.push_back(setups_of(station, planned->plan.designs, planned->part_low_mm,
                               chooses ? Stances::All : Stances::OwnOnly));
    plan.stations.push_back({station.name, std::move(planned->plan), station.grips});
  }

  std::vector<Partners> partners;
  plan.pairs.resize(cell.handoffs.size());
  for (const HandoffTree::Link& link : tree->links) {
    if (progress)
      progress({"pairs", static_cast<std::int64_t>(partners.size()),
                static_cast<std::int64_t>(tree->links.size())});
    partners.push_back(partners_of(setups[link.near], setups[link.far]));
    const model::Handoff& handoff = cell.handoffs[link.handoff];
    plan.pairs[link.handoff] = {handoff.giver, handoff.receiver, count(partners.back())};
  }
  if (progress) progress({"join", 0, 0});
  const JoinResult joined = join({&setups, &*tree, &partners, references}, options.top);
  plan.triples = joined.count;
  for (const Choice& choice : joined.best) {
    plan.designs.push_back(design_of(cell, plan.stations, setups, references, choice));
  }
  return plan;
}

}  // namespace pinjaw::cell

#include <nlohmann/json.hpp>
#include <numbers>

#include "host/cell/cell_plan.hpp"
#include "host/planner/plan/json_values.hpp"

namespace pinjaw::cell {
namespace {

using nlohmann::ordered_json;

ordered_json part_json(const planner::PartFacts& part) {
  return {{"file", part.file}, {"sha256", part.sha256}, {"up", planner::vector_json(part.up)}};
}

/// The funnel, and what the station's designs were made for.
ordered_json station_json(const StationPlan& station) {
  ordered_json entry = planner::funnel_json(station.plan.funnel);
  entry["task"] = station.plan.task;
  entry["kit"] = planner::kit_json(station.plan.kit);
  entry["friction"] = planner::friction_json({station.plan.friction, station.plan.friction_model});
  entry["side"] = station.plan.side == model::Side::Below ? "below" : "above";
  entry["grips"] = station.grips;
  return entry;
}

ordered_json design_json(const CellDesign& design) {
  ordered_json stations = ordered_json::object();
  for (const StationDesign& station : design.stations) {
    ordered_json entry = planner::design_json(station.design);
    entry["adjust"] = {{"x_mm", station.adjust.offset_mm.x()},
                       {"y_mm", station.adjust.offset_mm.y()},
                       {"theta_deg", station.adjust.theta_rad * 180 / std::numbers::pi}};
    stations[station.station] = std::move(entry);
  }
  return {{"id", design.id}, {"stations", std::move(stations)}, {"max_required_n", design.max_required_n}};
}

}  // namespace

std::string to_json(const CellPlan& plan) {
  ordered_json document;
  document["format"] = "pinjaw-cell/1";
  document["cell"] = plan.cell;
  if (!plan.stations.empty()) document["part"] = part_json(plan.stations.front().plan.part);
  document["stations"] = ordered_json::object();
  for (const StationPlan& station : plan.stations) {
    document["stations"][station.station] = station_json(station);
  }
  document["pairs"] = ordered_json::array();
  for (const PairCount& pair : plan.pairs) {
    document["pairs"].push_back({{"giver", pair.giver}, {"receiver", pair.receiver}, {"count", pair.count}});
  }
  document["triples"] = plan.triples;
  document["designs"] = ordered_json::array();
  for (const CellDesign& design : plan.designs) document["designs"].push_back(design_json(design));
  return document.dump(1) + "\n";
}

}  // namespace pinjaw::cell

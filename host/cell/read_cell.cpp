#include "host/cell/read_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "host/base/json_document.hpp"
#include "host/base/json_fields.hpp"
#include "host/base/json_places.hpp"

namespace pinjaw::cell {
namespace {

using base::JsonField;

constexpr const char* kFormat = "pinjaw-cell/1";
constexpr std::size_t kGripPins = 4;
constexpr std::size_t kPalletPins = 3;

StationFacts read_facts(const std::string& station, const JsonField& field) {
  StationFacts facts;
  facts.station = station;
  facts.task = field.text("task");
  facts.kit = planner::read_kit_json(field.at("kit"));
  facts.friction = planner::read_friction(field.at("friction"));
  facts.side = field.at("side").one_of({"below", "above"}) == 0 ? model::Side::Below : model::Side::Above;
  facts.grips = field.at("grips").truth();
  return facts;
}

StationDesign read_station(const StationFacts& facts, const JsonField& field) {
  const JsonField adjust = field.at("adjust");
  StationDesign station;
  station.station = facts.station;
  station.design = planner::read_design(field);
  station.adjust.theta_rad = adjust.number("theta_deg") * std::numbers::pi / 180;
  station.adjust.offset_mm = {adjust.number("x_mm"), adjust.number("y_mm")};
  const std::size_t pins = facts.grips ? kGripPins : kPalletPins;
  if (station.design.pins.size() != pins) field.at("pins").mistake(fmt::format("expected {} pins", pins));
  return station;
}

}  // namespace

base::Checked<SavedCellPlan> read_cell_plan(const std::filesystem::path& path) {
  const auto document = base::read_json_document(path, kFormat);
  if (!document) return tl::unexpected(document.error());

  base::Diagnostics mistakes;
  const JsonField top(&document->value, "", &document->name, &mistakes);
  SavedCellPlan plan;
  plan.file = document->name;
  plan.cell = top.text("cell");
  plan.part_file = top.at("part").text("file");
  plan.part_sha256 = top.at("part").text("sha256");
  plan.up = planner::read_vector3(top.at("part").at("up"));
  const JsonField stations = top.at("stations");
  for (const std::string& station : stations.keys()) {
    plan.stations.push_back(read_facts(station, stations.at(station)));
  }
  for (const JsonField& pair : top.at("pairs").list()) {
    plan.handoffs.push_back({pair.text("giver"), pair.text("receiver")});
  }
  for (const JsonField& entry : top.at("designs").list()) {
    CellDesign design;
    design.id = entry.text("id");
    design.max_required_n = entry.number("max_required_n");
    for (const StationFacts& facts : plan.stations) {
      design.stations.push_back(read_station(facts, entry.at("stations").at(facts.station)));
    }
    plan.designs.push_back(std::move(design));
  }
  if (!mistakes.empty()) return tl::unexpected(base::placed_in_json(mistakes, document->text));
  return plan;
}

base::Expected<void> made_for(const SavedCellPlan& plan, const model::Cell& cell,
                              const std::string& part_sha256) {
  const auto differs = [&](const std::string& what) {
    return base::failure(fmt::format("{}: {}; plan the cell again", plan.file, what));
  };
  if (plan.part_sha256 != part_sha256)
    return differs("it was made for another part than " + cell.part.file.string());
  if (!plan.up.isApprox(cell.part.up)) return differs("the part was turned up in another way then");
  for (const model::Station& station : cell.stations) {
    const auto facts = std::ranges::find(plan.stations, station.name, &StationFacts::station);
    if (facts == plan.stations.end()) return differs("it has no station " + station.name);
    if (facts->kit.sha256 != station.task.kit.sha256) {
      return differs(fmt::format("station {} has another kit now than {} was then", station.name,
                                 station.task.kit.name));
    }
    if (facts->side != station.task.side || facts->grips != station.grips) {
      return differs("station " + station.name + " took hold of the part in another way then");
    }
  }
  const auto same = [](const model::Handoff& one, const model::Handoff& other) {
    return one.giver == other.giver && one.receiver == other.receiver;
  };
  if (!std::ranges::equal(plan.handoffs, cell.handoffs, same)) return differs("it has other handoffs");
  if (plan.stations.size() != cell.stations.size())
    return differs("it has other stations than cell " + cell.name);
  return {};
}

}  // namespace pinjaw::cell

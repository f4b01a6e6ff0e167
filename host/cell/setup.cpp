#include "host/cell/setup.hpp"

namespace pinjaw::cell {

StationSetups setups_of(const model::Station& station, const std::vector<model::Design>& designs,
                        double part_low_mm, Stances stances) {
  const model::Kit& kit = station.task.kit;
  const planner::Holder holder{&kit, station.task.side, station.grips};
  StationSetups result;
  result.name = station.name;
  result.grips = station.grips;
  result.side = station.task.side;
  result.bounds = PlanBounds(station.task.side, station.adjust);
  for (const model::Design& design : designs) {
    result.required_n.push_back(station.grips ? design.squeeze.required_n : 0);
    result.first.push_back(static_cast<std::uint32_t>(result.setups.size()));
    for (const planner::Stance& stance : planner::stances_of(design, kit)) {
      result.setups.push_back(
          {stance, PlanHold({station.task.side, stance.part_pose}),
           planner::fingers_of(planner::moved(design, kit, stance), holder, part_low_mm)});
      if (stances == Stances::OwnOnly) break;
    }
  }
  result.first.push_back(static_cast<std::uint32_t>(result.setups.size()));
  return result;
}

}  // namespace pinjaw::cell

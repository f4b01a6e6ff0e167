#include "host/cell/setup.hpp"

#include <algorithm>

namespace pinjaw::cell {
namespace {

std::uint32_t least_opening(const std::vector<planner::Stance>& stances) {
  const auto travel_mm = [](const planner::Stance& stance) {
    return stance.jaw_open_mm - stance.jaw_separation_mm;
  };
  return static_cast<std::uint32_t>(std::ranges::min_element(stances, {}, travel_mm) - stances.begin());
}

}  // namespace

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
    std::vector<planner::Stance> taken = planner::stances_of(design, kit);
    if (stances == Stances::OwnOnly) taken.resize(1);
    result.opens_least.push_back(least_opening(taken));
    for (const planner::Stance& stance : taken) {
      result.setups.push_back(
          {stance, PlanHold({station.task.side, stance.part_pose}),
           planner::fingers_of(planner::moved(design, kit, stance), holder, part_low_mm)});
    }
  }
  result.first.push_back(static_cast<std::uint32_t>(result.setups.size()));
  return result;
}

}  // namespace pinjaw::cell

#include <algorithm>
#include <cmath>
#include <map>

#include "host/planner/why/miss_search.hpp"

namespace pinjaw::planner {
namespace {

/// Why one pin has no height, and by how much.
struct Shortfall {
  HeightLoss reason = HeightLoss::NoEngagement;
  std::optional<NearMiss::Gap> gap;
};

Shortfall shortfall(const geometry::Surface& part, const model::PinStock& pins, double plate_top_mm,
                    const Foot& foot, HeightLoss reason) {
  const auto range = top_range(part, pins, foot);
  if (!range || reason == HeightLoss::NoSurfaceAtFoot) return {reason, std::nullopt};
  const double longest_mm = range->top_mm.hi - plate_top_mm;
  switch (reason) {
    case HeightLoss::NoEngagement:
      return {reason, NearMiss::Gap{range->top_mm.hi - range->z_edge_mm, pins.min_engagement_mm}};
    case HeightLoss::NoStockLength:
      return {reason, NearMiss::Gap{pins.lengths_mm.front(), longest_mm}};
    case HeightLoss::StockTooShort: {
      const auto above = std::ranges::upper_bound(pins.lengths_mm, longest_mm);
      return {reason, NearMiss::Gap{*std::prev(above), range->top_mm.lo - plate_top_mm}};
    }
    case HeightLoss::NoSurfaceAtFoot:
      break;
  }
  return {reason, std::nullopt};
}

double size(const NearMiss::Gap& gap) {
  return std::abs(gap.needs - gap.has);
}

/// The worst pin of a fixture whose failing pins all fail for one reason; nothing where their reasons differ.
std::optional<Shortfall> worst_pin(const model::Kit& kit, const geometry::Surface& part, double plate_top_mm,
                                   const PlanarFixture& fixture) {
  std::optional<Shortfall> worst;
  for (const PlanarPin& pin : fixture.pins) {
    const Foot foot{pin.p_PFoot_mm, pin.n_P};
    const auto height = pin_height(part, kit.pins, plate_top_mm, foot);
    if (height) continue;
    const Shortfall of_pin = shortfall(part, kit.pins, plate_top_mm, foot, height.error());
    if (worst && worst->reason != of_pin.reason) return std::nullopt;
    if (!worst || !of_pin.gap || (worst->gap && size(*of_pin.gap) > size(*worst->gap))) worst = of_pin;
  }
  return worst;
}

const char* quantity_of(HeightLoss reason) {
  switch (reason) {
    case HeightLoss::NoEngagement:
      return "room above the edge";
    case HeightLoss::NoStockLength:
      return "shortest pin";
    case HeightLoss::StockTooShort:
      return "longest pin that fits";
    case HeightLoss::NoSurfaceAtFoot:
      return "part beside the foot";
  }
  return "?";
}

}  // namespace

std::vector<NearMiss> standing_misses(const model::Task& task, const Scene& scene,
                                      const std::vector<LostStanding>& lost) {
  const double plate_mm = plate_top_mm(task.kit, scene.turned.surface, scene.attached);
  std::map<HeightLoss, NearMiss> nearest;
  for (const LostStanding& of : lost) {
    NearMiss& miss = nearest[of.reason];
    miss.phase = "heights";
    miss.reason = to_string(of.reason);
    miss.quantity = quantity_of(of.reason);
    ++miss.count;
    const auto worst = worst_pin(task.kit, scene.turned.surface, plate_mm, of.fixture);
    if (!worst || !worst->gap || (miss.gap && size(*worst->gap) >= size(*miss.gap))) continue;
    miss.gap = worst->gap;
    miss.where = feet_of(of.fixture);
  }
  std::vector<NearMiss> misses;
  for (auto& [reason, miss] : nearest) misses.push_back(std::move(miss));
  return misses;
}

}  // namespace pinjaw::planner

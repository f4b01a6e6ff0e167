#include "host/planner/loading/loading.hpp"

#include <optional>
#include <vector>

#include "host/planner/loading/path.hpp"
#include "host/planner/planar/column_shifts.hpp"

namespace pinjaw::planner {
namespace {

model::Design design_of(const PlanarFixture& fixture, std::span<const PinToLoad> pins,
                        const PlacedFixture& placed) {
  model::Design design;
  design.split = fixture.split;
  design.jaw_separation_mm = placed.jaw_separation_mm;
  design.closure_margin = fixture.closure_margin;
  design.part_pose = placed.part_pose;
  for (const PinToLoad& pin : pins) {
    const PlanarPin& planar = fixture.pins[pin.pin];
    design.pins.push_back({.hole = placed.holes[pin.pin],
                           .length_mm = pin.length_mm,
                           .top_z_mm = pin.top_mm,
                           .contact_z_mm = pin.contact_z_mm,
                           .contact_mm = placed.part_pose * planar.p_PFoot_mm,
                           .normal = placed.part_pose.turned(planar.n_P),
                           .foot_margin_mm = planar.foot_margin_mm,
                           .feature = planar.feature});
  }
  return design;
}

}  // namespace

std::string_view to_string(LoadingLoss loss) {
  switch (loss) {
    case LoadingLoss::NoShift:
      return "no_shift";
    case LoadingLoss::NoOpening:
      return "no_opening";
    case LoadingLoss::PinSweep:
      return "pin_sweep";
    case LoadingLoss::PinMeetsObstacle:
      return "pin_meets_obstacle";
    case LoadingLoss::PlateMeetsObstacle:
      return "plate_meets_obstacle";
  }
  return "?";
}

base::Expected<model::Design, LoadingLoss> load(const PlanarFixture& fixture, std::span<const PinToLoad> pins,
                                                const model::Kit& kit, const Surroundings& surroundings,
                                                const LoadingOptions& options) {
  const std::vector<ColumnShift> shifts = column_shifts(kit, fixture);
  if (shifts.empty() || row_extent(fixture) >= kit.grid.rows) return tl::unexpected(LoadingLoss::NoShift);
  const int row_shift = centred_row_shift(kit, fixture);
  Path path(fixture, pins, kit, surroundings, options);
  std::optional<LoadingLoss> least_shift_loss;
  std::vector<const ColumnShift*> load;  // largest shift, and so widest opening, first
  for (auto shift = shifts.rbegin(); shift != shifts.rend(); ++shift) {
    least_shift_loss = path.loss_at(place(kit, fixture, *shift, row_shift));
    if (!least_shift_loss) load.push_back(&*shift);
  }
  if (load.empty()) return tl::unexpected(*least_shift_loss);

  const ColumnShift& least = *load.back();
  load.pop_back();
  model::Design design = design_of(fixture, pins, place(kit, fixture, least, row_shift));
  design.jaw_open_mm = options.motion == JawMotion::Closes
                           ? model::open_separation_mm(kit.jaws, least.jaw_separation_mm)
                           : least.jaw_separation_mm;
  for (auto other = load.rbegin(); other != load.rend(); ++other)
    design.alternatives.push_back({(*other)->left, (*other)->right, (*other)->jaw_separation_mm});
  return design;
}

}  // namespace pinjaw::planner

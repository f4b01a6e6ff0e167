#include "host/planner/interference/fingers.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

namespace pinjaw::planner {
namespace {

using model::JawSide;
using model::Side;

/// From the gripper's frame to the part frame, which a gripper from above sees turned by pi about y.
class ToPart {
 public:
  ToPart(const geometry::Pose2& X_GP, Side side) : X_PG_(X_GP.inverse()), above_(side == Side::Above) {}

  [[nodiscard]] Vector2d point(const Vector2d& p_GQ_mm) const { return mirrored(X_PG_ * p_GQ_mm); }
  [[nodiscard]] Vector2d vector(const Vector2d& v_G) const { return mirrored(X_PG_.turned(v_G)); }
  [[nodiscard]] Interval z(const Interval& z_mm) const {
    return above_ ? Interval{-z_mm.hi, -z_mm.lo} : z_mm;
  }

 private:
  [[nodiscard]] Vector2d mirrored(const Vector2d& v) const { return above_ ? Vector2d(-v.x(), v.y()) : v; }

  geometry::Pose2 X_PG_;
  bool above_;
};

Plate plate_of(const model::Design& design, const model::JawBody& solid, const ToPart& to_part, JawSide jaw) {
  const double outwards = jaw == JawSide::Left ? -1 : 1;
  const Vector2d middle_mm(
      outwards * (design.jaw_separation_mm / 2 + std::midpoint(solid.x_mm.lo, solid.x_mm.hi)),
      std::midpoint(solid.y_mm.lo, solid.y_mm.hi));
  const double opening_mm = (design.jaw_open_mm - design.jaw_separation_mm) / 2;
  const double plate_top_mm = design.pins.front().top_z_mm - design.pins.front().length_mm;
  return {.closed = {.center_mm = to_part.point(middle_mm),
                     .direction = to_part.vector(Vector2d::UnitX()),
                     .half_mm = {solid.x_mm.length() / 2, solid.y_mm.length() / 2}},
          .opening_mm = to_part.vector({outwards * opening_mm, 0}),
          .z_mm = to_part.z({plate_top_mm + solid.z_mm.lo, plate_top_mm + solid.z_mm.hi})};
}

Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

}  // namespace

FingerSet fingers_of(const model::Design& design, const Holder& holder, double part_low_mm) {
  assert(!design.pins.empty() && design.pins.size() <= FingerSet::kMaxPins);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const model::Kit& kit = *holder.kit;
  const ToPart to_part(design.part_pose, holder.side);
  FingerSet set;
  set.side = holder.side;
  set.opens = holder.grips;
  set.radius_mm = kit.pins.radius_mm;
  set.clearance_mm = kit.pins.clearance_mm;
  set.pins_z_mm = {kInfinity, -kInfinity};
  set.plates_z_mm = {kInfinity, -kInfinity};
  const double open_mm = holder.grips ? design.jaw_open_mm : design.jaw_separation_mm;
  for (const model::PinDesign& pin : design.pins) {
    Finger& finger = set.pins[static_cast<std::size_t>(set.pin_count++)];
    finger.closed_mm = to_part.point(model::p_GHole_mm(kit.grid, pin.hole, design.jaw_separation_mm));
    finger.open_mm = to_part.point(model::p_GHole_mm(kit.grid, pin.hole, open_mm));
    finger.z_mm = to_part.z({pin.top_z_mm - pin.length_mm, pin.top_z_mm});
    set.pins_z_mm = hull(set.pins_z_mm, finger.z_mm);
  }
  if (!holder.grips) {
    set.floor_z_mm = to_part.z({part_low_mm, part_low_mm}).lo;
    return set;
  }
  for (const model::JawBody& solid : model::jaw_solids(kit)) {
    for (const JawSide jaw : {JawSide::Left, JawSide::Right}) {
      Plate& plate = set.plates[static_cast<std::size_t>(set.plate_count++)];
      plate = plate_of(design, solid, to_part, jaw);
      set.plates_z_mm = hull(set.plates_z_mm, plate.z_mm);
    }
  }
  return set;
}

}  // namespace pinjaw::planner

#pragma once

#include <array>
#include <optional>

#include "host/geometry/convex.hpp"
#include "host/model/design.hpp"
#include "host/model/task.hpp"

/// Phase 6: can one gripper hand the part to another (BB 3.6)?
namespace pinjaw::planner {

using geometry::Interval;
using geometry::Vector2d;

/// One pin as the other gripper meets it. Frame: the part frame, not turned, in which both grippers hold the
/// part.
struct Finger {
  Vector2d closed_mm = Vector2d::Zero();
  Vector2d open_mm = Vector2d::Zero();
  Interval z_mm;  ///< from the plate to the tip, whichever is higher
};

/// One grid plate or jaw body in the same frame; it moves by `opening_mm` with its pins.
struct Plate {
  geometry::Rectangle closed;
  Vector2d opening_mm = Vector2d::Zero();
  Interval z_mm;
};

/// All that phase 6 needs of one design: compact, made once, then compared with millions of others.
struct FingerSet {
  static constexpr int kMaxPins = 4;
  static constexpr int kMaxPlates = 2 * (1 + model::Jaws::kMaxBodies);

  model::Side side = model::Side::Below;
  bool opens = true;  ///< false: a pallet, which never opens
  double radius_mm = 0;
  double clearance_mm = 0;
  int pin_count = 0;
  int plate_count = 0;  ///< none for a pallet: the floor stands for its plate
  std::array<Finger, kMaxPins> pins;
  std::array<Plate, kMaxPlates> plates;
  std::optional<double> floor_z_mm;  ///< the plane on which the part rests, for a pallet or fixture
  Interval pins_z_mm;                ///< of all pins
  Interval plates_z_mm;              ///< of all plates and bodies
};

/// What a design is, beside its pins: its gripper.
struct Holder {
  const model::Kit* kit = nullptr;  ///< not null
  model::Side side = model::Side::Below;
  bool grips = true;  ///< false: a pallet: three pins on one jaw, no second plate, the part rests
};

/// The fingers of `design`. `part_low_mm`: lowest z of the part turned by the holder's side.
FingerSet fingers_of(const model::Design& design, const Holder& holder, double part_low_mm);

}  // namespace pinjaw::planner

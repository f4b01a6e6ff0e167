#pragma once

#include "host/base/random.hpp"
#include "host/model/design.hpp"
#include "host/model/kit.hpp"

namespace pinjaw::planner::testing {

inline model::Kit kit() {
  model::Kit kit;
  kit.grid = {.spacing_mm = 10, .columns = 3, .rows = 5, .edge_offset_mm = 5};
  kit.pins = {
      .radius_mm = 2.5, .lengths_mm = {}, .min_engagement_mm = 1, .protrusion_mm = 1, .clearance_mm = 0.2};
  kit.jaws.separation_mm = {0, 40};
  kit.jaws.plate_gap_mm = 2;
  return kit;
}

/// How a design of the tests differs from the plain one.
struct Grip {
  geometry::Pose2 part_pose = {};
  double part_low_mm = 0;  ///< in the turned part frame
  double top_mm = 15;      ///< of the pins, above part_low_mm
  double separation_mm = 15;
};

/// Two pins a jaw in the plates' middle rows, the innermost columns.
inline model::Design design_of(const Grip& grip) {
  model::Design design;
  design.jaw_separation_mm = grip.separation_mm;
  design.jaw_open_mm = model::open_separation_mm(kit().jaws, grip.separation_mm);
  design.part_pose = grip.part_pose;
  for (const model::JawSide jaw : {model::JawSide::Left, model::JawSide::Right}) {
    for (const int row : {1, 3}) {
      model::PinDesign pin;
      pin.hole = {jaw, 0, row};
      pin.top_z_mm = grip.part_low_mm + grip.top_mm;
      pin.length_mm = grip.top_mm + kit().jaws.plate_gap_mm;
      pin.normal = {jaw == model::JawSide::Left ? 1.0 : -1.0, 0};
      pin.contact_mm = model::p_GHole_mm(kit().grid, pin.hole, grip.separation_mm) + 2.5 * pin.normal;
      design.pins.push_back(pin);
    }
  }
  return design;
}

/// Any pose, height, holes and separation: nothing that holds a part, but fingers in every relation to each
/// other.
inline model::Design random_design(base::Random& random, double part_low_mm, double height_mm) {
  Grip grip;
  grip.part_pose = {random.uniform(-3, 3), {random.uniform(-8, 8), random.uniform(-8, 8)}};
  grip.part_low_mm = part_low_mm;
  grip.separation_mm = random.uniform(0, 38);
  model::Design design = design_of(grip);
  for (model::PinDesign& pin : design.pins) {
    pin.hole.column = static_cast<int>(random.uniform(0, 3));
    pin.hole.row = static_cast<int>(random.uniform(0, 5));
    pin.length_mm = 2 + random.uniform(0.2, 0.9) * height_mm;
    pin.top_z_mm = part_low_mm - 2 + pin.length_mm;
  }
  return design;
}

}  // namespace pinjaw::planner::testing

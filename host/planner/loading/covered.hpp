#pragma once

#include "host/geometry/surface.hpp"
#include "host/model/kit.hpp"

/// What a gripper covers on its way, in the part frame turned by the task's side, where closed pins stand
/// still.
namespace pinjaw::planner {

/// -1 for the left jaw, 1 for the right: the way a jaw opens along the gripper's x.
double sign_of_outwards(model::JawSide jaw);

/// A jaw of a gripper that is closed on a part.
struct ClosedJaw {
  model::JawSide side = model::JawSide::Left;
  double separation_mm = 0;
  geometry::Pose2 part_pose;  ///< X_GP of the turned part
};

/// What the plate or a body of a jaw covers in plan while the jaw moves over `opening_mm`, counted outwards
/// from closed, grown by `grown_mm` on all sides.
geometry::Rectangle covered(const model::JawBody& solid, const ClosedJaw& jaw,
                            const geometry::Interval& opening_mm, double grown_mm);

/// Between which heights it does: its top a hair lower, since what lies on a plate touches it and does not
/// meet it.
geometry::Slab heights_of(const model::JawBody& solid, double plate_top_mm);

}  // namespace pinjaw::planner

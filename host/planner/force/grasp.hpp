#pragma once

#include <vector>

#include "host/model/design.hpp"

namespace pinjaw::planner {

using geometry::Vector2d;
using geometry::Vector3d;

/// One point where a pin touches the part: a hard finger, which passes no torque about its normal (BB 3.5.2).
/// Frame: the part turned by the task's side (P).
struct PointContact {
  Vector3d p_P_mm = Vector3d::Zero();
  Vector2d n_P = Vector2d::UnitX();  ///< unit and horizontal, from the pin into the part
  model::JawSide jaw = model::JawSide::Left;
  int pin = 0;  ///< index of the pin in its design
};

/// All that the force phase needs of a design: its point contacts, the closing axis and the friction.
struct Grasp {
  static constexpr int kMaxContacts = 8;  ///< four pins, two points each (BB 3.5.2)

  std::vector<PointContact> contacts;  ///< 1 to kMaxContacts
  Vector2d x_P = Vector2d::UnitX();    ///< the gripper's +x in the turned part frame, unit
  double mu = 0;                       ///< static friction coefficient, at least 0
};

/// The grasp of a design with friction coefficient `mu`. A pin whose contact interval has a length touches at
/// both its ends (BB 3.5.2), any other pin at one point.
Grasp grasp_of(const model::Design& design, double mu);

/// Share of a contact's force along `direction` that closes the gripper: +x for the left jaw, -x for the
/// right (BB's sigma).
double squeeze_share(const Grasp& grasp, const PointContact& contact, const Vector3d& force_P);

}  // namespace pinjaw::planner

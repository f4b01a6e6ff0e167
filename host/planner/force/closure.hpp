#pragma once

#include <optional>
#include <vector>

#include "host/planner/force/grasp.hpp"

namespace pinjaw::planner {

/// The first contact that cannot be closed by sliding: |n_x| <= mu |n_y| in the gripper's axes, or a normal
/// against its own jaw's motion. With none, every ray of every cone has a positive squeeze, so F_sq is
/// bounded below.
std::optional<PointContact> jamming_contact(const Grasp& grasp);

/// The jaw whose contacts alone are in planar frictional force closure: wedging (BB 3.5.2, fig. 8). Full mu,
/// heights ignored.
std::optional<model::JawSide> wedging_jaw(const Grasp& grasp);

/// A point and a direction in plan view.
struct PlanarContact {
  Vector2d p_mm = Vector2d::Zero();
  Vector2d normal = Vector2d::UnitX();  ///< unit
};

/// Whether point contacts with friction `mu` are in planar force closure: their forces can balance every
/// planar wrench. Two contacts by Nguyen's segment test [Ngu88], more by spanning in (force, torque).
bool planar_force_closure(const std::vector<PlanarContact>& contacts, double mu);

}  // namespace pinjaw::planner

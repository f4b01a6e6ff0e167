#pragma once

#include <array>
#include <optional>

#include "host/model/design.hpp"
#include "host/model/feature.hpp"
#include "host/model/kit.hpp"

/// A slow vise: closes its jaws on a part until nothing gives, by minimising the separation under the
/// condition that no pin is inside a feature. It knows neither contact equations nor their Jacobian.
namespace pinjaw::planner {

/// What each pin is off: its axis in the gripper frame, its radius, and its feature outwards.
struct PinOff {
  geometry::Vector2d axis_mm = geometry::Vector2d::Zero();
  double radius_mm = 0;
  double feature_mm = 0;
};

struct Vised {
  geometry::Pose2 part_pose;
  double separation_mm = 0;
};

/// Where the part ends, from the design's own pose with the jaws a little open. Nothing where the solver does
/// not settle.
std::optional<Vised> closed_by_vise(const model::Design& design, const std::vector<model::Feature>& features,
                                    const model::Kit& kit, const std::array<PinOff, 4>& off);

}  // namespace pinjaw::planner

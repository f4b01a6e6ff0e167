#pragma once

#include <span>
#include <vector>

#include "host/model/cell.hpp"
#include "host/planner/interference/adjustment.hpp"

namespace pinjaw::cell {

using geometry::Vector2d;

/// A station's way of holding the part, as a gripper from below would say it: turning a gripper by pi about y
/// mirrors x and the sense of angles, so that all stations can be compared in one plan view (DESIGN 2).
struct PlanHold {
  geometry::Pose2 X_GP;  ///< part in the mirrored gripper frame
  Vector2d origin_P_mm =
      Vector2d::Zero();  ///< the gripper's origin seen from the part: what all stations share

  PlanHold() = default;
  explicit PlanHold(const planner::Hold& hold);
};

/// Bounds of a station, as a gripper from below would say them.
struct PlanBounds {
  model::Side side = model::Side::Below;
  model::Adjust adjust;

  PlanBounds() = default;
  PlanBounds(model::Side station_side, const model::Adjust& bounds);
};

/// Whether two stations can be adjusted so that they hold the part in one place. Exact, also where both may
/// turn and move: the offsets' difference turns with theta on a circle, which is tried where it crosses the
/// bounds.
bool adjustable(const PlanHold& giver, const PlanBounds& gives, const PlanHold& receiver,
                const PlanBounds& receives);

/// Which stations fix where the part is in the handoff frame, so that nothing is searched: the one that may
/// turn least and the one that may move least (the first of equals) stand at the value of their bounds
/// nearest to 0.
struct References {
  std::size_t theta = 0;
  std::size_t offset = 0;
};
References references_of(std::span<const PlanBounds> bounds);

/// The part's pose in the handoff frame, by the holds of the two reference stations.
geometry::Pose2 part_in_handoff_frame(const PlanHold& turns_least, const PlanBounds& theta_bounds,
                                      const PlanHold& moves_least, const PlanBounds& offset_bounds);

/// The adjustment that lets a station hold the part there, in the station's own terms.
planner::Adjustment adjustment_for(const PlanHold& hold, model::Side side, const geometry::Pose2& X_HP);

/// In which turns of the part a station reaches it.
enum class TurnsInReach { None, Some, All };

/// The same for a station beside `moves_least`, the one that says where the part is: only the part's turn is
/// open. `Some` where it cannot be told at once.
TurnsInReach turns_in_reach(const PlanHold& hold, const PlanBounds& bounds, const PlanHold& moves_least,
                            const PlanBounds& offset_bounds);

/// The part's place with its turn worked out, to be compared with many holds.
struct PartPlace {
  geometry::Pose2 X_HP;
  Vector2d x_axis = Vector2d::UnitX();

  explicit PartPlace(const geometry::Pose2& pose);
};

/// Whether the adjustment that `place` asks for is within the station's bounds.
bool reaches(const PlanHold& hold, const PlanBounds& bounds, const PartPlace& place);

}  // namespace pinjaw::cell

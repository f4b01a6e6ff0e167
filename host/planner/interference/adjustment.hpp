#pragma once

#include <optional>
#include <vector>

#include "host/model/cell.hpp"
#include "host/model/design.hpp"
#include "host/model/task.hpp"

namespace pinjaw::planner {

/// A station's frame in the handoff frame: turned by theta about its own z, then moved by x, y along its own
/// nominal axes (those of the handoff frame; of the handoff frame turned by pi about y for a gripper from
/// above).
struct Adjustment {
  double theta_rad = 0;  ///< in (-pi, pi]
  geometry::Vector2d offset_mm = geometry::Vector2d::Zero();
};

/// Where a design holds its part: one row and column shift of it.
struct Stance {
  int row_shift = 0;   ///< rows that all pins move from where the design has them
  int left_shift = 0;  ///< columns that each jaw's pins move outwards from there
  int right_shift = 0;
  double jaw_separation_mm = 0;
  double jaw_open_mm = 0;
  geometry::Pose2 part_pose;  ///< X_GP of the turned part
};

/// Every stance of `design` that loads: each row shift with room on the plates, with the design's own columns
/// and its alternatives; the design as it stands first, then the least moves.
std::vector<Stance> stances_of(const model::Design& design, const model::Kit& kit);

/// `design` moved to one of its stances.
model::Design moved(const model::Design& design, const model::Kit& kit, const Stance& stance);

/// A station's way of holding the part: from which side, and in which pose.
struct Hold {
  model::Side side = model::Side::Below;
  geometry::Pose2 part_pose;  ///< X_GP of the turned part
};

/// The one adjustment of a station that lets it hold the part where a station adjusted by `known` holds it.
Adjustment required_adjustment(const Hold& known_hold, const Adjustment& known, const Hold& hold);

/// Whether the bounds allow it (angles modulo 2 pi; closed, to 1e-6 mm and 1e-9 rad).
bool within(const Adjustment& adjustment, const model::Adjust& bounds);

struct PairAdjustment {
  Adjustment giver;
  Adjustment receiver;
};

/// Adjustments of two stations, within their bounds, that bring their holds of the part together; nothing
/// where there are none. Exact where theta is free in at most one of the two and an offset in at most one;
/// where both are free, the giver moves as little as it can.
std::optional<PairAdjustment> pair_adjustment(const Hold& giver, const model::Adjust& giver_bounds,
                                              const Hold& receiver, const model::Adjust& receiver_bounds);

}  // namespace pinjaw::planner

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host/planner/loading/loading.hpp"
#include "host/planner/planar/column_shifts.hpp"

namespace pinjaw::planner {

/// The way of one fixture's gripper to the part, from open to closed and from far below to open, for any
/// column shift. All in the turned part frame, where closed pins stand still whatever the shift.
class Path {
 public:
  Path(const PlanarFixture& fixture, std::span<const PinToLoad> pins, const model::Kit& kit,
       const Surroundings& surroundings, const LoadingOptions& options);

  /// What stops the gripper at this shift; nothing where it loads. Quickest when asked for the widest opening
  /// first: who opens far without touching the part opens less far, too.
  [[nodiscard]] std::optional<LoadingLoss> loss_at(const PlacedFixture& placed);

 private:
  struct Pin {
    geometry::Vector2d closed_mm = geometry::Vector2d::Zero();
    geometry::Vector2d outwards = geometry::Vector2d::Zero();  ///< unit, the way its jaw opens
    double top_mm = 0;
  };

  [[nodiscard]] bool pins_meet_part(double opening_mm);
  [[nodiscard]] bool pins_meet_others(double opening_mm) const;
  [[nodiscard]] bool jaws_meet_anything(const PlacedFixture& placed, double opening_mm) const;
  [[nodiscard]] bool solid_meets_anything(const model::JawBody& solid, const PlacedFixture& placed,
                                          model::JawSide jaw, double opening_mm) const;

  const model::Kit& kit_;
  const Surroundings& surroundings_;
  LoadingOptions options_;
  std::vector<Pin> pins_;
  std::vector<model::JawSide> jaws_;    ///< those that have pins, and so plates
  std::vector<model::JawBody> solids_;  ///< of each such jaw
  double clear_mm_;                     ///< widest opening known to keep all pins off the part
  double blocked_mm_;                   ///< least opening known to take a pin into the part
};

}  // namespace pinjaw::planner

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host/model/design.hpp"
#include "host/model/feature.hpp"

/// Where a part comes to lie when its gripper closes with pins, holes and features a little off.
namespace pinjaw::planner {

/// A part closed by four pins whose errors are known.
struct ClosedPart {
  struct Contact {
    geometry::Vector2d p_P_mm = geometry::Vector2d::Zero();  ///< turned part frame
    geometry::Vector2d n_P = geometry::Vector2d::UnitX();    ///< unit, from the pin into the part
    double along_mm = 0;                                     ///< on the feature's nominal curve
    bool on_feature = true;                                  ///< false where the foot is past its end
  };
  std::array<Contact, 4> contacts;
  double separation_mm = 0;
  double moved_mm = 0;    ///< of the reference point, in plan
  double turned_rad = 0;  ///< counter-clockwise
};

/// No error within the ranges moves the part further.
struct LocationBound {
  double moved_mm = 0;
  double turned_rad = 0;
};

/// The closed gripper of one design: part pose and jaw separation as functions of what its pins and features
/// are off. Jaws are coupled: they stand at -s/2 and s/2 whatever s. Heights stay.
class Closing {
 public:
  /// `features` are those the design's pins name. `reference_P_mm`: the point whose way is told, in plan, in
  /// the turned part frame.
  Closing(const model::Design& design, const std::vector<model::Feature>& features, const model::Kit& kit,
          const geometry::Vector2d& reference_P_mm);

  /// Newton's method on the four contact equations from the nominal pose, to 1e-12 mm. Nothing where it does
  /// not settle: the pins do not close on these features.
  [[nodiscard]] std::optional<ClosedPart> at(const model::Ranges& ranges,
                                             const model::PinErrors& errors) const;

  /// A bound for every error in `ranges`: the linear answer at its worst corner, exactly, and what the
  /// inverse Jacobian makes of the most that the contact equations may depart from their tangents, a most
  /// that the poses it admits do not reach. Nothing where no such most is found.
  [[nodiscard]] std::optional<LocationBound> bound(const model::Ranges& ranges) const;

 private:
  struct Pin {
    geometry::Curve curve;
    model::Bulge bulge = model::Bulge::Convex;
    double jaw_sign = 0;                                        ///< -1 left, 1 right
    geometry::Vector2d axis_G_mm = geometry::Vector2d::Zero();  ///< nominal
    geometry::Vector2d n_G = geometry::Vector2d::UnitX();       ///< nominal, from the pin into the part
  };
  struct State;
  [[nodiscard]] State state_at(const Eigen::Vector4d& q, const model::Ranges& ranges,
                               const model::PinErrors& errors) const;

  std::array<Pin, 4> pins_;
  double radius_mm_;
  double separation_mm_;
  geometry::Pose2 nominal_;  ///< of the part
  geometry::Vector2d reference_P_mm_;
  geometry::Vector2d reference_G_mm_;  ///< nominal
};

}  // namespace pinjaw::planner

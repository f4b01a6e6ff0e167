#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host/model/kit.hpp"
#include "host/model/profile.hpp"
#include "host/planner/planar/planar_fixture.hpp"
#include "tests/host/planner/planar/slow/track.hpp"

namespace pinjaw::planner::slow {

/// What is to be held and with what.
struct Task {
  std::vector<model::Feature> features;
  model::Kit kit;
  const model::Profile* outline = nullptr;  ///< nothing on a CAD part
  std::vector<Track> tracks;                ///< one a feature
  double reach_hair_mm = 1e-8;              ///< how well the ends of the features' reach are known
};
Task task_of(std::vector<model::Feature> features, const model::Kit& kit, const model::Profile* outline);

/// A pin in a hole counted from column 0 of its own jaw and a common row 0, and its feature.
struct Pin {
  model::Hole hole;
  int feature = 0;
  friend auto operator<=>(const Pin&, const Pin&) = default;
};

/// Pins around a part: its origin is x_mm[jaw] from that jaw's column 0 and y_mm above row 0.
struct Stand {
  std::vector<Pin> pins;
  double theta_rad = 0;
  double y_mm = 0;
  double x_mm[2] = {0, 0};  ///< left, right
};

/// Moves the part and the right jaw until all pins touch the tracks of their features: Newton's method with
/// differences for slopes. Three pins of one jaw leave the other jaw where it is. False where it ends
/// elsewhere.
bool settle(const Task& task, Stand& stand);

/// How an arrangement stands to the definition of a planar fixture.
struct Verdict {
  bool fixture = false;
  bool borderline = false;  ///< a figure within rounding of what decides
  double closure_margin = 0;
};

/// By the definition alone (DESIGN 3, phase 2): four touching pins that push inwards, feet in reach, outside
/// the outline, strictly closed, on the plates, within the jaws' travel, not overlapping.
Verdict verdict(const Task& task, const Stand& stand);

/// Whether four pins that touch to some 0.05 mm are certain not to close once they touch: two multipliers of
/// the balanced forces differ in sign by more than that can turn.
bool surely_open(const Task& task, const Stand& stand);

/// Least column of each jaw and least row made 0, pins sorted.
Stand canonical(const Task& task, Stand stand);

Stand stand_of(const PlanarFixture& fixture);
double span_mm(const Stand& stand);

}  // namespace pinjaw::planner::slow

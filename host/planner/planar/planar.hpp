#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "host/model/feature.hpp"
#include "host/model/kit.hpp"
#include "host/model/profile.hpp"
#include "host/planner/planar/planar_fixture.hpp"

namespace pinjaw::planner {

/// How a fixture and the same fixture with the gripper turned by 180 degrees are listed.
enum class Twins {
  Both,  ///< two fixtures (planar JSON)
  Once,  ///< one: the smaller sorted pin list stands for both (plans; DESIGN 3.1 no. 6)
};

struct PlanarOptions {
  /// Outline that every pin must stay out of, within 1e-6 mm; nothing on a CAD part, where phase 3 decides.
  const model::Profile* outline = nullptr;
  Twins twins = Twins::Both;
  int threads = 0;  ///< 0: as many as the machine has; the result is the same for any
  std::function<void(double)> progress = {};  ///< called with the share done, 0..1, from any thread
  std::stop_token stop = {};
};

/// How the search ended.
enum class PlanarEnd { Complete, Stopped };

struct PlanarResult {
  PlanarEnd end = PlanarEnd::Complete;
  std::vector<PlanarFixture> fixtures;  ///< sorted by split, holes, features, theta; none twice
};

/// All planar fixtures of a kit on features: 2+2, 3+1 and 1+3 pins on segments and arcs in any mix, in strict
/// planar form closure, left pins pushing the part +x and right pins -x, with a column shift that brings the
/// jaw separation into range, in distinct holes, not overlapping, feet at least kit.pins.min_foot_margin_mm
/// from their feature's ends (DESIGN 3, phase 2; Wallack and Canny's modular vise). Stopped: `fixtures` is
/// empty.
PlanarResult plan_planar_fixtures(const std::vector<model::Feature>& features, const model::Kit& kit,
                                  const PlanarOptions& options = {});

}  // namespace pinjaw::planner

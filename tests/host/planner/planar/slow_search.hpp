#pragma once

#include <vector>

#include "host/model/kit.hpp"
#include "host/model/profile.hpp"
#include "host/planner/planar/planar_fixture.hpp"

namespace pinjaw::planner {

/// What a slow search of another design finds: theta in small steps, both curves of a pair of pins cut by
/// plane geometry at each step, changes of sign between neighbours halved to a root. Each fixture once for
/// each labelling; not sorted. It may miss what lives for less than a step.
struct SlowFixture {
  double theta_rad = 0;
  double span_mm = 0;
  double closure_margin = 0;
  struct Pin {
    model::Hole hole;
    int feature = 0;
    friend auto operator<=>(const Pin&, const Pin&) = default;
  };
  std::vector<Pin> pins;  ///< sorted, canonical
};

/// The part of theta that is searched, and in how many steps.
struct ThetaSteps {
  double from_rad = 0;
  double to_rad = 0;
  int count = 0;
};

std::vector<SlowFixture> slow_search(const model::Profile& profile, const model::Kit& kit,
                                     const ThetaSteps& steps);

}  // namespace pinjaw::planner

#pragma once

#include <vector>

#include "host/geometry/surface.hpp"
#include "host/planner/features/carrier.hpp"

/// The two-sided rule (DESIGN 3, phase 1). Private to phase 1.
namespace pinjaw::planner {

/// A stretch of a carrier along which the surface's lowest z jumps by the engagement.
struct Stretch {
  geometry::Interval along_mm;
  FreeSide side = FreeSide::None;
};

/// The stretches of one edgelet that jump by at least `engagement_mm`, sorted.
///
/// Compares the lowest z of the surface eps to either side, at samples a quarter of a millimetre apart or
/// closer, and halves the step between samples that differ down to 1e-5 mm. Near the edgelet's ends, where
/// another edge passes within eps, the nearest sample holds.
std::vector<Stretch> jumping_stretches(const geometry::Surface& surface, const Carrier& carrier,
                                       const geometry::Interval& edgelet_mm, double engagement_mm);

/// Why an edgelet without such a stretch has none, looked at in its middle, where the lowest of its curves is
/// at `z_mm`: OffSurface, Hidden, InFlat or LowStep.
Fate why_no_stretch(const geometry::Surface& surface, const Carrier& carrier,
                    const geometry::Interval& edgelet_mm, double z_mm);

/// Adjacent stretches with the same free side as one, across angle 0 of a circle too, where the joined
/// stretch ends beyond the circumference.
std::vector<Stretch> joined(const std::vector<Stretch>& stretches, const Carrier& carrier);

}  // namespace pinjaw::planner

#pragma once

#include <vector>

#include "host/geometry/mesh.hpp"
#include "host/geometry/surface.hpp"
#include "host/model/feature.hpp"
#include "host/model/kit.hpp"

/// Where on a feature a closed pin has room (DESIGN 3.1 no. 4). Private to phase 1.
namespace pinjaw::planner {

/// The stretches of `feature` where zlow over the disc of radius r - eps about the pin's centre is at least
/// z_edge + engagement; sorted and disjoint.
///
/// Exact on the surface's triangles: each facet below that height blocks the stretches along which its
/// distance in plan to the path of the pin's centre is under r - eps, and those have closed forms.
/// `breaks_mm` are the positions on the feature where z_edge may step; between them it is followed in steps
/// of a quarter of a millimetre.
std::vector<geometry::Interval> reach_of(const model::Feature& feature, const std::vector<double>& breaks_mm,
                                         const geometry::Surface& surface, const model::PinStock& pins);

}  // namespace pinjaw::planner

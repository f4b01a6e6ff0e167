#pragma once

namespace pinjaw::model {

/// eps of DESIGN 3.1 no. 1: how much thicker or thinner a pin is taken to be when the part is asked about it,
/// and how far beside an edge the part is looked at. Chosen: five times the mesh's chord error, far below any
/// fit.
inline constexpr double kEps_mm = 0.02;

/// A curve that differs from the part's own by less is that curve: far above the rounding of files and of
/// fits, far below anything that a pin feels. Chosen.
inline constexpr double kExactMm = 1e-6;

}  // namespace pinjaw::model

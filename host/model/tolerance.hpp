#pragma once

namespace pinjaw::model {

/// eps of DESIGN 3.1 no. 1: how much thicker or thinner a pin is taken to be when the part is asked about it,
/// and how far beside an edge the part is looked at. Chosen: five times the mesh's chord error, far below any
/// fit.
inline constexpr double kEps_mm = 0.02;

}  // namespace pinjaw::model

#pragma once

#include <optional>
#include <vector>

#include "host/geometry/plane.hpp"
#include "host/model/profile.hpp"

/// What makes loops of segments and arcs the outline of a part. Lengths in mm.
namespace pinjaw::config {

using geometry::Vector2d;

/// Two points nearer than this are one: hand-written coordinates have three decimals.
constexpr double kSamePoint_mm = 1e-3;

Vector2d start_of(const model::ProfileEdge& edge);
Vector2d end_of(const model::ProfileEdge& edge);

/// Area within a closed loop, negative where it runs clockwise.
double signed_area_mm2(const std::vector<model::ProfileEdge>& loop);

/// True where the point lies inside the closed loop, whichever way that runs.
bool is_inside(const Vector2d& p_mm, const std::vector<model::ProfileEdge>& loop);

/// Points where two edges meet; where they run along each other, one such point. Points nearer than
/// kSamePoint_mm to `shared` (an end that neighbours have in common) do not count.
std::vector<Vector2d> meetings(const model::ProfileEdge& a, const model::ProfileEdge& b,
                               const std::vector<Vector2d>& shared);

}  // namespace pinjaw::config

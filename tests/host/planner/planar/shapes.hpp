#pragma once

#include <vector>

#include "host/model/kit.hpp"
#include "host/model/profile.hpp"
#include "host/planner/planar/planar.hpp"

namespace pinjaw::planner {

/// The grid of the known cases: 11 mm, pins of 2.4 mm, jaws 0 to 60 mm.
model::Kit small_kit(int columns, int rows);

model::Profile profile_of_loop(const std::vector<model::ProfileEdge>& loop);
model::Profile polygon_profile(const std::vector<geometry::Vector2d>& points);

/// A part whose arcs are bosses and bores: counter-clockwise stadium, one flat, a dent.
model::Profile rounded_part();

model::Profile moved(const model::Profile& profile, const geometry::Pose2& motion);
model::Profile mirrored(const model::Profile& profile);  ///< x to -x, loops turned round
model::Profile scaled(const model::Profile& profile, double factor);
model::Kit scaled(const model::Kit& kit, double factor);

std::vector<PlanarFixture> all_fixtures(const model::Profile& profile, const model::Kit& kit,
                                        Twins twins = Twins::Both, int threads = 0);

/// Whether each fixture of one list has its like in the other: split, holes, edges, span, and theta moved by
/// `turn_rad`.
bool same_lists(const std::vector<PlanarFixture>& one, const std::vector<PlanarFixture>& other,
                double turn_rad = 0);

}  // namespace pinjaw::planner

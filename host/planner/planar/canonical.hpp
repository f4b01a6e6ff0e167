#pragma once

#include <vector>

#include "host/planner/planar/candidate.hpp"
#include "host/planner/planar/planar.hpp"

namespace pinjaw::planner::planar {

/// `candidate` told in the canonical way: least row 0, least column of each jaw 0, pins sorted by hole.
PlanarFixture fixture_of(const Candidate& candidate, const std::vector<ContactCurve>& curves,
                         const std::vector<model::Feature>& features, const model::Kit& kit);

/// Adds the fixture and its twin; with Twins::Once only the one that will stand for both, where their holes
/// tell which: very many fixtures then take half the memory.
void add_with_twin(const PlanarFixture& fixture, Twins twins, double spacing_mm,
                   std::vector<PlanarFixture>& out);

/// Sorts by split, holes, features, theta and keeps one of each pose: that with the smaller feature ids
/// (DESIGN 3.1 no. 5). With Twins::Once also one of each pair of twins (no. 6).
std::vector<PlanarFixture> listed_once(const std::vector<PlanarFixture>& fixtures, Twins twins,
                                       double spacing_mm);

}  // namespace pinjaw::planner::planar

#pragma once

#include <string>
#include <vector>

#include "host/model/feature.hpp"
#include "host/model/kit.hpp"
#include "host/planner/features/features.hpp"
#include "host/planner/planar/planar_fixture.hpp"

namespace pinjaw::planner {

/// `pinjaw-planar/1`: every fixture with its pins at the least columns and rows that bring s into range; the
/// features tell each pin's loop and edge.
std::string to_json(const std::vector<PlanarFixture>& fixtures, const std::vector<model::Feature>& features,
                    const model::Kit& kit);

/// `pinjaw-features/1`: the features of a part as its gripper sees it, with what was left out and why, and
/// what was read of a mesh, if it was one.
std::string features_json(const std::string& task, const std::vector<model::Feature>& features,
                          const FeatureCounts& counts,
                          const std::vector<std::pair<std::string, int>>& mesh_counts);

}  // namespace pinjaw::planner

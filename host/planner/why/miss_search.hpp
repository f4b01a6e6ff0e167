#pragma once

#include <vector>

#include "host/planner/why/lost.hpp"
#include "host/planner/why/near_miss.hpp"

/// The nearest misses of each phase. Private to this folder.
namespace pinjaw::planner {

/// Phase 1: the largest step of an edge where there is no feature; the largest pin that has room on a feature
/// where none is reachable.
std::vector<NearMiss> feature_misses(const model::Task& task, const Scene& scene, const Plan& plan,
                                     const std::stop_token& stop);

/// Phase 2, where it finds nothing: the jaw separation nearest the kit's range at which there is a fixture,
/// and the widest foot margin.
std::vector<NearMiss> planar_misses(const model::Task& task, const Scene& scene, const PlanOptions& options);

/// Phase 3: of the fixtures whose pins fail for one reason alone, the one whose worst pin fails by least.
std::vector<NearMiss> standing_misses(const model::Task& task, const Scene& scene,
                                      const std::vector<LostStanding>& lost);

/// Phase 4: the least lowering of all pins, or of the plates, with which a fixture loads; the least travel
/// that is missing.
std::vector<NearMiss> loading_misses(const model::Task& task, const Scene& scene,
                                     const std::vector<LostLoading>& lost, const PlanOptions& options);

/// Phase 5: the friction at which one would slide, or hold; the least squeeze over the usable one.
std::vector<NearMiss> force_misses(const model::Task& task, const Plan& plan,
                                   const std::vector<model::Design>& designs, const PlanOptions& options);

}  // namespace pinjaw::planner

#pragma once

#include "host/base/expected.hpp"
#include "host/planner/force/worst_spray.hpp"
#include "host/planner/plan/plan.hpp"

namespace pinjaw::planner {

/// Certifies the worst spray of the plan's best `count` designs (worst_spray.hpp): each is told its bracket,
/// the plan its jets. Where no jet reaches the part they stay without. Fails where the task names no spray,
/// or it is asked to stop.
base::Expected<void> certify(const model::Task& task, const Scene& scene, std::size_t count,
                             std::stop_token stop, const ProgressSink& progress, Plan& plan);

/// Its bracket, found anew from the plan's jets.
std::optional<model::Certified> certified(const Plan& plan, WorstSpray& search, const model::Design& design);

/// A search over the part of the scene under the plan's jets. The scene outlives it.
WorstSpray worst_spray_of(const Plan& plan, const Scene& scene);

}  // namespace pinjaw::planner

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/planner/why/near_miss.hpp"

/// The changes of a kit or task that may help a part without a design.
namespace pinjaw::planner {

/// A task and how it is planned: what a change is applied to.
struct Variant {
  model::Task task;
  PlanOptions options;
};

/// One setting with another value, as the user's file would say it.
struct Change {
  std::string key;  ///< kit.jaws.separation_mm, task.side, --friction
  std::string from;
  std::string to;
  std::function<void(Variant&)> apply;
};

/// Ever greater changes of one setting in one direction, least first.
using Ladder = std::vector<Change>;

/// The changes worth trying for `variant`, those first that act on the phase where the last fixtures of
/// `plan` were lost. Values are what shops and catalogues have: pins and grids of usual sizes, whole or half
/// millimetres, tenths of friction, or the part's material on other pins. Each step leaves a kit that a kit
/// file may hold.
std::vector<Ladder> ladders(const Variant& variant, const Scene& scene, const Plan& plan,
                            const std::vector<NearMiss>& misses);

/// A jaw separation no grip of the part can exceed: its diagonal in plan and a pin on either side.
double widest_grip_mm(const geometry::Surface& part, const model::Kit& kit);

}  // namespace pinjaw::planner

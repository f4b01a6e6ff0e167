#pragma once

#include <functional>
#include <vector>

#include "host/planner/why/levers.hpp"

/// Changes with which a part without a design has some, each proven by a plan.
namespace pinjaw::planner {

/// The least change found on its ladder, and what the whole plan of the changed task gave.
struct Suggestion {
  std::vector<Change> changes;  ///< one; two where no single one helps
  Funnel funnel;
  std::int64_t designs = 0;
  double best_n = 0;  ///< required squeeze of its best design
};

struct Suggestions {
  std::vector<Suggestion> found;
  std::vector<Change> in_vain;         ///< the greatest change tried of each ladder that gave nothing
  std::vector<std::string> not_tried;  ///< keys left for lack of time
  std::int64_t plans = 0;              ///< that were run
};

/// Searches each ladder for the least change that gives a design: growing steps, then halving between the
/// last that failed and the first that passed. Where no ladder helps, the one that carries fixtures furthest
/// down the funnel stays and the others are tried on top of it. `told` hears of each suggestion as it is
/// found. Ends early where `variant.options.stop` asks for it; then `not_tried` says what is missing.
Suggestions suggest(const Variant& variant, const Scene& scene, const Plan& plan,
                    const std::vector<NearMiss>& misses,
                    const std::function<void(const Suggestion&)>& told = {},
                    const ProgressSink& progress = {});

}  // namespace pinjaw::planner

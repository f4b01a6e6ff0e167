#include "host/planner/plan/rank.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>

#include "host/planner/features/features.hpp"
#include "host/planner/force/disturbances.hpp"

namespace pinjaw::planner {

namespace {

constexpr std::size_t kAtOnce = 8;  // chosen: worked out together, so that a few threads have work

double worst_n(const model::Design& design) {
  return design.robust->worst_required_n.value_or(std::numeric_limits<double>::infinity());
}

/// Whether `count` of the designs before `next` are no worse than `next` is even nominally.
bool settled(const std::vector<model::Design>& designs, std::size_t next, std::size_t count) {
  const double nominal_n = designs[next].squeeze.required_n;
  const auto before = designs.begin() + static_cast<std::ptrdiff_t>(next);
  return std::count_if(designs.begin(), before, [&](const model::Design& d) {
           return worst_n(d) < nominal_n;
         }) >= static_cast<std::ptrdiff_t>(count);
}

}  // namespace

RobustScene::RobustScene(const Plan& plan, const Scene& scene, const model::Ranges& ranges)
    : features(find_features(scene.turned, plan.kit.pins).features),
      wrenches(turned_wrenches(plan.disturbances, plan.side)),
      of{plan.kit,
         features,
         scene.turned.centroid_mm.head<2>(),
         ranges,
         plan.friction,
         plan.friction_model,
         plan.disturbances,
         wrenches} {}

void tell_robustness(Plan& plan, const Scene& scene, const model::Ranges& ranges,
                     const RobustOptions& options, const ProgressSink& progress) {
  const RobustScene robust(plan, scene, ranges);
  plan.ranges = ranges;
  plan.ranked_by_worst = options.rank == Rank::Robust;
  auto& designs = plan.designs;
  std::size_t done = 0;
  const auto enough = [&] {
    if (done == designs.size()) return true;
    return plan.ranked_by_worst ? settled(designs, done, options.count) : done >= options.count;
  };
  while (!enough()) {
    const std::size_t left = plan.ranked_by_worst ? designs.size() : std::min(designs.size(), options.count);
    const std::size_t end = std::min(done + kAtOnce, left);
    if (progress) progress({"robustness", static_cast<std::int64_t>(done), static_cast<std::int64_t>(left)});
    tbb::parallel_for(done, end,
                      [&](std::size_t i) { designs[i].robust = robust_of(robust.of, designs[i]); });
    done = end;
  }
  if (plan.ranked_by_worst) {
    // the best by their worst come first; those worked out in vain stand where they stood
    const auto end = designs.begin() + static_cast<std::ptrdiff_t>(done);
    const auto best = designs.begin() + static_cast<std::ptrdiff_t>(std::min(options.count, done));
    const auto nominally = [](const model::Design& d) { return std::tie(d.squeeze.required_n, d.id); };
    std::sort(designs.begin(), end, [](const model::Design& a, const model::Design& b) {
      const double worst_a_n = worst_n(a);
      const double worst_b_n = worst_n(b);
      return std::tie(worst_a_n, a.squeeze.required_n, a.id) <
             std::tie(worst_b_n, b.squeeze.required_n, b.id);
    });
    std::for_each(best, end, [](model::Design& d) { d.robust.reset(); });
    std::sort(best, end,
              [&](const model::Design& a, const model::Design& b) { return nominally(a) < nominally(b); });
  }
  if (options.top > 0 && designs.size() > options.top) designs.resize(options.top);
}

}  // namespace pinjaw::planner

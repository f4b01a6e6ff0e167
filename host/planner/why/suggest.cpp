#include "host/planner/why/suggest.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

namespace pinjaw::planner {
namespace {

constexpr std::int64_t kMostPlans = 300;  // chosen: some twenty ladders of a dozen steps

/// How far down the funnel fixtures came; greater is further.
auto depth(const Funnel& f) {
  return std::tuple(f.strong, f.resistable, f.not_wedging, f.loadable, f.heights, f.planar, f.features);
}

std::string name_of(const Change& change) {
  return change.key + " to " + change.to;
}

/// A variant and what its plan gave.
struct Tried {
  Variant variant;
  Plan plan;
  std::vector<Change> changes;
};

class Search {
 public:
  Search(const Scene& scene, model::Side side, const std::function<void(const Suggestion&)>& told,
         const ProgressSink& progress)
      : scene_(scene), side_(side), told_(told), progress_(progress) {}

  /// Climbs every ladder from `base`; each that gives a design is told. What came furthest without one stays
  /// in `furthest`.
  void climb(const Tried& base, const std::vector<NearMiss>& misses) {
    for (const Ladder& ladder : ladders(base.variant, scene_of(base.variant), base.plan, misses)) {
      const std::string& key = ladder.front().key;
      if (std::ranges::any_of(base.changes, [&](const Change& c) { return c.key == key; })) continue;
      if (over(base.variant)) {
        skip(base, ladder);
        continue;
      }
      climb(base, ladder);
    }
  }

  [[nodiscard]] const Scene& scene_of(const Variant& variant) {
    if (variant.task.side == side_) return scene_;
    if (!other_side_) {
      auto read = read_scene(variant.task);
      if (read) other_side_ = std::move(*read);
    }
    return other_side_ ? *other_side_ : scene_;
  }

  Suggestions result;
  std::optional<Tried> furthest;

 private:
  [[nodiscard]] bool over(const Variant& variant) const {
    return variant.options.stop.stop_requested() || result.plans >= kMostPlans;
  }

  /// Tells what is left out: each ladder that stands alone, and once those on top of another change.
  void skip(const Tried& base, const Ladder& ladder) {
    const std::string name =
        base.changes.empty() ? name_of(ladder.back()) : "more on top of " + name_of(base.changes.front());
    if (result.not_tried.empty() || result.not_tried.back() != name) result.not_tried.push_back(name);
  }

  void climb(const Tried& base, const Ladder& ladder) {
    std::optional<Tried> passed;
    std::size_t failed = 0;  // steps up to here are known or taken to fail
    std::size_t at = 0;
    std::size_t jump = 1;
    while (!passed && failed < ladder.size() && !over(base.variant)) {
      passed = run(base, ladder[at]);
      if (passed) break;
      failed = at + 1;
      at = std::min(at + jump, ladder.size() - 1);
      jump *= 2;
    }
    std::size_t passes = at;
    while (passed && failed < passes && !over(base.variant)) {
      const std::size_t middle = (failed + passes) / 2;
      if (auto tried = run(base, ladder[middle])) {
        passed = std::move(tried);
        passes = middle;
      } else {
        failed = middle + 1;
      }
    }
    if (!passed) {
      if (failed < ladder.size()) {
        skip(base, ladder);
      } else if (base.changes.empty()) {
        result.in_vain.push_back(ladder.back());
      }
      return;
    }
    result.found.push_back({passed->changes, passed->plan.funnel, passed->plan.funnel.strong,
                            passed->plan.designs.front().squeeze.required_n});
    if (told_) told_(result.found.back());
  }

  /// The plan of `base` with one more change; nothing where it has no design.
  std::optional<Tried> run(const Tried& base, const Change& change) {
    Tried tried{base.variant, {}, base.changes};
    tried.changes.push_back(change);
    change.apply(tried.variant);
    tried.variant.options.top = 1;
    if (progress_) progress_({"trying " + change.key, result.plans, kMostPlans});
    auto plan = make_plan(tried.variant.task, scene_of(tried.variant), tried.variant.options);
    ++result.plans;
    if (!plan) return std::nullopt;
    tried.plan = std::move(*plan);
    if (!tried.plan.designs.empty()) return tried;
    const bool further = depth(tried.plan.funnel) > depth((furthest ? *furthest : base).plan.funnel);
    if (base.changes.empty() && further) furthest = std::move(tried);
    return std::nullopt;
  }

  const Scene& scene_;
  model::Side side_;
  std::optional<Scene> other_side_;
  const std::function<void(const Suggestion&)>& told_;
  const ProgressSink& progress_;
};

}  // namespace

Suggestions suggest(const Variant& variant, const Scene& scene, const Plan& plan,
                    const std::vector<NearMiss>& misses, const std::function<void(const Suggestion&)>& told,
                    const ProgressSink& progress) {
  Search search(scene, variant.task.side, told, progress);
  search.climb({variant, plan, {}}, misses);
  if (search.result.found.empty() && search.furthest) {
    const Tried base = *search.furthest;
    const Scene& base_scene = search.scene_of(base.variant);
    search.climb(base, nearest_misses(base.variant.task, base_scene, base.plan, base.variant.options));
  }
  return std::move(search.result);
}

}  // namespace pinjaw::planner

#include "host/planner/features/features.hpp"
#include "host/planner/why/least.hpp"
#include "host/planner/why/miss_search.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kStep = 1e-3;              // relative: how near a limit is told
constexpr double kSmallestRadius_mm = 0.1;  // chosen: no pin is thinner; eps is a fifth of it

/// The largest step along any edge where none reaches the engagement.
std::optional<double> largest_jump_mm(const part::Part& part, model::PinStock pins,
                                      const std::stop_token& stop) {
  const double asked_mm = pins.min_engagement_mm;
  const auto some = [&](double engagement_mm) {
    pins.min_engagement_mm = engagement_mm;
    return !stop.stop_requested() && find_features(part, pins).counts.features > 0;
  };
  const double least_mm = asked_mm * kStep;
  if (!some(least_mm)) return std::nullopt;
  return boundary({asked_mm, least_mm}, asked_mm * kStep, some);
}

/// The largest pin radius under the kit's with which some feature can be reached.
std::optional<double> largest_radius_mm(const part::Part& part, model::PinStock pins,
                                        const std::stop_token& stop) {
  const double asked_mm = pins.radius_mm;
  const auto some = [&](double radius_mm) {
    pins.radius_mm = radius_mm;
    return !stop.stop_requested() && find_features(part, pins).counts.reachable > 0;
  };
  if (asked_mm <= kSmallestRadius_mm || !some(kSmallestRadius_mm)) return std::nullopt;
  return boundary({asked_mm, kSmallestRadius_mm}, asked_mm * kStep, some);
}

}  // namespace

std::vector<NearMiss> feature_misses(const model::Task& task, const Scene& scene, const Plan& plan,
                                     const std::stop_token& stop) {
  std::vector<NearMiss> misses;
  if (plan.funnel.features == 0) {
    NearMiss miss{
        .phase = "features", .reason = "no edge jumps by the engagement", .quantity = "step of an edge"};
    const double needs_mm = task.kit.pins.min_engagement_mm;
    if (const auto jump_mm = largest_jump_mm(scene.turned, task.kit.pins, stop))
      miss.gap = NearMiss::Gap{*jump_mm, needs_mm};
    misses.push_back(std::move(miss));
    return misses;
  }
  if (plan.funnel.planar > 0 || find_features(scene.turned, task.kit.pins).counts.reachable > 0)
    return misses;
  NearMiss miss{.phase = "features",
                .reason = "no room for a pin",
                .count = plan.funnel.features,
                .quantity = "pin radius"};
  if (const auto radius_mm = largest_radius_mm(scene.turned, task.kit.pins, stop))
    miss.gap = NearMiss::Gap{task.kit.pins.radius_mm, *radius_mm};
  misses.push_back(std::move(miss));
  return misses;
}

}  // namespace pinjaw::planner

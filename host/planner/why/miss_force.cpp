#include <algorithm>
#include <limits>

#include "host/planner/force/force.hpp"
#include "host/planner/why/least.hpp"
#include "host/planner/why/miss_search.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kFrictionResolution = 1e-3;  // chosen: no friction is known better
constexpr double kMostTaskFriction = 2;       // what a task file may say

struct Judged {
  const std::vector<model::Design>& designs;
  std::vector<Grasp> grasps;  ///< of the designs, one each

  [[nodiscard]] std::string name(std::size_t i) const { return "design " + designs[i].id; }
};

bool slides(Grasp& grasp, double mu) {
  grasp.mu = mu;
  return !wedging_jaw(grasp) && !jamming_contact(grasp);
}

/// The most friction, up to `most`, at which a grasp neither wedges nor jams; 0 where it does even without.
double sliding_friction(Grasp grasp, double most) {
  if (slides(grasp, most)) return most;
  if (!slides(grasp, 0)) return 0;
  return boundary({most, 0}, kFrictionResolution, [&](double mu) { return slides(grasp, mu); });
}

NearMiss sliding_miss(const char* reason, const std::vector<std::size_t>& lost, const Judged& judged) {
  NearMiss miss{.phase = "force", .reason = reason, .quantity = "friction", .unit = Unit::Ratio};
  miss.count = static_cast<std::int64_t>(lost.size());
  for (const std::size_t i : lost) {
    const double mu = sliding_friction(judged.grasps[i], judged.grasps[i].mu);
    if (mu <= 0 || (miss.gap && mu <= miss.gap->needs)) continue;
    miss.gap = NearMiss::Gap{judged.grasps[i].mu, mu};
    miss.where = judged.name(i);
  }
  return miss;
}

/// The least friction at which one of `lost` can resist every load and still slides.
NearMiss holding_miss(const std::vector<std::size_t>& lost, const Judged& judged,
                      std::span<const model::Wrench> wrenches, ForceOptions force,
                      const std::stop_token& stop) {
  NearMiss miss{.phase = "force",
                .reason = "no squeeze resists every disturbance",
                .count = static_cast<std::int64_t>(lost.size()),
                .quantity = "friction",
                .unit = Unit::Ratio};
  force.usable_n = std::numeric_limits<double>::infinity();
  double least = kMostTaskFriction;
  for (const std::size_t i : lost) {
    if (stop.stop_requested()) break;
    Grasp grasp = judged.grasps[i];
    const auto holds = [&](double mu) {
      grasp.mu = mu;
      return std::holds_alternative<Holds>(evaluate(grasp, wrenches, force));
    };
    const double most = sliding_friction(grasp, least) - (miss.gap ? kFrictionResolution : 0);
    if (most <= judged.grasps[i].mu || !holds(most)) continue;
    least = boundary({judged.grasps[i].mu, most}, kFrictionResolution, holds);
    miss.gap = NearMiss::Gap{judged.grasps[i].mu, least};
    miss.where = judged.name(i);
  }
  return miss;
}

}  // namespace

std::vector<NearMiss> force_misses(const model::Task& task, const Plan& plan,
                                   const std::vector<model::Design>& designs, const PlanOptions& options) {
  Judged judged{designs, {}};
  for (const model::Design& design : designs) judged.grasps.push_back(grasp_of(design, task.friction));
  const auto wrenches = turned_wrenches(plan.disturbances, task.side);
  const ForceOptions force{options.friction, task.kit.actuator.usable_squeeze_n(), {}};
  const auto verdicts = evaluate_all(judged.grasps, wrenches, force, options.threads);

  std::vector<std::size_t> wedging;
  std::vector<std::size_t> jamming;
  std::vector<std::size_t> slipping;
  NearMiss strong{.phase = "force",
                  .reason = "needs more than the usable force",
                  .quantity = "usable squeeze",
                  .unit = Unit::Newton};
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (std::holds_alternative<Wedges>(verdicts[i])) wedging.push_back(i);
    if (std::holds_alternative<Jams>(verdicts[i])) jamming.push_back(i);
    if (std::holds_alternative<NotResistable>(verdicts[i])) slipping.push_back(i);
    const auto* too_strong = std::get_if<TooStrong>(&verdicts[i]);
    if (too_strong == nullptr) continue;
    ++strong.count;
    if (strong.gap && too_strong->required_n >= strong.gap->needs) continue;
    strong.gap = NearMiss::Gap{force.usable_n, too_strong->required_n};
    strong.where = judged.name(i);
  }
  std::vector<NearMiss> misses;
  if (!wedging.empty()) misses.push_back(sliding_miss("wedges", wedging, judged));
  if (!jamming.empty()) misses.push_back(sliding_miss("jams", jamming, judged));
  if (!slipping.empty()) misses.push_back(holding_miss(slipping, judged, wrenches, force, options.stop));
  if (strong.count > 0) misses.push_back(std::move(strong));
  return misses;
}

}  // namespace pinjaw::planner

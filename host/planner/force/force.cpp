#include "host/planner/force/force.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pinjaw::planner {
namespace {

constexpr double kEqual =
    1e-9;  // relative: forces this close are equal, so that symmetry names the first wrench

double force_n(const SqueezeOutcome& outcome) {
  if (const auto* required = std::get_if<Required>(&outcome)) return required->force_n;
  return std::numeric_limits<double>::infinity();
}

struct Worst {
  double required_n = 0;
  std::size_t critical = 0;
};

Worst worst_of(const std::vector<double>& forces_n) {
  Worst worst;
  for (const double force : forces_n) worst.required_n = std::max(worst.required_n, force);
  const auto first = std::find_if(forces_n.begin(), forces_n.end(),
                                  [&](double force) { return force >= worst.required_n * (1 - kEqual); });
  if (first != forces_n.end()) worst.critical = static_cast<std::size_t>(first - forces_n.begin());
  return worst;
}

ForceVerdict verdict_of(const Worst& worst, const ForceOptions& options) {
  if (worst.required_n > options.usable_n) return TooStrong{worst.required_n, worst.critical};
  return Holds{worst.required_n, worst.critical};
}

/// A solver and its scratch memory, one a thread.
struct Worker {
  SqueezeSolver solver;
  std::vector<SqueezeOutcome> outcomes;
  std::vector<double> forces_n;

  /// Appends the pyramid's forces to forces_n.
  void solve(std::span<const model::Wrench> wrenches) {
    solver.least_squeeze_all(wrenches, outcomes);
    for (const SqueezeOutcome& outcome : outcomes) forces_n.push_back(force_n(outcome));
  }
};

ForceVerdict evaluate_pyramid(Worker& worker, std::span<const model::Wrench> wrenches,
                              const ForceOptions& options) {
  constexpr std::size_t kBlock = 32;  // chosen: where evaluation may stop early it looks this often
  const std::size_t block = options.stop_above_n ? kBlock : std::max<std::size_t>(1, wrenches.size());
  worker.forces_n.clear();
  for (std::size_t from = 0; from < wrenches.size(); from += block) {
    worker.solve(wrenches.subspan(from, std::min(block, wrenches.size() - from)));
    for (std::size_t i = from; i < worker.forces_n.size(); ++i) {
      const double force = worker.forces_n[i];
      if (std::isinf(force)) return NotResistable{i};
      if (options.stop_above_n && force > *options.stop_above_n) return TooStrong{force, i};
    }
  }
  return verdict_of(worst_of(worker.forces_n), options);
}

/// F_max over the exact cone. The inscribed pyramid needs at least as much, so wrenches are taken in the
/// order of its answer, and the rest are skipped once it needs no more than the worst cone found. Loads the
/// pyramid cannot resist come first, in the list's order.
ForceVerdict evaluate_cone(Worker& worker, std::span<const model::Wrench> wrenches,
                           const ForceOptions& options) {
  worker.forces_n.clear();
  worker.solve(wrenches);
  const std::vector<double>& forces_n = worker.forces_n;
  std::vector<std::size_t> order(wrenches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return forces_n[a] > forces_n[b]; });
  std::vector<double> cone_n(wrenches.size(), 0.0);
  double worst_n = 0;
  for (const std::size_t i : order) {
    if (forces_n[i] <= worst_n * (1 - kEqual)) break;
    cone_n[i] = force_n(worker.solver.least_squeeze(wrenches[i], model::FrictionModel::Cone));
    if (std::isinf(cone_n[i])) return NotResistable{i};
    worst_n = std::max(worst_n, cone_n[i]);
    if (options.stop_above_n && worst_n > *options.stop_above_n) return TooStrong{worst_n, i};
  }
  return verdict_of(worst_of(cone_n), options);
}

ForceVerdict verdict(Worker& worker, const Grasp& grasp, std::span<const model::Wrench> wrenches,
                     const ForceOptions& options) {
  if (const auto jaw = wedging_jaw(grasp)) return Wedges{*jaw};
  if (const auto contact = jamming_contact(grasp)) return Jams{contact->pin};
  worker.solver.take(grasp);
  return options.friction == model::FrictionModel::Cone ? evaluate_cone(worker, wrenches, options)
                                                        : evaluate_pyramid(worker, wrenches, options);
}

}  // namespace

ForceVerdict evaluate(const Grasp& grasp, std::span<const model::Wrench> wrenches,
                      const ForceOptions& options) {
  Worker worker;
  return verdict(worker, grasp, wrenches, options);
}

std::vector<ForceVerdict> evaluate_all(std::span<const Grasp> grasps, std::span<const model::Wrench> wrenches,
                                       const ForceOptions& options, int threads) {
  std::vector<ForceVerdict> verdicts(grasps.size());
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  tbb::enumerable_thread_specific<Worker> workers;
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, grasps.size(), [&](std::size_t i) {
      verdicts[i] = verdict(workers.local(), grasps[i], wrenches, options);
    });
  });
  return verdicts;
}

}  // namespace pinjaw::planner

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

ForceVerdict evaluate_pyramid(SqueezeSolver& solver, std::span<const model::Wrench> wrenches,
                              const ForceOptions& options, std::vector<double>& forces_n) {
  forces_n.clear();
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    if (options.stop_above_n) {
      const double bound_n = solver.lower_bound_n(wrenches[i]);
      if (bound_n > *options.stop_above_n) return TooStrong{bound_n, i};
    }
    const double force = force_n(solver.least_squeeze(wrenches[i]));
    if (std::isinf(force)) return NotResistable{i};
    if (options.stop_above_n && force > *options.stop_above_n) return TooStrong{force, i};
    forces_n.push_back(force);
  }
  return verdict_of(worst_of(forces_n), options);
}

/// F_max over the exact cone. The inscribed pyramid needs at least as much, so wrenches are taken in the
/// order of its answer, and the rest are skipped once it needs no more than the worst cone found. Loads the
/// pyramid cannot resist come first, in the list's order.
ForceVerdict evaluate_cone(SqueezeSolver& solver, std::span<const model::Wrench> wrenches,
                           const ForceOptions& options, std::vector<double>& forces_n) {
  forces_n.clear();
  for (const model::Wrench& wrench : wrenches) forces_n.push_back(force_n(solver.least_squeeze(wrench)));
  std::vector<std::size_t> order(wrenches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return forces_n[a] > forces_n[b]; });
  std::vector<double> cone_n(wrenches.size(), 0.0);
  double worst_n = 0;
  for (const std::size_t i : order) {
    if (forces_n[i] <= worst_n * (1 - kEqual)) break;
    cone_n[i] = force_n(solver.least_squeeze(wrenches[i], model::FrictionModel::Cone));
    if (std::isinf(cone_n[i])) return NotResistable{i};
    worst_n = std::max(worst_n, cone_n[i]);
    if (options.stop_above_n && worst_n > *options.stop_above_n) return TooStrong{worst_n, i};
  }
  return verdict_of(worst_of(cone_n), options);
}

/// A solver and its scratch memory, one a thread.
struct Worker {
  SqueezeSolver solver;
  std::vector<double> forces_n;

  ForceVerdict verdict(const Grasp& grasp, std::span<const model::Wrench> wrenches,
                       const ForceOptions& options) {
    if (const auto jaw = wedging_jaw(grasp)) return Wedges{*jaw};
    if (const auto contact = jamming_contact(grasp)) return Jams{contact->pin};
    solver.take(grasp);
    return options.friction == model::FrictionModel::Cone
               ? evaluate_cone(solver, wrenches, options, forces_n)
               : evaluate_pyramid(solver, wrenches, options, forces_n);
  }
};

}  // namespace

ForceVerdict evaluate(const Grasp& grasp, std::span<const model::Wrench> wrenches,
                      const ForceOptions& options) {
  return Worker().verdict(grasp, wrenches, options);
}

std::vector<ForceVerdict> evaluate_all(std::span<const Grasp> grasps, std::span<const model::Wrench> wrenches,
                                       const ForceOptions& options, int threads) {
  std::vector<ForceVerdict> verdicts(grasps.size());
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  tbb::enumerable_thread_specific<Worker> workers;
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, grasps.size(), [&](std::size_t i) {
      verdicts[i] = workers.local().verdict(grasps[i], wrenches, options);
    });
  });
  return verdicts;
}

}  // namespace pinjaw::planner

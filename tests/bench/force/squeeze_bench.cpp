// Squeeze programs: ours beside GLPK, CLP and a plain dense tableau, and the exact cone beside NLopt.
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/planner/force/squeeze.hpp"
#include "tests/bench/force/solvers.hpp"
#include "tests/bench/suites.hpp"
#include "tests/bench/support/cpu_time.hpp"

namespace pinjaw::bench {
namespace {

namespace kernel = planner::kernel;
using planner::Required;
using planner::SqueezeSolver;

constexpr int kGrasps = 40;     // of ours, whose times are short
constexpr int kPeerGrasps = 5;  // of the general solvers
constexpr int kRepeats = 7;     // the median counts
constexpr int kRounds = 5;      // of ours a turn: a plan rates thousands of grasps on end
constexpr int kAgain = 20;      // times over the loads of a grasp whose vertices are known
constexpr int kNloptLoads = 4;  // of one grasp: SLSQP is slow

/// With what the memory knows of the grasp.
double sum_by_kernel(const kernel::Kernel& kernel, kernel::Memory& memory,
                     std::vector<kernel::Answer>& answers, const Case& one) {
  kernel.solve(one.program, memory, one.loads.front().b, kStride, kLoads, answers.data());
  double sum = 0;
  for (const kernel::Answer& answer : answers)
    sum += answer.status == kernel::Status::Optimal ? answer.value : 0;
  return sum;
}

/// A kernel that has met a grasp's loads before, all of them: what a look-up and its certificate cost.
class Explored {
 public:
  explicit Explored(const kernel::Kernel& kernel) : kernel_(kernel) {}

  double sum_again(const Case& one) {
    auto& memory = of_case_[&one];
    if (!memory) {
      memory = std::make_unique<kernel::Memory>();
      kernel::forget(*memory);
      sum_by_kernel(kernel_, *memory, answers_, one);
    }
    double sum = 0;
    for (int i = 0; i < kAgain; ++i) sum += sum_by_kernel(kernel_, *memory, answers_, one);
    return sum / kAgain;
  }

 private:
  const kernel::Kernel& kernel_;
  std::vector<kernel::Answer> answers_ = std::vector<kernel::Answer>(kLoads);
  std::map<const Case*, std::unique_ptr<kernel::Memory>> of_case_;
};

/// As a plan does it: the grasp taken, its program made, its loads brought to its frame, every answer's
/// certificate looked at and doubtful ones solved again.
double sum_by_solver(SqueezeSolver& solver, std::vector<planner::SqueezeOutcome>& outcomes, const Case& one) {
  solver.take(one.grasp);
  solver.least_squeeze_all(one.wrenches, outcomes);
  double sum = 0;
  for (const auto& outcome : outcomes) {
    if (const auto* required = std::get_if<Required>(&outcome)) sum += required->force_n;
  }
  return sum;
}

double sum_by_cone(SqueezeSolver& solver, const Case& one) {
  solver.take(one.grasp);
  double sum = 0;
  for (const model::Wrench& wrench : one.wrenches) {
    const auto outcome = solver.least_squeeze(wrench, model::FrictionModel::Cone);
    if (const auto* required = std::get_if<Required>(&outcome)) sum += required->force_n;
  }
  return sum;
}

double sum_by_nlopt(const Case& one) {
  double sum = 0;
  for (int i = 0; i < kNloptLoads; ++i)
    sum += planner::cone_squeeze_by_nlopt_n(one.grasp, one.wrenches[static_cast<std::size_t>(i)]).value_or(0);
  return sum;
}

/// One solver on a number of cases: its sum over the first few, which all must agree on, and its work.
struct Entry {
  std::string name;
  int grasps;  ///< in turn, from the first again after the last
  std::function<double(const Case&)> sum;
  int times = 1;  ///< that `sum` solves each load
  double us = 0;  ///< a load
  double first_sum = 0;
};

void measure(std::vector<Entry>& entries, const Cases& cases, int loads) {
  std::vector<Contestant> contestants;
  for (Entry& entry : entries) {
    contestants.push_back({entry.name, [&cases, &entry] {
                             entry.first_sum = 0;
                             for (int i = 0; i < entry.grasps; ++i) {
                               const double sum =
                                   entry.sum(*cases[static_cast<std::size_t>(i) % cases.size()]);
                               if (i < kPeerGrasps) entry.first_sum += sum;
                             }
                           }});
  }
  const std::vector<double> seconds = median_cpu_s(contestants, kRepeats);
  for (std::size_t i = 0; i < entries.size(); ++i)
    entries[i].us = 1e6 * seconds[i] / (static_cast<double>(entries[i].grasps) * loads * entries[i].times);
}

void expect_agreement(const std::vector<Entry>& entries) {
  for (const Entry& entry : entries) {
    if (std::abs(entry.first_sum - entries.front().first_sum) > 1e-6 * std::abs(entries.front().first_sum))
      throw std::runtime_error(entry.name + " finds other forces than " + entries.front().name);
  }
}

/// What is asked of each instruction set against a peer.
struct Bars {
  double glpk = 0;
  double clp = 0;
  double tableau = 0;
};

Bars bars_of(const std::string& kernel) {
  if (kernel == "avx512") return {60, 80, 10};
  if (kernel == "avx2") return {15, 0, 0};
  return {};
}

void measure_programs(Report& report, const std::string& family, const Cases& cases) {
  const auto memory = std::make_unique<kernel::Memory>();
  std::vector<kernel::Answer> answers(kLoads);
  SqueezeSolver solver;
  std::vector<planner::SqueezeOutcome> outcomes;
  const auto grasps = kRounds * static_cast<int>(cases.size());
  std::vector<Entry> entries;
  int count = 0;
  const kernel::Kernel* const* kernels = kernel::kernels(count);
  for (int k = count - 1; k >= 0; --k) {
    entries.push_back({kernels[k]->name, grasps, [&, k](const Case& one) {
                         kernel::forget(*memory);
                         return sum_by_kernel(*kernels[k], *memory, answers, one);
                       }});
  }
  Explored explored(kernel::best_kernel());
  entries.push_back({std::string(kernel::best_kernel().name) + ", vertices known", kPeerGrasps,
                     [&](const Case& one) { return explored.sum_again(one); }, kAgain});
  entries.push_back(
      {"SqueezeSolver", grasps, [&](const Case& one) { return sum_by_solver(solver, outcomes, one); }});
  const auto first_peer = entries.size();
  entries.push_back({"Eigen dense tableau, cold", kPeerGrasps, sum_by_tableau});
  entries.push_back({"GLPK, warm dual", kPeerGrasps, [](const Case& one) { return sum_by_glpk(one, true); }});
  entries.push_back(
      {"GLPK, cold primal", kPeerGrasps, [](const Case& one) { return sum_by_glpk(one, false); }});
  entries.push_back(
      {"CLP, warm dual()", kPeerGrasps, [](const Case& one) { return sum_by_clp(one, false); }});
  entries.push_back(
      {"CLP, warm dual(0, 7)", kPeerGrasps, [](const Case& one) { return sum_by_clp(one, true); }});
  measure(entries, cases, kLoads);
  expect_agreement(entries);
  for (std::size_t i = 0; i < first_peer; ++i) {
    const Bars bars = bars_of(entries[i].name);
    const std::array<double, 5> at_least{bars.tableau, bars.glpk, 0, bars.clp, bars.clp};
    Measurement measured{"squeeze program, 8 contacts, " + family + ", " + entries[i].name, "us of CPU time",
                         entries[i].us};
    measured.note = std::to_string(std::lround(entries[i].us * kLoads)) + " us a grasp of " +
                    std::to_string(kLoads) + " loads";
    for (std::size_t p = first_peer; p < entries.size(); ++p)
      measured.peers.push_back({entries[p].name, entries[p].us, at_least[p - first_peer]});
    report.add(std::move(measured));
  }
}

void measure_cone(Report& report, const Cases& cases) {
  SqueezeSolver solver;
  std::vector<Entry> ours{
      {"exact cone", kPeerGrasps, [&](const Case& one) { return sum_by_cone(solver, one); }}};
  std::vector<Entry> nlopt{{"NLopt SLSQP", 1, sum_by_nlopt}};
  measure(ours, cases, kLoads);
  measure(nlopt, cases, kNloptLoads);
  constexpr double kBar = 500;
  report.add({"exact cone, 8 contacts, pyramid's program included",
              "us of CPU time",
              ours[0].us,
              {{nlopt[0].name, nlopt[0].us, kBar}}});
}

}  // namespace

void measure_squeeze(Report& report) {
  const Cases planned = planned_cases(kGrasps);
  measure_programs(report, "planned grasps under sprays", planned);
  measure_programs(report, "convex parts under sprays", convex_part_cases(kGrasps));
  measure_programs(report, "random wrenches", random_wrench_cases(kGrasps));
  measure_cone(report, planned);
}

}  // namespace pinjaw::bench

#include <array>
#include <cmath>
#include <nlopt.hpp>

#include "host/planner/force/ray_program.hpp"
#include "host/planner/force/squeeze.hpp"

namespace pinjaw::planner {
namespace {

/// Variables: (normal, tangential, vertical) force of each contact.
struct Problem {
  std::vector<std::array<double, 18>> columns;  ///< a contact's three unit wrenches, six entries each
  std::vector<double> cost;
  std::array<double, kernel::kRows> right{};
  double mu = 0;
  double rounding_n = 0;  ///< of the cones' tips

  [[nodiscard]] std::size_t variables() const { return 3 * columns.size(); }
};

Problem problem_of(const Grasp& grasp, const GraspFrame& frame, const std::array<double, kernel::kRows>& b) {
  Problem problem;
  problem.mu = grasp.mu;
  problem.right = b;
  for (const PointContact& contact : grasp.contacts) {
    const Vector3d arm = (contact.p_P_mm - frame.p_PMean_mm) / frame.length_mm;
    const std::array<Vector3d, 3> axes{Vector3d(contact.n_P.x(), contact.n_P.y(), 0),
                                       Vector3d(-contact.n_P.y(), contact.n_P.x(), 0), Vector3d::UnitZ()};
    std::array<double, 18> columns{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& f = axes[k];
      const Vector3d moment(arm.y() * f.z() - arm.z() * f.y(), arm.z() * f.x() - arm.x() * f.z(),
                            arm.x() * f.y() - arm.y() * f.x());
      for (int i = 0; i < 3; ++i) {
        columns[6 * k + static_cast<std::size_t>(i)] = f[i];
        columns[6 * k + 3 + static_cast<std::size_t>(i)] = moment[i];
      }
      problem.cost.push_back(squeeze_share(grasp, contact, f));
    }
    problem.columns.push_back(columns);
  }
  return problem;
}

double objective(const std::vector<double>& x, std::vector<double>& gradient, void* data) {
  const auto& problem = *static_cast<const Problem*>(data);
  double sum = 0;
  for (std::size_t j = 0; j < x.size(); ++j) sum += problem.cost[j] * x[j];
  if (!gradient.empty()) gradient = problem.cost;
  return sum;
}

/// W c - b = 0, six rows.
void balance(unsigned rows, double* result, unsigned count, const double* x, double* gradient, void* data) {
  const auto& problem = *static_cast<const Problem*>(data);
  for (std::size_t i = 0; i < rows; ++i) {
    result[i] = -problem.right[i];
    for (std::size_t j = 0; j < count; ++j) {
      const double entry = problem.columns[j / 3][6 * (j % 3) + i];
      result[i] += entry * x[j];
      if (gradient != nullptr) gradient[i * count + j] = entry;
    }
  }
}

/// sqrt(t^2 + z^2 + r^2) - r - mu n <= 0: the cone with its tip rounded by r, so that it is smooth and its
/// gradient never 0.
void friction(unsigned rows, double* result, unsigned count, const double* x, double* gradient, void* data) {
  const auto& problem = *static_cast<const Problem*>(data);
  const double r = problem.rounding_n;
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = x[3 * i + 1];
    const double z = x[3 * i + 2];
    const double slip = std::sqrt(t * t + z * z + r * r);
    result[i] = slip - r - problem.mu * x[3 * i];
    if (gradient == nullptr) continue;
    for (std::size_t j = 0; j < count; ++j) gradient[i * count + j] = 0;
    gradient[i * count + 3 * i] = -problem.mu;
    gradient[i * count + 3 * i + 1] = t / slip;
    gradient[i * count + 3 * i + 2] = z / slip;
  }
}

std::vector<double> start_of(const Grasp& grasp, const std::vector<Vector3d>& forces_n) {
  std::vector<double> x;
  for (std::size_t i = 0; i < forces_n.size(); ++i) {
    const Vector2d& n = grasp.contacts[i].n_P;
    const Vector3d& f = forces_n[i];
    x.push_back(n.x() * f.x() + n.y() * f.y());
    x.push_back(-n.y() * f.x() + n.x() * f.y());
    x.push_back(f.z());
  }
  return x;
}

/// One run of SLSQP from `x`, which it improves; nothing where it does not settle.
std::optional<double> settled_n(Problem& problem, std::vector<double>& x, double tolerance_n) {
  const auto count = static_cast<unsigned>(problem.variables());
  nlopt::opt optimizer(nlopt::LD_SLSQP, count);
  optimizer.set_min_objective(objective, &problem);
  std::vector<double> lower(count, -HUGE_VAL);
  for (std::size_t i = 0; i < lower.size(); i += 3) lower[i] = 0;
  optimizer.set_lower_bounds(lower);
  optimizer.add_equality_mconstraint(balance, &problem,
                                     std::vector<double>(kernel::kRows, tolerance_n * 1e-3));
  optimizer.add_inequality_mconstraint(friction, &problem,
                                       std::vector<double>(problem.columns.size(), tolerance_n * 1e-3));
  constexpr double kSettled = 1e-12;
  constexpr int kMostSteps = 2000;
  optimizer.set_ftol_rel(kSettled);
  optimizer.set_maxeval(kMostSteps);
  double value = 0;
  if (optimizer.optimize(x, value) == nlopt::MAXEVAL_REACHED) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> cone_squeeze_by_nlopt_n(const Grasp& grasp, const model::Wrench& wrench,
                                              double tolerance_n) {
  SqueezeSolver solver(grasp);
  const auto forces_n = solver.balancing_forces_n(wrench);
  if (!forces_n) return std::nullopt;
  const GraspFrame frame = frame_of(grasp);
  Problem problem = problem_of(grasp, frame, frame.right_hand_side(wrench));
  std::vector<double> x = start_of(grasp, *forces_n);
  std::optional<double> found_n;
  try {
    for (const double rounding :
         {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {  // of the load, each from the last one's answer
      problem.rounding_n = rounding * wrench.head<3>().norm();
      found_n = settled_n(problem, x, tolerance_n);
    }
  } catch (const std::exception&) {
    return std::nullopt;  // NLopt throws where roundoff stops it
  }
  return found_n;
}

}  // namespace pinjaw::planner

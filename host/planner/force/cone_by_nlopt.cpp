#include <nlopt.hpp>

#include <array>
#include <cmath>

#include "host/planner/force/ray_program.hpp"
#include "host/planner/force/squeeze.hpp"

namespace pinjaw::planner {
namespace {

/// Variables: (normal, tangential, vertical) force of each contact, divided by `scale_n`.
struct Problem {
  std::vector<std::array<double, 18>> columns;  ///< a contact's three unit wrenches, six entries each
  std::vector<double> cost;
  std::array<double, kernel::kRows> right{};
  double mu = 0;

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

/// (t^2 + z^2) - mu^2 n^2 <= 0 with n >= 0: the cone, smooth but at its tip.
void friction(unsigned rows, double* result, unsigned count, const double* x, double* gradient, void* data) {
  const auto& problem = *static_cast<const Problem*>(data);
  for (std::size_t i = 0; i < rows; ++i) {
    const double n = x[3 * i];
    const double t = x[3 * i + 1];
    const double z = x[3 * i + 2];
    result[i] = t * t + z * z - problem.mu * problem.mu * n * n;
    if (gradient == nullptr) continue;
    for (std::size_t j = 0; j < count; ++j) gradient[i * count + j] = 0;
    gradient[i * count + 3 * i] = -2 * problem.mu * problem.mu * n;
    gradient[i * count + 3 * i + 1] = 2 * t;
    gradient[i * count + 3 * i + 2] = 2 * z;
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

}  // namespace

std::optional<double> cone_squeeze_by_nlopt_n(const Grasp& grasp, const model::Wrench& wrench, double tolerance_n) {
  SqueezeSolver solver(grasp);
  const auto forces_n = solver.balancing_forces_n(wrench);
  if (!forces_n) return std::nullopt;
  const GraspFrame frame = frame_of(grasp);
  Problem problem = problem_of(grasp, frame, frame.right_hand_side(wrench));
  try {
    const auto count = static_cast<unsigned>(problem.variables());
    nlopt::opt optimizer(nlopt::LD_SLSQP, count);
    optimizer.set_min_objective(objective, &problem);
    std::vector<double> lower(count, -HUGE_VAL);
    for (std::size_t i = 0; i < lower.size(); i += 3) lower[i] = 0;
    optimizer.set_lower_bounds(lower);
    optimizer.add_equality_mconstraint(balance, &problem, std::vector<double>(kernel::kRows, tolerance_n * 1e-3));
    optimizer.add_inequality_mconstraint(friction, &problem,
                                         std::vector<double>(grasp.contacts.size(), tolerance_n * 1e-3));
    optimizer.set_ftol_rel(1e-12);
    optimizer.set_maxeval(2000);
    std::vector<double> x = start_of(grasp, *forces_n);
    double value = 0;
    const nlopt::result result = optimizer.optimize(x, value);
    if (result == nlopt::MAXEVAL_REACHED) return std::nullopt;
    return value;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace pinjaw::planner

#include "host/planner/force/squeeze.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "host/planner/force/closure.hpp"
#include "host/planner/force/cone.hpp"
#include "host/planner/force/exact_tableau.hpp"
#include "host/planner/force/kernel.hpp"
#include "host/planner/force/ray_program.hpp"

namespace pinjaw::planner {
namespace {

using RightHandSide = std::array<double, kernel::kRows>;

/// The pyramid's optimum in terms of its columns, with the basis rays where the kernel found them.
struct PyramidOptimum {
  SqueezeOutcome outcome = Unresistable{};
  std::array<double, kernel::kColumns> x{};
  std::array<int, kernel::kRows> basis{-1, -1, -1, -1, -1, -1};
  bool has_basis = false;
};

}  // namespace

struct SqueezeSolver::Impl {
  Grasp grasp;
  GraspFrame frame;
  kernel::Program program{};
  std::unique_ptr<kernel::Memory> memory = std::make_unique<kernel::Memory>();
  const kernel::Kernel& kernel = kernel::best_kernel();
  std::optional<ConeProgram> cone;
  bool jams = false;
  int exact_solves = 0;

  [[nodiscard]] int columns() const { return 4 * static_cast<int>(grasp.contacts.size()); }
  [[nodiscard]] bool suits_kernel() const { return program.least_cost > 0; }

  void take(const Grasp& taken) {
    grasp = taken;
    frame = frame_of(grasp);
    fill_program(grasp, frame, grasp.mu / std::sqrt(2.0), program);
    kernel::forget(*memory);
    cone.reset();
    jams = jamming_contact(grasp).has_value();
  }

  PyramidOptimum solve_exactly(const RightHandSide& b) {
    ++exact_solves;
    PyramidOptimum optimum;
    const TableauOutcome outcome = solve_in_quadruple_precision(program, columns(), b);
    if (const auto* found = std::get_if<TableauOptimum>(&outcome)) {
      optimum.outcome = Required{found->value, 0};
      optimum.x = found->x;
    } else if (std::holds_alternative<Unbounded>(outcome)) {
      optimum.outcome = Unbounded{};
    }
    return optimum;
  }

  /// The value alone: the path that evaluation runs hot.
  SqueezeOutcome pyramid(const RightHandSide& b) {
    if (suits_kernel()) {
      kernel::Answer answer;
      kernel.solve(program, *memory, b.data(), answer);
      if (answer.status == kernel::Status::Optimal) return Required{std::max(0.0, answer.value), 0};
      if (answer.status == kernel::Status::Infeasible) return Unresistable{};
    }
    return solve_exactly(b).outcome;
  }

  PyramidOptimum pyramid_in_full(const RightHandSide& b) {
    if (suits_kernel()) {
      kernel::Answer answer;
      kernel.solve(program, *memory, b.data(), answer);
      if (answer.status == kernel::Status::Infeasible) return {};
      if (answer.status == kernel::Status::Optimal) {
        PyramidOptimum optimum;
        optimum.outcome = Required{std::max(0.0, answer.value), 0};
        optimum.has_basis = !answer.basis->has_logical;
        for (int i = 0; i < kernel::kRows; ++i) {
          const int column = answer.basis->column[i];
          optimum.basis[static_cast<std::size_t>(i)] = column;
          if (column >= 0) optimum.x[static_cast<std::size_t>(column)] = std::max(0.0, answer.x[i]);
        }
        return optimum;
      }
    }
    return solve_exactly(b);
  }

  [[nodiscard]] Vector3d ray(std::size_t column) const {
    return pyramid_rays(grasp.contacts[column / 4], grasp.mu / std::sqrt(2.0))[column % 4];
  }

  /// Without friction the cone is the pyramid. Its certificate needs every share above 0: a grasp that does
  /// not jam.
  SqueezeOutcome exact_cone(const RightHandSide& b) {
    if (grasp.mu <= 0) return pyramid(b);
    if (jams) return Unbounded{};
    const PyramidOptimum start = pyramid_in_full(b);
    std::vector<ConeProgram::Ray> rays;
    if (start.has_basis) {
      for (const int column : start.basis)
        rays.push_back({column / 4, ray(static_cast<std::size_t>(column))});
    }
    if (!cone) cone.emplace(grasp, frame);
    return cone->solve(b, rays);
  }
};

SqueezeSolver::SqueezeSolver() : impl_(std::make_unique<Impl>()) {}
SqueezeSolver::SqueezeSolver(const Grasp& grasp) : SqueezeSolver() {
  take(grasp);
}
SqueezeSolver::SqueezeSolver(SqueezeSolver&&) noexcept = default;
SqueezeSolver& SqueezeSolver::operator=(SqueezeSolver&&) noexcept = default;
SqueezeSolver::~SqueezeSolver() = default;

void SqueezeSolver::take(const Grasp& grasp) {
  impl_->take(grasp);
}

SqueezeOutcome SqueezeSolver::least_squeeze(const model::Wrench& wrench, model::FrictionModel friction) {
  const RightHandSide b = impl_->frame.right_hand_side(wrench);
  return friction == model::FrictionModel::Cone ? impl_->exact_cone(b) : impl_->pyramid(b);
}

std::optional<std::vector<Vector3d>> SqueezeSolver::balancing_forces_n(const model::Wrench& wrench,
                                                                       model::FrictionModel friction) {
  const RightHandSide b = impl_->frame.right_hand_side(wrench);
  if (friction == model::FrictionModel::Cone && impl_->grasp.mu > 0) {
    if (!std::holds_alternative<Required>(impl_->exact_cone(b))) return std::nullopt;
    return impl_->cone->forces_n();
  }
  const PyramidOptimum optimum = impl_->pyramid_in_full(b);
  if (!std::holds_alternative<Required>(optimum.outcome)) return std::nullopt;
  std::vector<Vector3d> forces_n(impl_->grasp.contacts.size(), Vector3d::Zero());
  for (std::size_t column = 0; column < 4 * forces_n.size(); ++column) {
    forces_n[column / 4] += optimum.x[column] * impl_->ray(column);
  }
  return forces_n;
}

double SqueezeSolver::lower_bound_n(const model::Wrench& wrench) const {
  if (!impl_->suits_kernel()) return -std::numeric_limits<double>::infinity();
  return impl_->kernel.lower_bound(*impl_->memory, impl_->frame.right_hand_side(wrench).data());
}

int SqueezeSolver::exact_solves() const {
  return impl_->exact_solves;
}

}  // namespace pinjaw::planner

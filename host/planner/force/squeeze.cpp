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

/// The pyramid's optimum in terms of its rays, columns 4 i + k for edge k of contact i.
struct PyramidOptimum {
  SqueezeOutcome outcome = Unresistable{};
  std::vector<RayAmount> rays;
};

/// Right-hand sides as the kernel takes them: entry k of the i-th is row(k)[i].
class KernelLoads {
 public:
  void resize(std::size_t count) {
    stride_ = (count + kernel::kLanes - 1) / kernel::kLanes * kernel::kLanes;
    blocks_.resize(kernel::kRows * stride_ / kernel::kLanes);
  }
  double* row(int k) { return &blocks_.front().entry[0] + static_cast<std::size_t>(k) * stride_; }
  [[nodiscard]] int stride() const { return static_cast<int>(stride_); }

  RightHandSide at(std::size_t i) {
    RightHandSide b{};
    for (int k = 0; k < kernel::kRows; ++k) b[static_cast<std::size_t>(k)] = row(k)[i];
    return b;
  }
  void put(std::size_t i, const RightHandSide& b) {
    for (int k = 0; k < kernel::kRows; ++k) row(k)[i] = b[static_cast<std::size_t>(k)];
  }

 private:
  struct alignas(64) Block {
    double entry[kernel::kLanes] = {};
  };
  std::size_t stride_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace

struct SqueezeSolver::Impl {
  Grasp grasp;
  GraspFrame frame;
  kernel::Program program{};
  std::unique_ptr<kernel::Memory> memory = std::make_unique_for_overwrite<kernel::Memory>();
  const kernel::Kernel& kernel = kernel::best_kernel();
  std::optional<ConeProgram> cone;
  std::optional<RayProgram> rays;
  KernelLoads loads;
  std::vector<kernel::Answer> answers;
  bool jams = false;
  int exact_solves = 0;

  [[nodiscard]] double half_width() const { return grasp.mu / std::sqrt(2.0); }
  [[nodiscard]] bool suits_kernel() const { return program.least_cost > 0; }

  void take(const Grasp& taken) {
    grasp = taken;
    frame = frame_of(grasp);
    fill_program(grasp, frame, half_width(), program);
    kernel::forget(*memory);
    cone.reset();
    rays.reset();
    jams = jamming_contact(grasp).has_value();
  }

  PyramidOptimum solve_exactly(const RightHandSide& b) {
    ++exact_solves;
    if (!rays) rays = ray_program_of(grasp, frame, half_width());
    PyramidOptimum optimum;
    const TableauOutcome outcome = solve_in_quadruple_precision(*rays, b);
    if (const auto* found = std::get_if<TableauOptimum>(&outcome)) {
      optimum.outcome = Required{found->value, 0};
      for (std::size_t column = 0; column < rays->cost.size(); ++column) {
        if (found->x[column] > 0) optimum.rays.push_back({static_cast<int>(column), found->x[column]});
      }
    } else if (std::holds_alternative<Unbounded>(outcome)) {
      optimum.outcome = Unbounded{};
    }
    return optimum;
  }

  /// What the kernel says of one load; doubtful where the grasp does not suit it.
  kernel::Answer by_kernel(const RightHandSide& b) {
    kernel::Answer answer;
    loads.resize(1);
    loads.put(0, b);
    if (!suits_kernel()) return answer;
    kernel.solve(program, *memory, loads.row(0), loads.stride(), 1, &answer);
    return answer;
  }

  /// Of load `i` of `loads`.
  SqueezeOutcome outcome_of(const kernel::Answer& answer, std::size_t i) {
    if (answer.status == kernel::Status::Optimal) return Required{std::max(0.0, answer.value), 0};
    if (answer.status == kernel::Status::Infeasible) return Unresistable{};
    return solve_exactly(loads.at(i)).outcome;
  }

  SqueezeOutcome pyramid(const RightHandSide& b) { return outcome_of(by_kernel(b), 0); }

  void pyramid_all(std::span<const model::Wrench> wrenches, std::vector<SqueezeOutcome>& outcomes) {
    outcomes.clear();
    if (wrenches.empty()) return;
    loads.resize(wrenches.size());
    answers.assign(wrenches.size(), {});
    for (std::size_t i = 0; i < wrenches.size(); ++i) loads.put(i, frame.right_hand_side(wrenches[i]));
    if (suits_kernel()) {
      kernel.solve(program, *memory, loads.row(0), loads.stride(), static_cast<int>(wrenches.size()),
                   answers.data());
    }
    for (std::size_t i = 0; i < wrenches.size(); ++i) outcomes.push_back(outcome_of(answers[i], i));
  }

  PyramidOptimum pyramid_in_full(const RightHandSide& b) {
    const kernel::Answer answer = by_kernel(b);
    if (answer.status == kernel::Status::Doubtful) return solve_exactly(b);
    PyramidOptimum optimum;
    if (answer.status == kernel::Status::Infeasible) return optimum;
    optimum.outcome = Required{std::max(0.0, answer.value), 0};
    optimum.rays = balancing_rays(program, *answer.vertex, b);
    return optimum;
  }

  [[nodiscard]] Vector3d ray(int column) const {
    const auto at = static_cast<std::size_t>(column);
    return pyramid_rays(grasp.contacts[at / 4], half_width())[at % 4];
  }

  /// Without friction the cone is the pyramid. Its certificate needs every share above 0: a grasp that does
  /// not jam.
  SqueezeOutcome exact_cone(const RightHandSide& b) {
    if (grasp.mu <= 0) return pyramid(b);
    if (jams) return Unbounded{};
    const PyramidOptimum start = pyramid_in_full(b);
    std::vector<ConeProgram::Ray> start_rays;
    if (start.rays.size() == kernel::kRows) {
      for (const RayAmount& of : start.rays) start_rays.push_back({of.column / 4, ray(of.column)});
    }
    if (!cone) cone.emplace(grasp, frame);
    return cone->solve(b, start_rays);
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
  for (const RayAmount& of : optimum.rays) {
    forces_n[static_cast<std::size_t>(of.column) / 4] += of.amount * impl_->ray(of.column);
  }
  return forces_n;
}

void SqueezeSolver::least_squeeze_all(std::span<const model::Wrench> wrenches,
                                      std::vector<SqueezeOutcome>& outcomes) {
  impl_->pyramid_all(wrenches, outcomes);
}

int SqueezeSolver::exact_solves() const {
  return impl_->exact_solves;
}

}  // namespace pinjaw::planner

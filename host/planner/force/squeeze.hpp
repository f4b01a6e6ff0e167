#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "host/model/task.hpp"
#include "host/planner/force/grasp.hpp"

namespace pinjaw::planner {

/// The least squeeze force that can balance a wrench (BB 3.5.2): the sum over both jaws along the closing
/// axis. Below 0 only for a grasp that jams.
struct Required {
  double force_n = 0;
  /// Certified: force_n is at most this above the true least force (0: exact to rounding). At most 1e-9
  /// max(1, force_n) but where the cone's simplex was stopped by its limit of steps; force_n is then an upper
  /// bound.
  double gap_n = 0;
};

/// No squeeze, however large, balances the wrench (for the cone: none under a billion times the wrench).
struct Unresistable {};

/// Some internal force has a negative squeeze: there is no least one. Never for a grasp that does not jam.
/// With the cone, also the answer for every grasp that jams: its certificate does not cover those.
struct Unbounded {};

using SqueezeOutcome = std::variant<Required, Unresistable, Unbounded>;

/// The squeeze force of one grasp for any number of wrenches.
///
/// Pyramid: BB's linear program with mu/sqrt 2, by a dual simplex that keeps the dual vertices it has met,
/// since only the right-hand side changes from wrench to wrench; each answer is certified, and solved again
/// in quadruple precision where the certificate is too wide. Cone: the exact Coulomb cone, by a primal
/// simplex over the continuum of its rays from the pyramid's basis, stopped by a certified gap. Not for
/// concurrent use; one solver a thread.
class SqueezeSolver {
 public:
  explicit SqueezeSolver(const Grasp& grasp);
  SqueezeSolver();  ///< call take() before anything else
  SqueezeSolver(SqueezeSolver&&) noexcept;
  SqueezeSolver& operator=(SqueezeSolver&&) noexcept;
  ~SqueezeSolver();

  /// Forgets the grasp at hand and takes another; its workspace is kept.
  void take(const Grasp& grasp);

  /// `wrench` acts on the part: N and N mm about the origin of the turned part frame, in its axes.
  SqueezeOutcome least_squeeze(const model::Wrench& wrench,
                               model::FrictionModel friction = model::FrictionModel::Pyramid);

  /// least_squeeze() of each wrench for the pyramid, in their order: quicker than one by one. `outcomes` is
  /// overwritten.
  void least_squeeze_all(std::span<const model::Wrench> wrenches, std::vector<SqueezeOutcome>& outcomes);

  /// The contact forces on the part, one a contact in the grasp's order, in the turned part frame, that
  /// balance `wrench` with the least squeeze; nothing where least_squeeze() has no Required.
  std::optional<std::vector<Vector3d>> balancing_forces_n(
      const model::Wrench& wrench, model::FrictionModel friction = model::FrictionModel::Pyramid);

  /// Answers that had to be solved again in quadruple precision since the solver was made.
  int exact_solves() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The exact cone by a general non-linear solver (NLopt's SLSQP), slow and independent of SqueezeSolver: a
/// check for top designs, good to some 1e-3 of the force. Nothing where the solver does not settle;
/// constraints hold to a thousandth of `tolerance_n`.
std::optional<double> cone_squeeze_by_nlopt_n(const Grasp& grasp, const model::Wrench& wrench,
                                              double tolerance_n = 1e-6);

}  // namespace pinjaw::planner

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "host/planner/force/kernel.hpp"
#include "host/planner/force/ray_program.hpp"
#include "host/planner/force/squeeze.hpp"

namespace pinjaw::planner {

/// The exact Coulomb cone |f_t| <= mu f_n of every contact, in the coordinates of a GraspFrame.
class ConeProgram {
 public:
  ConeProgram(const Grasp& grasp, const GraspFrame& frame);

  /// A ray of the basis: a contact and a force of its cone; contact -1 is an artificial.
  struct Ray {
    int contact = -1;
    Vector3d force = Vector3d::Zero();
  };

  /// The last optimum's contact forces, one a contact.
  [[nodiscard]] const std::vector<Vector3d>& forces_n() const { return forces_n_; }

  /// Least squeeze for the right-hand side `b`, by a primal simplex that prices the continuum of rays in
  /// closed form (the most negative reduced cost of a cone is u_n - mu |u_t|) and stops when the gap between
  /// its value and the dual bound, y scaled towards 0 until feasible, is at most 1e-9 max(1, F). `start` are
  /// the rays of a feasible basis, such as the pyramid's optimum, whose edges lie on the cone; empty: a first
  /// phase finds one. Needs a grasp that does not jam. Stopped by its limit of steps or by rounding it
  /// returns the forces it has, with their gap, or Unresistable where it has none.
  SqueezeOutcome solve(const std::array<double, kernel::kRows>& b, const std::vector<Ray>& start);

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  struct Contact {
    Vector3d arm;  // from the mean, scaled
    Vector3d normal;
    Vector3d tangent;
    Vector3d closing;        // squeeze per unit force
    double least_share = 0;  // reduced cost at y = 0: n.closing - mu |t.closing|
  };

  struct State {
    std::array<Ray, kernel::kRows> ray;
    Matrix6 columns;
    Matrix6 inverse;
    Vector6 x;
    Vector6 cost;
  };

  enum class End { Settled, Infeasible, Stalled };
  enum class Phase { Feasibility, Squeeze };

  struct Entering {
    Ray ray;
    double reduced_cost = 0;
    double shrink = 1;  // the largest factor that brings y into the dual cone
  };

  [[nodiscard]] Entering price(const Vector6& y, Phase phase) const;
  [[nodiscard]] Vector6 column_of(const Ray& ray) const;
  [[nodiscard]] double cost_of(const Ray& ray, Phase phase) const;
  [[nodiscard]] State artificial_start(const Vector6& b) const;
  [[nodiscard]] State start_from(const std::vector<Ray>& rays, const Vector6& b) const;
  void refresh(State& state, const Vector6& b) const;
  static bool replace(State& state, const Ray& ray, const Vector6& column, double cost);
  End run(State& state, const Vector6& b, Phase phase, double& gap) const;
  void keep_forces(const State& state);

  double mu_ = 0;
  std::vector<Contact> contacts_;
  std::vector<Vector3d> forces_n_;
};

}  // namespace pinjaw::planner

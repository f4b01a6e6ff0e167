#include "host/planner/force/cone.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pinjaw::planner {
namespace {

constexpr double kGap = 1e-9;           // of max(1, F): certified
constexpr double kPivot = 1e-9;         // of the entering column in basis coordinates
constexpr double kFeasible = 1e-10;     // of |b|: artificials below this are 0
constexpr double kUnresistable = 1e-9;  // |b| over the squeeze past which a load counts as unresistable
constexpr int kRefresh = 12;            // pivots between fresh inverses (chosen)
constexpr int kMaxPivots = 400;         // measured: 23 to 30 are usual

}  // namespace

ConeProgram::ConeProgram(const Grasp& grasp, const GraspFrame& frame) : mu_(grasp.mu) {
  for (const PointContact& of : grasp.contacts) {
    Contact contact;
    contact.arm = (of.p_P_mm - frame.p_PMean_mm) / frame.length_mm;
    contact.normal = {of.n_P.x(), of.n_P.y(), 0};
    contact.tangent = {-of.n_P.y(), of.n_P.x(), 0};
    const double sigma = of.jaw == model::JawSide::Left ? 1 : -1;
    contact.closing = sigma * Vector3d(grasp.x_P.x(), grasp.x_P.y(), 0);
    contact.least_share =
        contact.closing.dot(contact.normal) - mu_ * std::abs(contact.closing.dot(contact.tangent));
    contacts_.push_back(contact);
  }
}

ConeProgram::Vector6 ConeProgram::column_of(const Ray& ray) const {
  Vector6 column;
  const Vector3d& arm = contacts_[static_cast<std::size_t>(ray.contact)].arm;
  column << ray.force, arm.cross(ray.force);
  return column;
}

double ConeProgram::cost_of(const Ray& ray, Phase phase) const {
  if (ray.contact < 0) return phase == Phase::Feasibility ? 1 : 0;
  return phase == Phase::Feasibility
             ? 0
             : contacts_[static_cast<std::size_t>(ray.contact)].closing.dot(ray.force);
}

ConeProgram::Entering ConeProgram::price(const Vector6& y, Phase phase) const {
  Entering best;
  const Vector3d force = y.head<3>();
  const Vector3d torque = y.tail<3>();
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& contact = contacts_[i];
    Vector3d slack = -force - torque.cross(contact.arm);
    if (phase == Phase::Squeeze) slack += contact.closing;
    const double along_t = slack.dot(contact.tangent);
    const double along_z = slack.z();
    const double slip = std::sqrt(along_t * along_t + along_z * along_z);
    const double reduced = slack.dot(contact.normal) - mu_ * slip;
    if (reduced < 0)
      best.shrink = std::min(best.shrink, contact.least_share / (contact.least_share - reduced));
    if (reduced >= best.reduced_cost) continue;
    best.reduced_cost = reduced;
    best.ray.contact = static_cast<int>(i);
    best.ray.force = contact.normal;
    if (slip > 0) best.ray.force -= mu_ / slip * (along_t * contact.tangent + along_z * Vector3d::UnitZ());
  }
  return best;
}

ConeProgram::State ConeProgram::artificial_start(const Vector6& b) const {
  State state;
  for (int k = 0; k < kernel::kRows; ++k) state.ray[static_cast<std::size_t>(k)] = {};
  state.columns = Matrix6::Zero();
  for (int k = 0; k < kernel::kRows; ++k) state.columns(k, k) = b[k] < 0 ? -1 : 1;
  state.cost = Vector6::Ones();
  refresh(state, b);
  return state;
}

ConeProgram::State ConeProgram::start_from(const std::vector<Ray>& rays, const Vector6& b) const {
  State state;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const auto row = static_cast<int>(k);
    state.ray[k] = rays[k];
    state.columns.col(row) = column_of(rays[k]);
    state.cost[row] = cost_of(rays[k], Phase::Squeeze);
  }
  refresh(state, b);
  return state;
}

void ConeProgram::refresh(State& state, const Vector6& b) const {
  state.inverse = state.columns.inverse();
  state.x = (state.inverse * b).cwiseMax(0);
}

/// Brings a ray into the basis; false where nothing blocks it. An artificial at 0 leaves as soon as it would
/// move.
bool ConeProgram::replace(State& state, const Ray& ray, const Vector6& column, double cost) {
  const Vector6 w = state.inverse * column;
  const double pivot = kPivot * w.norm();
  int row = -1;
  double step = 0;
  for (int k = 0; k < kernel::kRows; ++k) {
    const bool idle = state.ray[static_cast<std::size_t>(k)].contact < 0 && state.cost[k] == 0;
    if (idle ? std::abs(w[k]) <= pivot : w[k] <= pivot) continue;
    const double here = idle ? 0 : state.x[k] / w[k];
    if (row >= 0 && (here > step || (here == step && std::abs(w[k]) <= std::abs(w[row])))) continue;
    row = k;
    step = here;
  }
  if (row < 0) return false;
  state.x = (state.x - step * w).cwiseMax(0);
  state.x[row] = step;
  Vector6 change = w;
  change[row] -= 1;
  const Eigen::Matrix<double, 1, 6> new_row = state.inverse.row(row) / w[row];
  state.inverse -= change * new_row;
  state.columns.col(row) = column;
  state.ray[static_cast<std::size_t>(row)] = ray;
  state.cost[row] = cost;
  return true;
}

ConeProgram::End ConeProgram::run(State& state, const Vector6& b, Phase phase, double& gap) const {
  const double size = b.lpNorm<Eigen::Infinity>();
  bool is_fresh = false;
  for (int pivots = 0; pivots < kMaxPivots; ++pivots) {
    if (pivots % kRefresh == kRefresh - 1) refresh(state, b);
    const Vector6 y = state.inverse.transpose() * state.cost;
    const Entering entering = price(y, phase);
    const double value = state.cost.dot(state.x);
    if (!std::isfinite(value)) return End::Stalled;
    if (phase == Phase::Feasibility) {
      if (value <= kFeasible * size) return End::Settled;
      if (-entering.reduced_cost * size <= kUnresistable * y.dot(b)) return End::Infeasible;
    } else {
      gap = value - entering.shrink * y.dot(b);
      if (gap <= kGap * std::max(1.0, value)) {
        // what rounding left out of balance changes the least squeeze by at most y times it
        gap = std::max(0.0, gap) + y.lpNorm<1>() * (state.columns * state.x - b).lpNorm<Eigen::Infinity>();
        if (gap <= kGap * std::max(1.0, value)) return End::Settled;
        refresh(state, b);
      }
    }
    if (replace(state, entering.ray, column_of(entering.ray), cost_of(entering.ray, phase))) {
      is_fresh = false;
    } else {
      if (is_fresh) return End::Stalled;  // nothing blocks: rounding, for every ray costs squeeze
      refresh(state, b);
      is_fresh = true;
    }
  }
  return End::Stalled;
}

void ConeProgram::keep_forces(const State& state) {
  forces_n_.assign(contacts_.size(), Vector3d::Zero());
  for (int k = 0; k < kernel::kRows; ++k) {
    const Ray& ray = state.ray[static_cast<std::size_t>(k)];
    if (ray.contact >= 0) forces_n_[static_cast<std::size_t>(ray.contact)] += state.x[k] * ray.force;
  }
}

SqueezeOutcome ConeProgram::solve(const std::array<double, kernel::kRows>& right,
                                  const std::vector<Ray>& start) {
  const Vector6 b = Eigen::Map<const Vector6>(right.data());
  double gap = 0;
  State state = start.empty() ? artificial_start(b) : start_from(start, b);
  if (start.empty()) {
    const End end = run(state, b, Phase::Feasibility, gap);
    if (end != End::Settled) return Unresistable{};
    for (int k = 0; k < kernel::kRows; ++k) {
      const Ray& ray = state.ray[static_cast<std::size_t>(k)];
      state.cost[k] = cost_of(ray, Phase::Squeeze);
    }
  }
  run(state, b, Phase::Squeeze, gap);
  const double value = state.cost.dot(state.x);
  // past which rounding decides: no basis so flat can be told from none
  const bool beyond = !(value * kUnresistable <= b.lpNorm<Eigen::Infinity>()) || !std::isfinite(gap);
  if (beyond) return Unresistable{};
  keep_forces(state);
  return Required{std::max(0.0, value), std::max(0.0, gap)};
}

}  // namespace pinjaw::planner

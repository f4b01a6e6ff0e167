#include "tests/host/planner/force/peers.hpp"

#include <coin/Clp_C_Interface.h>
#include <glpk.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

namespace pinjaw::planner::peers {
namespace {

/// Torques are taken about the contacts' mean and divided by 25 mm, so that the peers' absolute tolerances
/// suit.
constexpr double kLength_mm = 25;
constexpr double kInfinity = 1e30;

struct Column {
  std::array<double, 6> entry{};
  double cost = 0;
};

struct Data {
  std::vector<Column> normal;  ///< one a contact, BB's three groups
  std::vector<Column> across;
  std::vector<Column> vertical;
  std::array<double, 6> right{};
  double half_width = 0;
};

Column unit_wrench(const Grasp& grasp, const PointContact& contact, const Vector3d& mean_mm,
                   const Vector3d& force) {
  Column column;
  const Vector3d torque = (contact.p_P_mm - mean_mm).cross(force) / kLength_mm;
  for (std::size_t k = 0; k < 3; ++k) {
    column.entry[k] = force[static_cast<int>(k)];
    column.entry[3 + k] = torque[static_cast<int>(k)];
  }
  const double sigma = contact.jaw == model::JawSide::Left ? 1 : -1;
  column.cost = sigma * grasp.x_P.dot(force.head<2>());
  return column;
}

Data data_of(const Grasp& grasp, const model::Wrench& wrench) {
  Data data;
  data.half_width = grasp.mu / std::sqrt(2.0);
  Vector3d mean_mm = Vector3d::Zero();
  for (const PointContact& contact : grasp.contacts)
    mean_mm += contact.p_P_mm / static_cast<double>(grasp.contacts.size());
  for (const PointContact& contact : grasp.contacts) {
    const Vector3d n(contact.n_P.x(), contact.n_P.y(), 0);
    data.normal.push_back(unit_wrench(grasp, contact, mean_mm, n));
    data.across.push_back(unit_wrench(grasp, contact, mean_mm, Vector3d::UnitZ().cross(n)));
    data.vertical.push_back(unit_wrench(grasp, contact, mean_mm, Vector3d::UnitZ()));
  }
  const Vector3d force = wrench.head<3>();
  const Vector3d torque = (Vector3d(wrench.tail<3>()) - mean_mm.cross(force)) / kLength_mm;
  for (std::size_t k = 0; k < 3; ++k) {
    data.right[k] = -force[static_cast<int>(k)];
    data.right[3 + k] = -torque[static_cast<int>(k)];
  }
  return data;
}

std::vector<Column> rays_of(const Data& data) {
  std::vector<Column> rays;
  for (std::size_t i = 0; i < data.normal.size(); ++i) {
    for (const double s1 : {-1.0, 1.0}) {
      for (const double s2 : {-1.0, 1.0}) {
        Column ray = data.normal[i];
        for (std::size_t k = 0; k < 6; ++k) {
          ray.entry[k] += data.half_width * (s1 * data.across[i].entry[k] + s2 * data.vertical[i].entry[k]);
        }
        ray.cost += data.half_width * (s1 * data.across[i].cost + s2 * data.vertical[i].cost);
        rays.push_back(ray);
      }
    }
  }
  return rays;
}

void add_column(glp_prob* problem, const Column& column, int bound,
                const std::vector<std::pair<int, double>>& extra) {
  const int j = glp_add_cols(problem, 1);
  glp_set_col_bnds(problem, j, bound, 0, 0);
  glp_set_obj_coef(problem, j, column.cost);
  std::vector<int> rows{0};
  std::vector<double> values{0};
  for (int k = 0; k < 6; ++k) {
    rows.push_back(k + 1);
    values.push_back(column.entry[static_cast<std::size_t>(k)]);
  }
  for (const auto& [row, value] : extra) {
    rows.push_back(row);
    values.push_back(value);
  }
  glp_set_mat_col(problem, j, static_cast<int>(rows.size()) - 1, rows.data(), values.data());
}

glp_prob* balance_rows(const Data& data) {
  glp_prob* problem = glp_create_prob();
  glp_set_obj_dir(problem, GLP_MIN);
  glp_add_rows(problem, 6);
  for (int k = 0; k < 6; ++k) {
    const double right = data.right[static_cast<std::size_t>(k)];
    glp_set_row_bnds(problem, k + 1, GLP_FX, right, right);
  }
  return problem;
}

Result solve(glp_prob* problem) {
  glp_smcp control;
  glp_init_smcp(&control);
  control.msg_lev = GLP_MSG_OFF;
  control.tol_bnd = 1e-9;
  control.tol_dj = 1e-9;
  Result result;
  if (glp_simplex(problem, &control) == 0) {
    const int status = glp_get_status(problem);
    if (status == GLP_OPT) result = {Status::Optimal, glp_get_obj_val(problem)};
    if (status == GLP_NOFEAS) result.status = Status::Infeasible;
    if (status == GLP_UNBND) result.status = Status::Unbounded;
  }
  glp_delete_prob(problem);
  return result;
}

__extension__ using Quad = __float128;

/// Standard-form tableau, dense, every entry in quadruple precision; last row the objective, last column the
/// right side.
class BlandTableau {
 public:
  BlandTableau(const std::vector<Column>& columns, const std::array<double, 6>& right)
      : count_(static_cast<int>(columns.size())), table_(7, std::vector<Quad>(columns.size() + 7)) {
    for (int k = 0; k < 6; ++k) {
      const double sign = right[u(k)] < 0 ? -1 : 1;
      for (int j = 0; j < count_; ++j) table_[u(k)][u(j)] = sign * columns[u(j)].entry[u(k)];
      table_[u(k)][u(count_ + k)] = 1;
      table_[u(k)].back() = sign * right[u(k)];
      basis_.push_back(count_ + k);
      size_ += std::abs(right[u(k)]);
    }
  }

  Result solve(const std::vector<Column>& columns) {
    for (int k = 0; k < 6; ++k) {  // phase 1: the sum of the artificials
      for (std::size_t j = 0; j < table_[0].size(); ++j) {
        if (static_cast<int>(j) < count_ || j + 1 == table_[0].size()) table_[6][j] -= table_[u(k)][j];
      }
    }
    minimise();
    if (-table_[6].back() > 1e-10 * size_) return {Status::Infeasible, 0};
    for (int k = 0; k < 6; ++k) {
      if (basis_[u(k)] < count_) continue;
      int widest = 0;
      for (int j = 0; j < count_; ++j) {
        if (size_of(table_[u(k)][u(j)]) > size_of(table_[u(k)][u(widest)])) widest = j;
      }
      if (size_of(table_[u(k)][u(widest)]) > 1e-12) pivot(k, widest);
    }
    second_phase_ = true;
    std::fill(table_[6].begin(), table_[6].end(), Quad{0});
    for (int j = 0; j < count_; ++j) table_[6][u(j)] = columns[u(j)].cost;
    for (int k = 0; k < 6; ++k) {
      if (basis_[u(k)] >= count_) continue;
      const Quad cost = columns[u(basis_[u(k)])].cost;
      for (std::size_t j = 0; j < table_[0].size(); ++j) table_[6][j] -= cost * table_[u(k)][j];
    }
    if (!minimise()) return {Status::Unbounded, 0};
    return {Status::Optimal, static_cast<double>(-table_[6].back())};
  }

 private:
  static std::size_t u(int i) { return static_cast<std::size_t>(i); }
  static Quad size_of(Quad q) { return q < 0 ? -q : q; }

  bool minimise() {
    for (int pivots = 0; pivots < 5000; ++pivots) {
      int entering = 0;
      while (entering < count_ && table_[6][u(entering)] >= -1e-13) ++entering;
      if (entering == count_) return true;
      int row = -1;
      for (int k = 0; k < 6; ++k) {
        const Quad entry = table_[u(k)][u(entering)];
        if (entry <= 1e-15 || (second_phase_ && basis_[u(k)] >= count_)) continue;
        const Quad ratio = table_[u(k)].back() / entry;
        if (row >= 0) {
          const Quad best = table_[u(row)].back() / table_[u(row)][u(entering)];
          if (ratio > best || (ratio == best && basis_[u(k)] > basis_[u(row)])) continue;
        }
        row = k;
      }
      if (row < 0) return false;
      pivot(row, entering);
    }
    return true;
  }

  void pivot(int row, int entering) {
    const Quad scale = 1 / table_[u(row)][u(entering)];
    for (Quad& entry : table_[u(row)]) entry *= scale;
    for (int k = 0; k < 7; ++k) {
      const Quad factor = table_[u(k)][u(entering)];
      if (k == row || factor == 0) continue;
      for (std::size_t j = 0; j < table_[0].size(); ++j) table_[u(k)][j] -= factor * table_[u(row)][j];
    }
    basis_[u(row)] = entering;
  }

  int count_;
  double size_ = 0;
  bool second_phase_ = false;
  std::vector<std::vector<Quad>> table_;
  std::vector<int> basis_;
};

}  // namespace

Result glpk(const Grasp& grasp, const model::Wrench& wrench) {
  const Data data = data_of(grasp, wrench);
  glp_prob* problem = balance_rows(data);
  for (const Column& ray : rays_of(data)) add_column(problem, ray, GLP_LO, {});
  return solve(problem);
}

Result glpk_paper_form(const Grasp& grasp, const model::Wrench& wrench) {
  const Data data = data_of(grasp, wrench);
  glp_prob* problem = balance_rows(data);
  const int contacts = static_cast<int>(data.normal.size());
  const int first = glp_add_rows(problem, 4 * contacts);
  for (int row = first; row < first + 4 * contacts; ++row) glp_set_row_bnds(problem, row, GLP_LO, 0, 0);
  for (int i = 0; i < contacts; ++i) {  // mu' c_n +- c_t >= 0 and mu' c_n +- c_z >= 0
    const int row = first + 4 * i;
    const double h = data.half_width;
    const auto at = static_cast<std::size_t>(i);
    add_column(problem, data.normal[at], GLP_LO, {{row, h}, {row + 1, h}, {row + 2, h}, {row + 3, h}});
    add_column(problem, data.across[at], GLP_FR, {{row, 1.0}, {row + 1, -1.0}});
    add_column(problem, data.vertical[at], GLP_FR, {{row + 2, 1.0}, {row + 3, -1.0}});
  }
  return solve(problem);
}

Result clp(const Grasp& grasp, const model::Wrench& wrench) {
  const Data data = data_of(grasp, wrench);
  const std::vector<Column> rays = rays_of(data);
  std::vector<CoinBigIndex> starts{0};
  std::vector<int> rows;
  std::vector<double> values;
  std::vector<double> costs;
  for (const Column& ray : rays) {
    for (int k = 0; k < 6; ++k) {
      rows.push_back(k);
      values.push_back(ray.entry[static_cast<std::size_t>(k)]);
    }
    starts.push_back(static_cast<CoinBigIndex>(rows.size()));
    costs.push_back(ray.cost);
  }
  const std::vector<double> lower(rays.size(), 0);
  const std::vector<double> upper(rays.size(), kInfinity);
  Clp_Simplex* model = Clp_newModel();
  Clp_setLogLevel(model, 0);
  Clp_loadProblem(model, static_cast<int>(rays.size()), 6, starts.data(), rows.data(), values.data(),
                  lower.data(), upper.data(), costs.data(), data.right.data(), data.right.data());
  Clp_setPrimalTolerance(model, 1e-9);
  Clp_setDualTolerance(model, 1e-9);
  Clp_primal(model, 0);
  Result result;
  const int status = Clp_status(model);
  if (status == 0) result = {Status::Optimal, Clp_objectiveValue(model)};
  if (status == 1) result.status = Status::Infeasible;
  if (status == 2) result.status = Status::Unbounded;
  Clp_deleteModel(model);
  return result;
}

Result quadruple(const Grasp& grasp, const model::Wrench& wrench, std::optional<double> half_width) {
  Data data = data_of(grasp, wrench);
  if (half_width) data.half_width = *half_width;
  const std::vector<Column> rays = rays_of(data);
  return BlandTableau(rays, data.right).solve(rays);
}

std::string to_string(const Result& result) {
  switch (result.status) {
    case Status::Optimal:
      return "optimal " + std::to_string(result.value);
    case Status::Infeasible:
      return "infeasible";
    case Status::Unbounded:
      return "unbounded";
    case Status::Failed:
      return "failed";
  }
  return "?";
}

}  // namespace pinjaw::planner::peers

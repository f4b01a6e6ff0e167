#include "tests/bench/force/solvers.hpp"

#include <glpk.h>

#include <algorithm>
#include <array>
#include <coin/ClpDualRowDantzig.hpp>
#include <coin/ClpSimplex.hpp>
#include <vector>

/// CLP may sit on OpenBLAS, whose idle threads would count as its CPU time.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace pinjaw::bench {

namespace kernel = planner::kernel;
using planner::RightHandSide;

double sum_by_glpk(const Case& one, bool warm) {
  const auto columns = static_cast<int>(one.rays.cost.size());
  glp_prob* problem = glp_create_prob();
  glp_add_rows(problem, kernel::kRows);
  glp_add_cols(problem, columns);
  for (int j = 0; j < columns; ++j) {
    glp_set_col_bnds(problem, j + 1, GLP_LO, 0, 0);
    glp_set_obj_coef(problem, j + 1, one.rays.cost[static_cast<std::size_t>(j)]);
    std::array<int, 7> rows{0, 1, 2, 3, 4, 5, 6};
    std::array<double, 7> values{};
    for (int k = 0; k < kernel::kRows; ++k)
      values[static_cast<std::size_t>(k) + 1] =
          one.rays.columns[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)];
    glp_set_mat_col(problem, j + 1, kernel::kRows, rows.data(), values.data());
  }
  glp_smcp control;
  glp_init_smcp(&control);
  control.msg_lev = GLP_MSG_OFF;
  control.meth = warm ? GLP_DUALP : GLP_PRIMAL;
  // measured: a third quicker on programs this small than steepest edges and Harris' ratio test, the defaults
  control.pricing = GLP_PT_STD;
  control.r_test = GLP_RT_STD;
  double sum = 0;
  for (const RightHandSide& b : one.right) {
    for (int k = 0; k < kernel::kRows; ++k) {
      const double right = b[static_cast<std::size_t>(k)];
      glp_set_row_bnds(problem, k + 1, GLP_FX, right, right);
    }
    if (!warm) glp_std_basis(problem);
    glp_simplex(problem, &control);
    if (glp_get_status(problem) == GLP_OPT) sum += glp_get_obj_val(problem);
  }
  glp_delete_prob(problem);
  return sum;
}

double sum_by_clp(const Case& one, bool keep_factorisation) {
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  const auto columns = static_cast<int>(one.rays.cost.size());
  std::vector<CoinBigIndex> starts{0};
  std::vector<int> rows;
  std::vector<double> values;
  for (const auto& column : one.rays.columns) {
    for (int k = 0; k < kernel::kRows; ++k) {
      rows.push_back(k);
      values.push_back(column[static_cast<std::size_t>(k)]);
    }
    starts.push_back(static_cast<CoinBigIndex>(rows.size()));
  }
  const std::vector<double> lower(one.rays.cost.size(), 0);
  const std::vector<double> upper(one.rays.cost.size(), 1e30);
  ClpSimplex model;
  model.setLogLevel(0);
  // measured: a third quicker than scaling data of order one anew each time and keeping steepest edges
  model.scaling(0);
  ClpDualRowDantzig largest;
  model.setDualRowPivotAlgorithm(largest);
  model.loadProblem(columns, kernel::kRows, starts.data(), rows.data(), values.data(), lower.data(),
                    upper.data(), one.rays.cost.data(), one.right[0].data(), one.right[0].data());
  constexpr int kKeepAll = 7;  // work areas, factorisation and status
  double sum = 0;
  for (const RightHandSide& b : one.right) {
    std::copy(b.begin(), b.end(), model.rowLower());
    std::copy(b.begin(), b.end(), model.rowUpper());
    model.dual(0, keep_factorisation ? kKeepAll : 0);
    if (model.status() == 0) sum += model.objectiveValue();
  }
  return sum;
}

}  // namespace pinjaw::bench

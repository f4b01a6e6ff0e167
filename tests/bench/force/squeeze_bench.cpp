// Squeeze programs: ours beside GLPK, CLP and a plain dense tableau.
#include <coin/Clp_C_Interface.h>
#include <glpk.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/planner/force/closure.hpp"
#include "host/planner/force/ray_program.hpp"
#include "host/planner/force/squeeze.hpp"
#include "tests/bench/suites.hpp"
#include "tests/bench/support/cpu_time.hpp"
#include "tests/host/planner/force/zoo.hpp"

namespace pinjaw::planner {
namespace {

using RightHandSide = std::array<double, kernel::kRows>;

constexpr int kLoads = 302;   // BB's 300 sprays and 2 accelerations
constexpr int kRepeats = 5;   // the median counts
constexpr int kCompared = 5;  // grasps that the slow ones do

/// One grasp's program and its loads, as every solver gets them.
struct Case {
  Grasp grasp;
  kernel::Program program{};
  std::vector<model::Wrench> wrenches;
  std::vector<RightHandSide> right;
  int columns = 0;
};

std::vector<std::unique_ptr<Case>> cases(int count) {
  base::Random random(1);
  std::vector<std::unique_ptr<Case>> all;
  while (static_cast<int>(all.size()) < count) {
    auto one = std::make_unique<Case>();
    one->grasp = zoo::random_grasp(zoo::Family::FormClosed, random);
    if (jamming_contact(one->grasp)) continue;
    const GraspFrame frame = frame_of(one->grasp);
    fill_program(one->grasp, frame, one->grasp.mu / std::sqrt(2.0), one->program);
    one->columns = 4 * static_cast<int>(one->grasp.contacts.size());
    for (int l = 0; l < kLoads; ++l) {
      one->wrenches.push_back(zoo::random_wrench(zoo::Family::FormClosed, one->grasp, random));
      one->right.push_back(frame.right_hand_side(one->wrenches.back()));
    }
    all.push_back(std::move(one));
  }
  return all;
}

/// Solves every load of a case; the sum of the forces, so that nothing is optimised away and answers can be
/// compared.
using Solve = std::function<double(const Case&)>;

double with_kernel(const kernel::Kernel& kernel, kernel::Memory& memory, const Case& one) {
  kernel::forget(memory);
  double sum = 0;
  for (const RightHandSide& b : one.right) {
    kernel::Answer answer;
    kernel.solve(one.program, memory, b.data(), answer);
    if (answer.status == kernel::Status::Optimal) sum += answer.value;
  }
  return sum;
}

double with_solver(SqueezeSolver& solver, model::FrictionModel friction, const Case& one) {
  solver.take(one.grasp);
  double sum = 0;
  for (const model::Wrench& wrench : one.wrenches) {
    const SqueezeOutcome outcome = solver.least_squeeze(wrench, friction);
    if (const auto* required = std::get_if<Required>(&outcome)) sum += required->force_n;
  }
  return sum;
}

double with_glpk(bool warm, const Case& one) {
  glp_prob* problem = glp_create_prob();
  glp_add_rows(problem, kernel::kRows);
  glp_add_cols(problem, one.columns);
  for (int j = 0; j < one.columns; ++j) {
    glp_set_col_bnds(problem, j + 1, GLP_LO, 0, 0);
    glp_set_obj_coef(problem, j + 1, one.program.cost[j]);
    std::array<int, 7> rows{0, 1, 2, 3, 4, 5, 6};
    std::array<double, 7> values{};
    for (int k = 0; k < kernel::kRows; ++k) values[static_cast<std::size_t>(k) + 1] = one.program.a[k][j];
    glp_set_mat_col(problem, j + 1, kernel::kRows, rows.data(), values.data());
  }
  glp_smcp control;
  glp_init_smcp(&control);
  control.msg_lev = GLP_MSG_OFF;
  control.meth = warm ? GLP_DUALP : GLP_PRIMAL;
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

double with_clp(const Case& one) {
  std::vector<CoinBigIndex> starts{0};
  std::vector<int> rows;
  std::vector<double> values;
  for (int j = 0; j < one.columns; ++j) {
    for (int k = 0; k < kernel::kRows; ++k) {
      rows.push_back(k);
      values.push_back(one.program.a[k][j]);
    }
    starts.push_back(static_cast<CoinBigIndex>(rows.size()));
  }
  const std::vector<double> lower(static_cast<std::size_t>(one.columns), 0);
  const std::vector<double> upper(static_cast<std::size_t>(one.columns), 1e30);
  Clp_Simplex* model = Clp_newModel();
  Clp_setLogLevel(model, 0);
  Clp_loadProblem(model, one.columns, kernel::kRows, starts.data(), rows.data(), values.data(), lower.data(),
                  upper.data(), one.program.cost, one.right[0].data(), one.right[0].data());
  double sum = 0;
  for (const RightHandSide& b : one.right) {
    std::copy(b.begin(), b.end(), Clp_rowLower(model));
    std::copy(b.begin(), b.end(), Clp_rowUpper(model));
    Clp_dual(model, 0);
    if (Clp_status(model) == 0) sum += Clp_objectiveValue(model);
  }
  Clp_deleteModel(model);
  return sum;
}

using Tableau = Eigen::Matrix<double, 7, 39, Eigen::RowMajor>;
using TableauBasis = std::array<int, 6>;

Tableau start_tableau(const Case& one, const RightHandSide& b, TableauBasis& basis) {
  Tableau t = Tableau::Zero();
  for (int k = 0; k < 6; ++k) {
    const auto row = static_cast<std::size_t>(k);
    const double sign = b[row] < 0 ? -1 : 1;
    for (int j = 0; j < one.columns; ++j) t(k, j) = sign * one.program.a[k][j];
    t(k, 32 + k) = 1;
    t(k, 38) = sign * b[row];
    basis[row] = 32 + k;
  }
  return t;
}

/// The last row: reduced costs of the phase, artificials costing 1 in the first.
void price(const Case& one, int phase, const TableauBasis& basis, Tableau& t) {
  t.row(6).setZero();
  for (int k = 0; k < 6; ++k) {
    const int column = basis[static_cast<std::size_t>(k)];
    const double real_cost = column < 32 ? one.program.cost[column] : 0;
    const double artificial_cost = column < 32 ? 0 : 1;
    t.row(6) -= (phase == 1 ? artificial_cost : real_cost) * t.row(k);
  }
  if (phase == 1) return;
  for (int j = 0; j < one.columns; ++j) t(6, j) += one.program.cost[j];
}

void minimise(const Case& one, TableauBasis& basis, Tableau& t) {
  for (int pivots = 0; pivots < 500; ++pivots) {
    Eigen::Index entering = 0;
    if (t.row(6).head(one.columns).minCoeff(&entering) > -1e-10) return;
    int row = -1;
    for (int k = 0; k < 6; ++k) {
      if (t(k, entering) <= 1e-10) continue;
      if (row < 0 || t(k, 38) * t(row, entering) < t(row, 38) * t(k, entering)) row = k;
    }
    if (row < 0) return;
    t.row(row) /= t(row, entering);
    for (int k = 0; k < 7; ++k) {
      if (k != row) t.row(k) -= t(k, entering) * t.row(row);
    }
    basis[static_cast<std::size_t>(row)] = static_cast<int>(entering);
  }
}

/// The honest peer: a dense two-phase tableau on Eigen's fixed sizes, largest reduced cost, from nothing for
/// each load.
double by_tableau(const Case& one, const RightHandSide& b) {
  TableauBasis basis{};
  Tableau t = start_tableau(one, b, basis);
  for (const int phase : {1, 2}) {
    price(one, phase, basis, t);
    minimise(one, basis, t);
    if (phase == 1 && -t(6, 38) > 1e-7) return 0;
  }
  return -t(6, 38);
}

double with_tableau(const Case& one) {
  double sum = 0;
  for (const RightHandSide& b : one.right) sum += by_tableau(one, b);
  return sum;
}

struct Row {
  std::string name;
  int grasps = 0;
  Solve solve;
  double us = 0;  // of CPU time, each program
};

/// Fills the time of each row; they take turns.
void measure(std::vector<Row>& rows, const std::vector<std::unique_ptr<Case>>& all) {
  std::vector<bench::Contestant> contestants;
  for (const Row& row : rows) {
    contestants.push_back({row.name, [&all, &row] {
                             for (int i = 0; i < row.grasps; ++i)
                               row.solve(*all[static_cast<std::size_t>(i)]);
                           }});
  }
  const std::vector<double> seconds = bench::median_cpu_s(contestants, kRepeats);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].us = 1e6 * seconds[i] / (rows[i].grasps * kLoads);
}

}  // namespace
}  // namespace pinjaw::planner

void pinjaw::bench::measure_squeeze(Report& report) {
  using namespace pinjaw::planner;
  const auto all = cases(40);
  const int many = static_cast<int>(all.size());
  const auto memory = std::make_unique<kernel::Memory>();
  SqueezeSolver solver;
  std::vector<Row> rows;
  int count = 0;
  const kernel::Kernel* const* kernels = kernel::kernels(count);
  for (int k = count - 1; k >= 0; --k) {
    const kernel::Kernel& kernel = *kernels[k];
    rows.push_back({std::string("squeeze program, 8 contacts, ") + kernel.name, many,
                    [&](const Case& one) { return with_kernel(kernel, *memory, one); }});
  }
  const auto ours = static_cast<std::size_t>(count);
  rows.push_back({"Eigen dense tableau, cold", kCompared, with_tableau});
  rows.push_back({"GLPK, warm dual", kCompared, [](const Case& one) { return with_glpk(true, one); }});
  rows.push_back({"GLPK, cold primal", kCompared, [](const Case& one) { return with_glpk(false, one); }});
  rows.push_back({"CLP, warm dual", kCompared, with_clp});
  rows.push_back({"exact cone, 8 contacts", kCompared,
                  [&](const Case& one) { return with_solver(solver, model::FrictionModel::Cone, one); }});
  measure(rows, all);
  for (std::size_t i = 0; i < ours; ++i) {
    Measurement measured{rows[i].name, "us of CPU time", rows[i].us};
    for (std::size_t p = ours; p + 1 < rows.size(); ++p) measured.peers.push_back({rows[p].name, rows[p].us});
    report.add(std::move(measured));
  }
  report.add({rows.back().name, "us of CPU time", rows.back().us});
}

#include <Eigen/Dense>
#include <array>

#include "tests/bench/force/solvers.hpp"

namespace pinjaw::bench {
namespace {

using planner::RightHandSide;

int columns_of(const Case& one) {
  return static_cast<int>(one.rays.cost.size());
}

using Tableau = Eigen::Matrix<double, 7, 39, Eigen::RowMajor>;
using TableauBasis = std::array<int, 6>;

Tableau start_tableau(const Case& one, const RightHandSide& b, TableauBasis& basis) {
  Tableau t = Tableau::Zero();
  for (int k = 0; k < 6; ++k) {
    const auto row = static_cast<std::size_t>(k);
    const double sign = b[row] < 0 ? -1 : 1;
    for (int j = 0; j < columns_of(one); ++j)
      t(k, j) = sign * one.rays.columns[static_cast<std::size_t>(j)][row];
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
    const double real_cost = column < 32 ? one.rays.cost[static_cast<std::size_t>(column)] : 0;
    const double artificial_cost = column < 32 ? 0 : 1;
    t.row(6) -= (phase == 1 ? artificial_cost : real_cost) * t.row(k);
  }
  if (phase == 1) return;
  for (int j = 0; j < columns_of(one); ++j) t(6, j) += one.rays.cost[static_cast<std::size_t>(j)];
}

void minimise(const Case& one, TableauBasis& basis, Tableau& t) {
  for (int pivots = 0; pivots < 500; ++pivots) {
    Eigen::Index entering = 0;
    if (t.row(6).head(columns_of(one)).minCoeff(&entering) > -1e-10) return;
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

}  // namespace

double sum_by_tableau(const Case& one) {
  double sum = 0;
  for (const RightHandSide& b : one.right) sum += by_tableau(one, b);
  return sum;
}

}  // namespace pinjaw::bench

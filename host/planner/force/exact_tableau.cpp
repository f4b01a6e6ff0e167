#include "host/planner/force/exact_tableau.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pinjaw::planner {
namespace {

#if defined(__SIZEOF_FLOAT128__)
__extension__ using Real = __float128;
#else
using Real = long double;
#endif

using kernel::kRows;
constexpr int kColumns = 4 * Grasp::kMaxContacts;
constexpr int kWidth = kColumns + kRows;  // real columns, then one artificial a row
constexpr double kExactFeasible = 1e-10;  // of |b|, the kernel's primal tolerance
// Columns have length about 1 and rounding of 1e-16. A column that gains less than 1e-13 a newton is not
// worth entering; one that gains more has an entry above a sixth of that, so the pivot tolerance lies below
// it.
constexpr double kReducedCost = 1e-13;
constexpr double kExactPivot = 1e-15;
constexpr double kRank = 1e-12;         // a row smaller than this is dependent
constexpr int kMaxExactPivots = 20000;  // Bland's rule ends far earlier; reaching this is a bug

Real magnitude(Real value) {
  return value < 0 ? -value : value;
}

/// Rows kept in the form x_basis + T x_others = right, the right-hand side at least 0.
class Tableau {
 public:
  Tableau(const RayProgram& program, const RightHandSide& b)
      : columns_(static_cast<int>(program.cost.size())) {
    for (int k = 0; k < kRows; ++k) {
      const double sign = b[at(k)] < 0 ? -1 : 1;
      for (int j = 0; j < columns_; ++j) rows_[at(k)][at(j)] = sign * program.columns[at(j)][at(k)];
      rows_[at(k)][at(kColumns + k)] = 1;
      right_[at(k)] = sign * b[at(k)];
      basis_[at(k)] = kColumns + k;
      size_ = std::max(size_, std::abs(b[at(k)]));
    }
  }

  TableauOutcome solve(const RayProgram& program) {
    std::array<Real, kWidth> cost{};
    std::fill(cost.begin() + kColumns, cost.end(), Real{1});
    run(cost, columns_);
    Real artificial = 0;
    for (int k = 0; k < kRows; ++k) artificial += basis_[at(k)] >= kColumns ? right_[at(k)] : Real{0};
    if (artificial > kExactFeasible * size_) return Unresistable{};
    drive_out_artificials();
    artificials_block_ = false;
    cost.fill(0);
    for (int j = 0; j < columns_; ++j) cost[at(j)] = program.cost[at(j)];
    if (!run(cost, columns_)) return Unbounded{};
    TableauOptimum optimum;
    Real value = 0;
    for (int k = 0; k < kRows; ++k) {
      if (basis_[at(k)] >= kColumns) continue;
      value += cost[at(basis_[at(k)])] * right_[at(k)];
      optimum.x[at(basis_[at(k)])] = static_cast<double>(right_[at(k)]);
    }
    optimum.value = static_cast<double>(value);
    return optimum;
  }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  /// False where the objective is unbounded below.
  bool run(const std::array<Real, kWidth>& cost, int width) {
    for (int pivots = 0; pivots < kMaxExactPivots; ++pivots) {
      const int entering = improving_column(cost, width);
      if (entering < 0) return true;
      const int row = blocking_row(entering);
      if (row < 0) return false;
      pivot(row, entering);
    }
    throw std::logic_error("the squeeze program's exact tableau does not end");
  }

  [[nodiscard]] int improving_column(const std::array<Real, kWidth>& cost, int width) const {
    for (int j = 0; j < width; ++j) {
      Real reduced = cost[at(j)];
      for (int k = 0; k < kRows; ++k) reduced -= cost[at(basis_[at(k)])] * rows_[at(k)][at(j)];
      if (reduced < -kReducedCost) return j;
    }
    return -1;
  }

  /// Bland: least ratio, then least basis index. An artificial that the second phase still has lies at 0 in a
  /// dependent row, and does not block.
  [[nodiscard]] int blocking_row(int entering) const {
    int row = -1;
    for (int k = 0; k < kRows; ++k) {
      const Real entry = rows_[at(k)][at(entering)];
      if (entry <= kExactPivot || (!artificials_block_ && basis_[at(k)] >= kColumns)) continue;
      if (row < 0) {
        row = k;
        continue;
      }
      const Real here = right_[at(k)] * rows_[at(row)][at(entering)];
      const Real best = right_[at(row)] * entry;
      if (here < best || (here == best && basis_[at(k)] < basis_[at(row)])) row = k;
    }
    return row;
  }

  void pivot(int row, int entering) {
    const Real scale = 1 / rows_[at(row)][at(entering)];
    for (Real& entry : rows_[at(row)]) entry *= scale;
    right_[at(row)] *= scale;
    for (int k = 0; k < kRows; ++k) {
      const Real factor = rows_[at(k)][at(entering)];
      if (k == row || factor == 0) continue;
      for (int j = 0; j < kWidth; ++j) rows_[at(k)][at(j)] -= factor * rows_[at(row)][at(j)];
      right_[at(k)] = std::max(Real{0}, right_[at(k)] - factor * right_[at(row)]);
    }
    basis_[at(row)] = entering;
  }

  void drive_out_artificials() {
    for (int k = 0; k < kRows; ++k) {
      if (basis_[at(k)] < kColumns) continue;
      right_[at(k)] = 0;
      int largest = 0;
      for (int j = 1; j < columns_; ++j) {
        if (magnitude(rows_[at(k)][at(j)]) > magnitude(rows_[at(k)][at(largest)])) largest = j;
      }
      if (magnitude(rows_[at(k)][at(largest)]) > kRank) pivot(k, largest);
    }
  }

  int columns_;
  bool artificials_block_ = true;
  double size_ = 0;
  std::array<std::array<Real, kWidth>, kRows> rows_{};
  std::array<Real, kRows> right_{};
  std::array<int, kRows> basis_{};
};

}  // namespace

TableauOutcome solve_in_quadruple_precision(const RayProgram& program, const RightHandSide& b) {
  return Tableau(program, b).solve(program);
}

}  // namespace pinjaw::planner

// The kernel, compiled once for each instruction set: define PINJAW_KERNEL, then include. Everything here has
// internal linkage and no library header is used, so no code of a wide instruction set can leak into the rest
// of the program.

#include "host/planner/force/kernel.hpp"

namespace pinjaw::planner::kernel {
namespace {

#if defined(__AVX512F__)
constexpr int kWidth = 8;
#elif defined(__AVX2__)
constexpr int kWidth = 4;
#else
constexpr int kWidth = 2;
#endif
using Pack = double __attribute__((vector_size(kWidth * sizeof(double))));
constexpr int kLanePacks = kLanes / kWidth;
constexpr int kColumnPacks = kColumns / kWidth;

constexpr double kInfinity = __builtin_inf();
// Chosen by comparison with quadruple precision (measured: 1e-12 and 1e-13 change nothing; pivots of 1e-11 do
// harm).
constexpr double kPrimalTolerance = 1e-10;  // of |b|
constexpr double kPivotTolerance = 1e-9;    // of |rho|
constexpr double kTieRelative = 1e-10;
constexpr double kTieAbsolute = 1e-12;
constexpr double kSameVertex = 1e-9;       // of |y|
constexpr double kCertifiedError = 1e-10;  // of max(1, |F|)
constexpr double kFarkasExcess = 1e-12;    // of |rho|: a ray may point this far to the wrong side
constexpr double kFarkasDepth = 1e-9;      // of |rho| |b|: how clearly the load must lie outside
constexpr int kMaxPivots = 100;            // an ordinary cold start needs about 12

inline double larger(double a, double b) {
  return a > b ? a : b;
}
inline double magnitude(double a) {
  return a < 0 ? -a : a;
}
inline double root(double a) {
  return __builtin_sqrt(a);
}

inline Pack load(const double* from) {
  return *reinterpret_cast<const Pack*>(from);
}
inline void store(double* to, Pack value) {
  *reinterpret_cast<Pack*>(to) = value;
}

/// The state of one dual simplex run.
struct alignas(64) Run {
  double inverse[kRows][kLanes];
  double x[kLanes];
  double d[kColumns];      // reduced costs
  double alpha[kColumns];  // pivot row
  double rho[kLanes];      // row of the inverse that leaves, its sign turned so that x < 0
  int column[kLanes];
  double rho_length;
};

/// out = sum over k of matrix[k][.] v[k], one pack after the other.
template <int kPacks, int kStride>
inline void combine(const double (&matrix)[kRows][kStride], const double* v, double* out) {
  for (int p = 0; p < kPacks; ++p) {
    Pack sum = load(&matrix[0][p * kWidth]) * v[0];
    for (int k = 1; k < kRows; ++k) sum += load(&matrix[k][p * kWidth]) * v[k];
    store(&out[p * kWidth], sum);
  }
}

inline double dot_rows(const double* a, const double* b) {
  double sum = a[0] * b[0];
  for (int k = 1; k < kRows; ++k) sum += a[k] * b[k];
  return sum;
}

inline double largest_magnitude(const double* v) {
  double largest = 0;
  for (int k = 0; k < kRows; ++k) largest = larger(largest, magnitude(v[k]));
  return largest;
}

/// How far x is from feasible: its most negative entry, or the largest |x| of a logical. 0 or above.
inline double infeasibility(const double* x, const int* column, bool has_logical) {
  double worst = 0;
  for (int i = 0; i < kRows; ++i) worst = larger(worst, -x[i]);
  if (has_logical) {
    for (int i = 0; i < kRows; ++i) worst = larger(worst, column[i] < 0 ? magnitude(x[i]) : 0);
  }
  return worst;
}

struct Best {
  double value;
  int vertex;
};

/// The vertex with the largest y.b, the first among equals.
inline Best best_vertex(const Memory& memory, const double* b) {
  Best best{0, -1};
  Pack top = Pack{} - kInfinity;
  Pack where = Pack{};
  for (int v = 0; v < memory.vertices; v += kWidth) {
    Pack value = load(&memory.y[0][v]) * b[0];
    for (int k = 1; k < kRows; ++k) value += load(&memory.y[k][v]) * b[k];
    const auto higher = value > top;
    top = higher ? value : top;
    where = higher ? Pack{} + static_cast<double>(v / kWidth) : where;
  }
  best.value = -kInfinity;
  for (int lane = 0; lane < kWidth; ++lane) {
    const int vertex = static_cast<int>(where[lane]) * kWidth + lane;
    if (top[lane] > best.value || (top[lane] == best.value && vertex < best.vertex))
      best = {top[lane], vertex};
  }
  if (best.vertex >= memory.vertices) best.vertex = memory.vertices - 1;
  return best;
}

inline void start_cold(const Program& program, const double* b, Run& run) {
  for (int k = 0; k < kRows; ++k) {
    for (int i = 0; i < kLanes; ++i) run.inverse[k][i] = k == i ? 1 : 0;
  }
  for (int i = 0; i < kLanes; ++i) {
    run.x[i] = i < kRows ? b[i] : 0;
    run.column[i] = -1;
  }
  for (int j = 0; j < kColumns; ++j) run.d[j] = program.cost[j];
}

inline void start_from(const Program& program, const Basis& basis, const double* b, Run& run) {
  for (int k = 0; k < kRows; ++k) {
    for (int i = 0; i < kLanes; ++i) run.inverse[k][i] = basis.inverse[k][i];
  }
  for (int i = 0; i < kLanes; ++i) run.column[i] = basis.column[i];
  combine<kLanePacks>(run.inverse, b, run.x);
  combine<kColumnPacks>(program.a, basis.y, run.d);
  for (int p = 0; p < kColumnPacks; ++p) {
    const Pack d = load(&program.cost[p * kWidth]) - load(&run.d[p * kWidth]);
    store(&run.d[p * kWidth], d < 0.0 ? Pack{} : d);
  }
}

/// The row that leaves: the deepest by exact steepest edge, -1 where x is feasible.
inline int leaving_row(const Run& run, double tolerance) {
  alignas(64) double length2[kLanes];
  for (int p = 0; p < kLanePacks; ++p) {
    Pack sum = load(&run.inverse[0][p * kWidth]) * load(&run.inverse[0][p * kWidth]);
    for (int k = 1; k < kRows; ++k)
      sum += load(&run.inverse[k][p * kWidth]) * load(&run.inverse[k][p * kWidth]);
    store(&length2[p * kWidth], sum);
  }
  int row = -1;
  double depth = 0;
  for (int i = 0; i < kRows; ++i) {
    const double below = run.column[i] < 0 ? magnitude(run.x[i]) : -run.x[i];
    if (below <= tolerance) continue;
    const double here = below * below / length2[i];
    if (here > depth) {
      depth = here;
      row = i;
    }
  }
  return row;
}

/// Fills rho and alpha for a row, turned so that the entering column has alpha < 0.
inline void pivot_row(const Program& program, int row, double sign, Run& run) {
  double length2 = 0;
  for (int k = 0; k < kRows; ++k) {
    run.rho[k] = sign * run.inverse[k][row];
    length2 += run.rho[k] * run.rho[k];
  }
  run.rho_length = root(length2);
  combine<kColumnPacks>(program.a, run.rho, run.alpha);
}

/// Dual ratio test: the column whose reduced cost reaches 0 first, among near ties the largest pivot; -1:
/// none.
inline int entering_column(const Run& run) {
  const double pivot = -kPivotTolerance * run.rho_length;
  alignas(64) double ratio[kColumns];
  Pack least = Pack{} + kInfinity;
  for (int p = 0; p < kColumnPacks; ++p) {
    const Pack alpha = load(&run.alpha[p * kWidth]);
    const auto can = alpha < pivot;
    const Pack quotient = load(&run.d[p * kWidth]) / (can ? -alpha : Pack{} + 1.0);
    const Pack here = can ? quotient : Pack{} + kInfinity;
    least = here < least ? here : least;
    store(&ratio[p * kWidth], here);
  }
  double step = kInfinity;
  for (int lane = 0; lane < kWidth; ++lane) step = least[lane] < step ? least[lane] : step;
  if (step == kInfinity) return -1;
  const double limit = step * (1 + kTieRelative) + kTieAbsolute;
  int column = -1;
  double deepest = 0;
  for (int j = 0; j < kColumns; ++j) {
    if (ratio[j] <= limit && run.alpha[j] < deepest) {
      deepest = run.alpha[j];
      column = j;
    }
  }
  return column;
}

/// Exchanges the basis column of `row` for column `entering`; `sign` as in pivot_row.
inline void exchange(const Program& program, int row, double sign, int entering, Run& run) {
  const double step = run.d[entering] / -run.alpha[entering];
  for (int p = 0; p < kColumnPacks; ++p) {
    const Pack d = load(&run.d[p * kWidth]) + load(&run.alpha[p * kWidth]) * step;
    store(&run.d[p * kWidth], d < 0.0 ? Pack{} : d);
  }
  alignas(64) double w[kLanes];
  combine<kLanePacks>(run.inverse, program.at[entering], w);
  const double pivot = w[row];
  w[row] -= 1;
  const double x_step = run.x[row] / pivot;
  for (int p = 0; p < kLanePacks; ++p) {
    const Pack column = load(&w[p * kWidth]);
    for (int k = 0; k < kRows; ++k) {
      double* to = &run.inverse[k][p * kWidth];
      store(to, load(to) - column * (sign * run.rho[k] / pivot));
    }
    store(&run.x[p * kWidth], load(&run.x[p * kWidth]) - column * x_step);
  }
  run.column[row] = entering;
}

/// Farkas' certificate: rho.a >= 0 for every ray while rho.b < 0, each with room for rounding.
inline bool proves_infeasible(const Run& run, const double* b) {
  double worst = 0;
  for (int j = 0; j < kColumns; ++j) worst = larger(worst, -run.alpha[j]);
  const double depth = -dot_rows(run.rho, b);
  return worst <= kFarkasExcess * run.rho_length &&
         depth >= kFarkasDepth * run.rho_length * largest_magnitude(b);
}

/// Takes logicals that lie at 0 out of the basis where a column can stand in; x stays, y stays dual feasible.
inline void drive_out_logicals(const Program& program, Run& run) {
  for (int row = 0; row < kRows; ++row) {
    if (run.column[row] >= 0) continue;
    for (double sign = 1; sign >= -1; sign -= 2) {
      pivot_row(program, row, sign, run);
      const int entering = entering_column(run);
      if (entering < 0) continue;
      exchange(program, row, sign, entering, run);
      break;
    }
  }
}

inline Status dual_simplex(const Program& program, const double* b, double tolerance, Run& run, int& pivots) {
  for (pivots = 0; pivots < kMaxPivots; ++pivots) {
    const int row = leaving_row(run, tolerance);
    if (row < 0) {
      drive_out_logicals(program, run);
      return Status::Optimal;
    }
    const double sign = run.x[row] > 0 ? -1.0 : 1.0;
    pivot_row(program, row, sign, run);
    const int entering = entering_column(run);
    if (entering < 0) return proves_infeasible(run, b) ? Status::Infeasible : Status::Doubtful;
    exchange(program, row, sign, entering, run);
  }
  return Status::Doubtful;
}

/// product[k] = column k of B M, where M's columns are given and B's come from the program.
inline void times_basis(const Program& program, const int* column, const double (&m)[kRows][kLanes],
                        double (&product)[kRows][kLanes]) {
  alignas(64) double logical[kRows][kLanes] = {};
  const double* of[kRows];
  for (int i = 0; i < kRows; ++i) {
    logical[i][i] = 1;
    of[i] = column[i] < 0 ? logical[i] : program.at[column[i]];
  }
  for (int k = 0; k < kRows; ++k) {
    for (int p = 0; p < kLanePacks; ++p) {
      Pack sum = load(&of[0][p * kWidth]) * m[k][0];
      for (int i = 1; i < kRows; ++i) sum += load(&of[i][p * kWidth]) * m[k][i];
      store(&product[k][p * kWidth], sum);
    }
  }
}

/// One Newton-Schulz step inverse (2 I - B inverse), then y and the basis's own error bounds.
inline void settle(const Program& program, const Run& run, Basis& basis) {
  basis.has_logical = false;
  for (int i = 0; i < kLanes; ++i) {
    basis.column[i] = i < kRows ? run.column[i] : -1;
    if (i < kRows && run.column[i] < 0) basis.has_logical = true;
  }
  alignas(64) double residual[kRows][kLanes];
  times_basis(program, basis.column, run.inverse, residual);
  for (int k = 0; k < kRows; ++k) {
    for (int i = 0; i < kRows; ++i) residual[k][i] = (i == k ? 2.0 : 0.0) - residual[k][i];
  }
  for (int k = 0; k < kRows; ++k) combine<kLanePacks>(run.inverse, residual[k], basis.inverse[k]);
  times_basis(program, basis.column, basis.inverse, residual);
  basis.inverse_error = 0;
  basis.y_sum = 0;
  for (int k = 0; k < kRows; ++k) {
    basis.y[k] = 0;
    for (int i = 0; i < kRows; ++i) {
      const double cost = basis.column[i] < 0 ? 0.0 : program.cost[basis.column[i]];
      basis.y[k] += cost * basis.inverse[k][i];
      basis.inverse_error = larger(basis.inverse_error, magnitude(residual[k][i] - (i == k ? 1.0 : 0.0)));
    }
    basis.y_sum += magnitude(basis.y[k]);
  }
  basis.y[6] = basis.y[7] = 0;
  alignas(64) double used[kColumns];
  combine<kColumnPacks>(program.a, basis.y, used);
  basis.dual_excess = 0;
  for (int j = 0; j < kColumns; ++j) basis.dual_excess = larger(basis.dual_excess, used[j] - program.cost[j]);
  for (int i = 0; i < kRows; ++i) {
    const int j = basis.column[i];
    if (j >= 0) basis.dual_excess = larger(basis.dual_excess, program.cost[j] - used[j]);
  }
}

/// The bound on |y.b - F|: what x's negative part, the inverse's error and y's excess can change. With
/// sum x <= F / least cost. NaN counts as doubtful.
inline bool certified(const Program& program, const Basis& basis, double below, double size, double value) {
  const double error = basis.y_sum * kRows * (below + basis.inverse_error * size) +
                       basis.dual_excess * (magnitude(value) + 1) / program.least_cost;
  return error <= kCertifiedError * larger(1, magnitude(value));
}

inline bool same_vertex(const Memory& memory, int vertex, const Basis& basis) {
  double difference = 0;
  for (int k = 0; k < kRows; ++k)
    difference = larger(difference, magnitude(memory.y[k][vertex] - basis.y[k]));
  return difference <= kSameVertex * basis.y_sum;
}

/// The vertex that `basis` belongs to, among those whose bound ties with its value; -1: a new one.
inline int vertex_of(const Memory& memory, const Basis& basis) {
  for (int v = 0; v < memory.vertices; ++v) {
    if (same_vertex(memory, v, basis)) return v;
  }
  return -1;
}

/// Keeps a basis, in its vertex's list or as a new vertex; returns where it lives.
inline const Basis* keep(Memory& memory, const Basis& basis) {
  const int known = vertex_of(memory, basis);
  if (memory.bases == kMaxBases || (known < 0 && memory.vertices == kMaxVertices)) return &memory.last;
  const int place = memory.bases++;
  memory.basis[place] = basis;
  if (known >= 0) {
    memory.basis[place].next = memory.first[known];
    memory.first[known] = place;
    return &memory.basis[place];
  }
  const int vertex = memory.vertices++;
  memory.basis[place].next = -1;
  memory.first[vertex] = place;
  const int padded = (vertex / kLanes + 1) * kLanes;
  for (int k = 0; k < kRows; ++k) {
    for (int v = vertex; v < padded; ++v) memory.y[k][v] = basis.y[k];
  }
  return &memory.basis[place];
}

/// Looks among the bases of `vertex` for one that is feasible for b. Fills the answer where it is; else
/// leaves the basis nearest to feasible in `nearest`.
inline bool look_up(const Program& program, Memory& memory, int vertex, const double* b, double size,
                    Answer& answer, int& nearest) {
  const double tolerance = kPrimalTolerance * size;
  double least = kInfinity;
  int previous = -1;
  for (int place = memory.first[vertex]; place >= 0; previous = place, place = memory.basis[place].next) {
    Basis& basis = memory.basis[place];
    alignas(64) double x[kLanes];
    combine<kLanePacks>(basis.inverse, b, x);
    const double below = infeasibility(x, basis.column, basis.has_logical);
    if (below > tolerance) {
      if (below < least) {
        least = below;
        nearest = place;
      }
      continue;
    }
    if (previous >= 0) {
      memory.basis[previous].next = basis.next;
      basis.next = memory.first[vertex];
      memory.first[vertex] = place;
    }
    answer.value = dot_rows(basis.y, b);
    answer.basis = &basis;
    for (int i = 0; i < kLanes; ++i) answer.x[i] = x[i];
    answer.status = certified(program, basis, below, size, answer.value) ? Status::Optimal : Status::Doubtful;
    return true;
  }
  return false;
}

void solve(const Program& program, Memory& memory, const double* b, Answer& answer) {
  const double size = largest_magnitude(b);
  answer.pivots = 0;
  Run run;
  int nearest = -1;
  if (memory.vertices > 0) {
    const Best best = best_vertex(memory, b);
    if (look_up(program, memory, best.vertex, b, size, answer, nearest)) return;
  }
  if (nearest >= 0) {
    start_from(program, memory.basis[nearest], b, run);
  } else {
    start_cold(program, b, run);
  }
  const double tolerance = kPrimalTolerance * size;
  answer.basis = nullptr;
  answer.status = dual_simplex(program, b, tolerance, run, answer.pivots);
  if (answer.status != Status::Optimal) return;
  settle(program, run, memory.last);
  alignas(64) double x[kLanes];
  combine<kLanePacks>(memory.last.inverse, b, x);
  const double below = infeasibility(x, memory.last.column, memory.last.has_logical);
  answer.value = dot_rows(memory.last.y, b);
  answer.basis = &memory.last;
  for (int i = 0; i < kLanes; ++i) answer.x[i] = x[i];
  if (below > tolerance || !certified(program, memory.last, below, size, answer.value)) {
    answer.status = Status::Doubtful;
    return;
  }
  if (!memory.last.has_logical) answer.basis = keep(memory, memory.last);
}

double lower_bound(const Memory& memory, const double* b) {
  return memory.vertices > 0 ? larger(0, best_vertex(memory, b).value) : 0;
}

}  // namespace

extern const Kernel PINJAW_KERNEL;
const Kernel PINJAW_KERNEL{PINJAW_KERNEL_NAME, &solve, &lower_bound};

}  // namespace pinjaw::planner::kernel

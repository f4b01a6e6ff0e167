#pragma once

/// The inner loop of the squeeze linear program: min c'x, A x = b, x >= 0 with 6 rows and at most 32 columns,
/// for one A and c and many b. Plain arrays and no library, so that it can be compiled for several
/// instruction sets in one program.
///
/// Only b changes, so a dual vertex y (A'y <= c) found for one load is a valid lower bound y.b for every
/// other; each vertex keeps the bases it was met with, for it has many (the two points of a pin share their
/// vertical wrench).
namespace pinjaw::planner::kernel {

inline constexpr int kRows = 6;
inline constexpr int kLanes = 8;     ///< rows padded with zeros
inline constexpr int kColumns = 32;  ///< 8 contacts of 4 rays, padded with zero columns of cost 1
inline constexpr int kMaxVertices =
    256;  ///< chosen: 302 loads visit some 52 (measured: 52 to 121); past it nothing more is kept
inline constexpr int kMaxBases = 512;

/// A and c of one grasp. Every cost is above 0, so that y = 0 is dual feasible.
struct alignas(64) Program {
  double a[kRows][kColumns];    ///< rows of A
  double at[kColumns][kLanes];  ///< columns of A
  double cost[kColumns];
  double least_cost;
};

/// A basis B of columns of A, or logicals (-1) where A has no full rank.
struct alignas(64) Basis {
  double inverse[kRows][kLanes];  ///< columns of B^-1, rows in lanes
  double y[kLanes];               ///< dual point c_B B^-1
  double y_sum;                   ///< sum of |y|
  double inverse_error;           ///< largest entry of |B B^-1 - I|
  double dual_excess;             ///< largest violation of A'y <= c, and of equality on the basis
  int column[kLanes];             ///< of A, or -1 for a logical
  int next;                       ///< next basis of the same vertex, -1 at the end
  bool has_logical;
};

/// What has been learnt of one program.
struct alignas(64) Memory {
  double y[kRows][kMaxVertices];  ///< vertices; lanes past the last repeat it
  int first[kMaxVertices];        ///< basis list of each vertex
  int vertices;
  int bases;
  Basis basis[kMaxBases];
  Basis last;  ///< the last basis found that is not kept
};

enum class Status {
  Optimal,
  Infeasible,
  Doubtful,  ///< not certified: solve with more digits
};

struct Answer {
  Status status = Status::Doubtful;
  double value = 0;              ///< y.b
  const Basis* basis = nullptr;  ///< where Optimal; in the memory
  double x[kLanes] = {};         ///< B^-1 b
  int pivots = 0;
};

/// One instruction set's kernel.
struct Kernel {
  const char* name;
  /// Solves for the right-hand side b[kRows]; updates the memory.
  void (*solve)(const Program&, Memory&, const double* b, Answer&);
  /// The largest y.b over the vertices known: a lower bound; 0 with none.
  double (*lower_bound)(const Memory&, const double* b);
};

void forget(Memory& memory);

/// The widest kernel that this machine runs. All give the same bits.
const Kernel& best_kernel();
/// Every kernel that this machine runs, the plainest first; `count` of them.
const Kernel* const* kernels(int& count);

extern const Kernel kBaselineKernel;
#if defined(__x86_64__)
extern const Kernel kAvx2Kernel;
extern const Kernel kAvx512Kernel;
#endif

}  // namespace pinjaw::planner::kernel

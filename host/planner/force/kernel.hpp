#pragma once

#include <cstdint>

/// The inner loop of the squeeze linear program: min c'x, A x = b, x >= 0 with 6 rows, for one A and c and
/// many b. Plain arrays and no library, so that it can be compiled for several instruction sets in one
/// program.
///
/// Only b changes, so every b asks for a vertex of one polytope, {y : A'y <= c}: the one with the largest
/// y.b. The kernel walks along that polytope's edges, from the best vertex it knows, and remembers each
/// vertex and where each of its edges leads; after a few dozen loads a load is a look-up and one product.
///
/// Edges of a pyramid come in pairs that differ by a vertical force, and all contacts one above the other (a
/// pin's two points) share that vertical force. Where such a pin sticks, both of each pair are tight and a
/// vertex has many bases of 6 columns. So a basis here holds plan rays, each the sum of a pair, and for each
/// sticking pin its vertical force Z, |Z| <= h S, S the sum of its plan rays: one basis for one vertex. What
/// must be at least 0 at an optimum then are the plan rays and, for each sticking pin, up = (S + Z/h)/2 and
/// down = (S - Z/h)/2: at most 8 linear functions of b, one a lane (two pins at most can stick with two plan
/// rays each, 3 of the 6 dimensions).
///
/// A load in the plan still leaves many bases at one point y, of which few suit it. So costs are set apart
/// from each other, by at most kApart of each: then each basis has a point of its own, and the look-up finds
/// the one that suits. The least cost changes by at most kApart of it, which its certificate counts.
namespace pinjaw::planner::kernel {

inline constexpr int kRows = 6;
inline constexpr int kLanes = 8;
inline constexpr int kPlanRays = 16;  ///< 8 contacts of 2
inline constexpr int kRays =
    2 * kPlanRays;  ///< ray j of the plan with the vertical force up, then 16 + j down
inline constexpr int kMaxPins = 8;
inline constexpr int kMaxVertices =
    1024;  ///< chosen: 302 loads visit some 60 (see the bench); past it all is forgotten

/// Where a program's columns lie in Program::column, after the 32 rays.
inline constexpr int kMiddle = kRays;                   ///< + plan ray: without vertical force
inline constexpr int kUpwards = kMiddle + kPlanRays;    ///< + pin: the vertical force h
inline constexpr int kDownwards = kUpwards + kMaxPins;  ///< + pin: its opposite
inline constexpr int kUnit = kDownwards + kMaxPins;     ///< + row: a unit vector
inline constexpr int kNothing = kUnit + kRows;          ///< zeros
inline constexpr int kColumns = kNothing + 1;

/// How far costs are set apart: far above rounding, far below what is certified. Measured: of the loads that
/// start at a basis that does not suit though one is known, 1e-11 leaves 5 %.
inline constexpr double kApart = 1e-11;

/// A and c of one grasp. Every cost is above 0, so that y = 0 is dual feasible.
struct alignas(64) Program {
  double plan[kRows - 1][kPlanRays];  ///< plan rays without their vertical force, which is 0
  double lift[3][kPlanRays];  ///< h times the vertical force's rows 2, 3 and 4, at each plan ray's pin
  double cost[kPlanRays];     ///< set apart; the same for both rays of a pair; 1 where there is no ray
  double column[kColumns][kLanes];
  double least_cost;
  std::uint32_t rays_of_pin[kMaxPins];  ///< bit j: plan ray j
  std::uint8_t pin_of_ray[kPlanRays];
};

/// What a lane of a vertex stands for.
namespace lane {
inline constexpr int kUp = 16;       ///< + pin; below: the plan ray
inline constexpr int kDown = 24;     ///< + pin
inline constexpr int kLogical = 32;  ///< + row: not a ray at all, must be 0
inline constexpr int kNone = 255;
}  // namespace lane

/// One number for each of the 8 lanes, in a byte each.
using Lanes = std::uint64_t;
inline int lane_of(Lanes lanes, int i) {
  return static_cast<int>((lanes >> (8 * i)) & 0xff);
}

/// A vertex of the dual polytope.
struct alignas(64) Vertex {
  double inverse[kRows][kLanes];  ///< column k: what a unit load along k adds to each lane
  double reduced_cost[kRays];     ///< c - A'y, at least 0
  double length2[kLanes];         ///< squared length of each lane's row of `inverse`; 1 where a lane is empty
  double per_length2[kLanes];     ///< its reciprocal
  double y[kRows];
  double y_sum;          ///< sum of |y|
  double inverse_error;  ///< largest entry of |B B^-1 - I|; below 0: not looked at yet
  double dual_excess;    ///< largest violation of A'y <= c, and of equality on the basis
  std::uint32_t tight;   ///< bit j: ray j is in the basis
  Lanes lanes;
  Lanes columns;              ///< of Program::column, what each lane multiplies
  std::int16_t next[kLanes];  ///< the vertex at the other end of a lane's edge
  std::uint8_t logical;       ///< bit i: lane i is a logical
};
inline constexpr std::int16_t kUnknown = -1;  ///< not walked yet, or not safely
inline constexpr std::int16_t kEndless =
    -2;  ///< the edge has no end: a load for which this lane is below 0 is infeasible

/// What has been learnt of one program.
struct alignas(64) Memory {
  double y[kMaxVertices][kLanes];     ///< the vertices that were an answer
  std::int16_t answer[kMaxVertices];  ///< which these are
  int answers;
  Vertex vertex[kMaxVertices];
  std::int16_t place[2 * kMaxVertices];  ///< hash of `tight` to vertex, -1: none
  int vertices;
};

enum class Status : std::uint8_t {
  Optimal,
  Infeasible,
  Doubtful,  ///< not certified: solve with more digits
};

struct Answer {
  double value = 0;  ///< y.b
  Status status = Status::Doubtful;
  const Vertex* vertex = nullptr;  ///< where Optimal; in the memory, until that forgets
};

/// One instruction set's kernel.
struct Kernel {
  const char* name;
  /// Solves for `count` right-hand sides; updates the memory. Entry k of the i-th is b[k * stride + i]; `b`
  /// is aligned to 64 bytes, `stride` a multiple of 8, and entries past the last of a row finite.
  void (*solve)(const Program&, Memory&, const double* b, int stride, int count, Answer*);
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

// The kernel, compiled once for each instruction set: define PINJAW_KERNEL, then include. Everything here has
// internal linkage and no library header but the compiler's own intrinsics is used, so no code of a wide
// instruction set can leak into the rest of the program.

#include "host/planner/force/kernel.hpp"
#include "host/planner/force/kernel_octet.hpp"
// after kernel_octet.hpp
#include "host/planner/force/kernel_edge.hpp"
// after kernel_edge.hpp
#include "host/planner/force/kernel_certificate.hpp"

namespace pinjaw::planner::kernel {
namespace {

constexpr double kPrimalTolerance = 1e-10;  // of |b|; measured: 1e-12 and 1e-13 change nothing
constexpr double kFarkasDepth =
    1e-9;  // of a unit step and |b|: how clearly an infeasible load must lie outside
constexpr double kSoundExcess =
    1e-6;                       // of a reduced cost: a vertex further out is rounding and leads nowhere
constexpr int kMaxSteps = 100;  // an ordinary walk takes 1 or 2

constexpr int kFewAnswers = 24;  // chosen (measured: 48 is slower)

/// A right-hand side.
struct Load {
  Octet b[kRows];
  double size;       // largest |b|
  double tolerance;  // of x
};

/// Right-hand sides side by side.
struct Loads {
  const double* b;
  int stride;

  [[nodiscard]] double at(int row, int i) const { return b[row * stride + i]; }
};

inline Load load_of(const Loads& loads, int i) {
  Load of;
  of.size = 0;
  for (int k = 0; k < kRows; ++k) {
    of.b[k] = all(loads.at(k, i));
    of.size = larger(of.size, magnitude(loads.at(k, i)));
  }
  of.tolerance = kPrimalTolerance * of.size;
  return of;
}

/// For each of eight loads the place of the vertex with the largest y.b among those that were an answer, the
/// first among equals; 0 with none.
inline Octet best_answers(const Memory& memory, const Octet (&b)[kRows]) {
  Octet best = all(-__builtin_inf());
  Octet best_place = all(0);
  for (int place = 0; place < memory.answers; ++place) {
    const double* y = memory.y[place];
    Octet value = b[0] * all(y[0]);
    for (int k = 1; k < kRows; ++k) value = value + b[k] * all(y[k]);
    const Mask higher = below(best, value);
    best = larger(best, value);
    best_place = choose(higher, all(place), best_place);
  }
  return best_place;
}

/// Lists a vertex for best_answers().
inline void list(Memory& memory, int vertex) {
  const int place = memory.answers++;
  memory.answer[place] = static_cast<std::int16_t>(vertex);
  for (int k = 0; k < kRows; ++k) memory.y[place][k] = memory.vertex[vertex].y[k];
}

inline unsigned slot_of(std::uint32_t tight) {
  constexpr int kSlotBits = 11;
  static_assert(1 << kSlotBits == 2 * kMaxVertices);
  return (tight * 2654435769U) >> (32 - kSlotBits);  // Knuth's multiplicative hash
}

/// The vertex known by its tight rays; -1: none. `slot` is where it belongs.
inline int known_vertex(const Memory& memory, std::uint32_t tight, unsigned& slot) {
  slot = slot_of(tight);
  while (memory.place[slot] >= 0) {
    if (memory.vertex[memory.place[slot]].tight == tight) return memory.place[slot];
    slot = (slot + 1) % (2 * kMaxVertices);
  }
  return -1;
}

/// Keeps the vertex that was written at place `memory.vertices`.
inline int keep(Memory& memory, unsigned slot) {
  const int vertex = memory.vertices++;
  memory.place[slot] = static_cast<std::int16_t>(vertex);
  return vertex;
}

/// The first vertex: from y = 0, the load's own rows give way to rays one by one. Where the rays have no full
/// rank, logicals remain.
inline int first_vertex(const Program& program, Memory& memory, const Loads& loads, int load) {
  Vertex scratch[2];
  Vertex* at = &scratch[0];
  at->lanes = at->columns = 0;
  for (int k = 0; k < kRows; ++k) {
    for (int i = 0; i < kLanes; ++i) at->inverse[k][i] = k == i ? 1 : 0;
    at->y[k] = 0;
  }
  for (int i = 0; i < kLanes; ++i) {
    at->length2[i] = at->per_length2[i] = 1;
    put(at->lanes, i, i < kRows ? lane::kLogical + i : lane::kNone);
    put(at->columns, i, i < kRows ? kUnit + i : kNothing);
    at->next[i] = kUnknown;
  }
  at->inverse_error = -1;
  at->tight = 0;
  at->logical = (1 << kRows) - 1;
  settle_costs(program, *at);
  for (int lane = 0; lane < kRows; ++lane) {
    double x = 0;
    for (int k = 0; k < kRows; ++k) x += at->inverse[k][lane] * loads.at(k, load);
    const double towards = x > 0 ? -1 : 1;
    for (int way = 0; way < 2; ++way) {
      const double sign = way == 0 ? towards : -towards;
      const int entering = entering_ray(program, *at, lane, sign);
      if (entering < 0) continue;
      Vertex* const to = at == &scratch[0] ? &scratch[1] : &scratch[0];
      if (!walk(program, *at, exchange_of(program, *at, lane, entering), *to)) continue;
      settle_costs(program, *to);
      at = to;
      break;
    }
  }
  unsigned slot = 0;
  known_vertex(memory, at->tight, slot);
  memory.vertex[0] = *at;
  return keep(memory, slot);
}

/// Where the edge of a lane leads, walking it where nobody has: a vertex, kEndless, or kUnknown for an edge
/// that cannot be walked safely.
inline int next_vertex(const Program& program, Memory& memory, int from, int lane) {
  const int entering = entering_ray(program, memory.vertex[from], lane, 1);
  if (entering < 0) return entering;
  const Exchange change = exchange_of(program, memory.vertex[from], lane, entering);
  unsigned slot = 0;
  const int known = known_vertex(memory, change.tight, slot);
  if (known >= 0) return known;
  if (memory.vertices == kMaxVertices) return kUnknown;
  Vertex& to = memory.vertex[memory.vertices];
  if (!walk(program, memory.vertex[from], change, to)) return kUnknown;
  settle_costs(program, to);
  if (!(to.dual_excess <= kSoundExcess && to.y_sum < __builtin_inf())) return kUnknown;
  to.next[lane] = static_cast<std::int16_t>(from);
  return keep(memory, slot);
}

/// How clearly a load lies outside, by a lane that must be at least 0.
inline bool is_deep(const Vertex& vertex, int lane, double x, double size) {
  const double least = kFarkasDepth * size;
  return x * x >= least * least * vertex.length2[lane];
}

inline double value_at(const double* y, const Loads& loads, int i) {
  double value = y[0] * loads.at(0, i);
  for (int k = 1; k < kRows; ++k) value += y[k] * loads.at(k, i);
  return value;
}

/// A load that a logical cannot balance: Farkas' certificate is its row.
inline Status beyond_rank(const Program& program, const Vertex& vertex, const Octet x, int lane,
                          double size) {
  alignas(64) double entries[kLanes];
  store(entries, x);
  const double sign = entries[lane] > 0 ? -1 : 1;
  const bool endless = entering_ray(program, vertex, lane, sign) == kEndless;
  return endless && is_deep(vertex, lane, entries[lane], size) ? Status::Infeasible : Status::Doubtful;
}

/// Solves one load, starting at a vertex.
inline void solve_from(const Program& program, Memory& memory, const Loads& loads, int i, int at,
                       Answer& answer) {
  const Load load_now = load_of(loads, i);
  answer.status = Status::Doubtful;
  answer.vertex = nullptr;
  for (int steps = 0; steps < kMaxSteps; ++steps) {
    Vertex& vertex = memory.vertex[at];
    Octet inverse[kRows];
    for (int k = 0; k < kRows; ++k) inverse[k] = load(vertex.inverse[k]);
    const Octet x = combine(inverse, load_now.b);
    const unsigned beyond = vertex.logical & bits_of(below(all(load_now.tolerance), magnitude(x)));
    if (beyond != 0) {
      answer.status = beyond_rank(program, vertex, x, lowest_bit(beyond), load_now.size);
      return;
    }
    if (bits_of(below(x, all(-load_now.tolerance))) == 0) {
      if (vertex.inverse_error < 0) {
        certify(program, vertex);
        list(memory, at);
      }
      answer.value = value_at(vertex.y, loads, i);
      answer.vertex = &vertex;
      if (certified(program, vertex, larger(0, -least_of(x)), load_now.size, answer.value))
        answer.status = Status::Optimal;
      return;
    }
    const Octet depth = x * magnitude(x) * load(vertex.per_length2);
    const unsigned deepest = lanes_at(depth, least_of(depth));
    if (deepest == 0) return;  // NaN
    const int lane = lowest_bit(deepest);
    int next = vertex.next[lane];
    if (next == kUnknown) {
      next = next_vertex(program, memory, at, lane);
      vertex.next[lane] = static_cast<std::int16_t>(next);
    }
    if (next < 0) {
      alignas(64) double entries[kLanes];
      store(entries, x);
      if (next == kEndless && is_deep(vertex, lane, entries[lane], load_now.size))
        answer.status = Status::Infeasible;
      return;
    }
    at = next;
  }
}

void solve(const Program& program, Memory& memory, const double* b, int stride, int count, Answer* answers) {
  const Loads loads{b, stride};
  for (int first = 0; first < count;) {
    if (memory.vertices > kMaxVertices / 2) forget(memory);
    if (memory.vertices == 0) first_vertex(program, memory, loads, first);
    // one at a time while each is likely to find an answer that the next can use
    const int width = memory.answers < kFewAnswers || first % kLanes != 0 ? 1 : kLanes;
    Octet block[kRows];
    for (int k = 0; k < kRows; ++k)
      block[k] = width == 1 ? all(loads.at(k, first)) : load(b + k * stride + first);
    alignas(64) double place[kLanes];
    store(place, best_answers(memory, block));
    const bool known = memory.answers > 0;
    const int last = first + width < count ? first + width : count;
    for (int i = first; i < last; ++i) {
      const int start = known ? memory.answer[static_cast<int>(place[i - first])] : 0;
      solve_from(program, memory, loads, i, start, answers[i]);
    }
    first = last;
  }
}

}  // namespace

extern const Kernel PINJAW_KERNEL;
const Kernel PINJAW_KERNEL{PINJAW_KERNEL_NAME, &solve};

}  // namespace pinjaw::planner::kernel

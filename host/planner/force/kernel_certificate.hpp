// What a vertex is worth: how far its inverse and its dual point are from exact, and what that means for an
// answer. Internal linkage only; to be included by kernel_body.hpp alone.

namespace pinjaw::planner::kernel {
namespace {

constexpr double kCertifiedError = 1e-10;  // of max(1, |F|)
constexpr double kRefine = 1e-13;  // chosen: errors above this are mended once (a fresh inverse has 1e-15)

inline double larger(double a, double b) {
  return a > b ? a : b;
}
inline double magnitude(double a) {
  return a < 0 ? -a : a;
}

/// The lanes of `up` where a pin sticks on several plan rays: there up + down is the sum of the rays.
inline unsigned sums_of(const Vertex& vertex) {
  unsigned sums = 0;
  for (int i = 0; i < kLanes; ++i) {
    const int column = lane_of(vertex.columns, i);
    sums |= static_cast<unsigned>(column >= kUpwards && column < kDownwards) << i;
  }
  return sums;
}

inline double cost_of(const Program& program, int column) {
  return column < kUpwards ? program.cost[column % kPlanRays] : 0;
}
static_assert(kMiddle % kPlanRays == 0);

/// Calls `function(up, down, rays)` with the lanes of each sum.
template <class Function>
inline void for_each_sum(const Program& program, const Vertex& vertex, Function function) {
  for (unsigned sums = sums_of(vertex); sums != 0; sums &= sums - 1) {
    const int up = lowest_bit(sums);
    const int pin = lane_of(vertex.lanes, up) - lane::kUp;
    unsigned rays = 0;
    for (std::uint32_t left = vertex.tight & program.rays_of_pin[pin]; left != 0; left &= left - 1)
      rays |= 1U << find(vertex.lanes, lowest_bit(left));
    function(up, find(vertex.lanes, lane::kDown + pin), rays);
  }
}

inline double sum_of(const double (&row)[kLanes], unsigned lanes) {
  double sum = 0;
  for (; lanes != 0; lanes &= lanes - 1) sum += row[lowest_bit(lanes)];
  return sum;
}

/// product[k] = column k of B times the vertex's inverse. The largest difference from the unit matrix, or of
/// a sum from what it should be.
inline double multiply_back(const Program& program, const Vertex& vertex, Octet (&product)[kRows]) {
  Octet column[kLanes];
  for (int i = 0; i < kLanes; ++i) column[i] = load(program.column[lane_of(vertex.columns, i)]);
  Octet worst = all(0);
  for (int k = 0; k < kRows; ++k) {
    product[k] = column[0] * all(vertex.inverse[k][0]);
    for (int i = 1; i < kLanes; ++i) product[k] = product[k] + column[i] * all(vertex.inverse[k][i]);
    worst = larger(worst, magnitude(product[k] - load(program.column[kUnit + k])));
  }
  double error = largest_of(worst);
  for_each_sum(program, vertex, [&](int up, int down, unsigned rays) {
    for (const auto& row : vertex.inverse)
      error = larger(error, magnitude(row[up] + row[down] - sum_of(row, rays)));
  });
  return error;
}

/// Reduced costs and the dual point's error from its y.
inline void settle_costs(const Program& program, Vertex& vertex) {
  Octet y[kRows];
  spread(vertex.y, y);
  Octet used[4];
  along_rays(program, y, used);
  Octet excess = all(0);
  for (int p = 0; p < 4; ++p) {
    const Octet reduced = load(&program.cost[p % 2 * kLanes]) - used[p];
    const Mask tight = mask_of((vertex.tight >> (p * kLanes)) & 0xffU);
    excess = larger(excess, larger(all(0) - reduced, choose(tight, reduced, all(0))));
    store(&vertex.reduced_cost[p * kLanes], choose(tight, all(0), larger(reduced, all(0))));
  }
  vertex.y_sum = 0;
  for (int k = 0; k < kRows; ++k) vertex.y_sum += magnitude(vertex.y[k]);
  vertex.dual_excess = largest_of(excess);
}

/// One Newton-Schulz step, inverse (2 I - B inverse), then y afresh.
inline void refine(const Program& program, const Octet (&product)[kRows], Vertex& vertex) {
  Octet rows[kRows];
  for (int k = 0; k < kRows; ++k) rows[k] = load(vertex.inverse[k]);
  for (int k = 0; k < kRows; ++k) {
    alignas(64) double entries[kLanes];
    store(entries, insert(all(0), k, 2) - product[k]);
    Octet factor[kRows];
    spread(entries, factor);
    store(vertex.inverse[k], combine(rows, factor));
  }
  for_each_sum(program, vertex, [&](int up, int down, unsigned rays) {
    for (auto& row : vertex.inverse) row[up] = sum_of(row, rays) - row[down];
  });
  for (int k = 0; k < kRows; ++k) {
    vertex.y[k] = 0;
    for (int i = 0; i < kLanes; ++i)
      vertex.y[k] += cost_of(program, lane_of(vertex.columns, i)) * vertex.inverse[k][i];
  }
}

/// Looks at a vertex's errors for the first time, and mends them once where they are worn.
inline void certify(const Program& program, Vertex& vertex) {
  Octet product[kRows];
  vertex.inverse_error = multiply_back(program, vertex, product);
  if (vertex.inverse_error <= kRefine && vertex.dual_excess <= kRefine) return;
  refine(program, product, vertex);
  vertex.inverse_error = multiply_back(program, vertex, product);
  settle_costs(program, vertex);
}

/// The bound on |y.b - F|: what x's negative part, the inverse's error, y's excess and costs set apart can
/// change. With sum x <= F / least cost. NaN counts as doubtful.
inline bool certified(const Program& program, const Vertex& vertex, double below, double size, double value) {
  const double error = vertex.y_sum * kRows * (below + vertex.inverse_error * size) +
                       vertex.dual_excess * (magnitude(value) + 1) / program.least_cost +
                       kApart * magnitude(value);
  return error <= kCertifiedError * larger(1, magnitude(value));
}

}  // namespace
}  // namespace pinjaw::planner::kernel

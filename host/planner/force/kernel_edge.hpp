// From one vertex of the dual polytope to the next along an edge. Internal linkage only; to be included by
// kernel_body.hpp alone.

namespace pinjaw::planner::kernel {
namespace {

// Chosen by comparison with quadruple precision (measured: pivots of 1e-11 do harm).
constexpr double kPivotTolerance = 1e-9;  // of the length of the edge's row
constexpr double kLongest2 = 1e24;  // squared length of a row past which a basis is no basis; nor is NaN
constexpr double kTie = 1e-12;      // reduced costs this close are equal: among them the largest pivot
constexpr double kFarkasExcess =
    1e-12;  // of the same: an edge without end may leave the polytope this slowly

inline int lowest_bit(std::uint32_t bits) {
  return __builtin_ctz(bits);
}
inline bool is_single(std::uint32_t bits) {
  return (bits & (bits - 1)) == 0;
}

constexpr Lanes kOnes = 0x0101010101010101;

/// The lane that stands for `what`; -1: none.
inline int find(Lanes lanes, int what) {
  const Lanes differing = lanes ^ (kOnes * static_cast<Lanes>(what));
  const Lanes zeros =
      (differing - kOnes) & ~differing & (kOnes << 7);  // the lowest marks the first zero byte
  return zeros == 0 ? -1 : __builtin_ctzll(zeros) / 8;
}

inline void put(Lanes& lanes, int i, int what) {
  lanes = (lanes & ~(Lanes{0xff} << (8 * i))) | (static_cast<Lanes>(what) << (8 * i));
}

/// Bit i: lane i stands for nothing. (No other lane has the highest bit.)
inline unsigned empty_lanes(Lanes lanes) {
  const Lanes highest = (lanes >> 7) & kOnes;
  return static_cast<unsigned>((highest * 0x0102040810204080) >> 56);
}

/// out = A' v, by the 32 rays.
inline void along_rays(const Program& program, const Octet (&v)[kRows], Octet (&out)[4]) {
  for (int half = 0; half < 2; ++half) {
    const int from = half * kLanes;
    Octet flat = load(&program.plan[0][from]) * v[0];
    flat = flat + load(&program.plan[1][from]) * v[1];
    for (int k = 2; k < kRows - 1; ++k) flat = flat + load(&program.plan[k][from]) * v[k + 1];
    Octet lift = load(&program.lift[0][from]) * v[2];
    for (int k = 1; k < 3; ++k) lift = lift + load(&program.lift[k][from]) * v[k + 2];
    out[half] = flat + lift;
    out[2 + half] = flat - lift;
  }
}

inline void spread(const double* scalars, Octet (&out)[kRows]) {
  for (int k = 0; k < kRows; ++k) out[k] = all(scalars[k]);
}

/// out = sum over k of matrix[k] v[k].
inline Octet combine(const Octet (&matrix)[kRows], const Octet (&v)[kRows]) {
  Octet sum = matrix[0] * v[0];
  for (int k = 1; k < kRows; ++k) sum = sum + matrix[k] * v[k];
  return sum;
}

/// The ray whose reduced cost reaches 0 first along the edge of a lane, on which the lane's row grows by
/// `sign` times its length; kEndless: none does; kUnknown: none clearly does.
inline int entering_ray(const Program& program, const Vertex& from, int lane, double sign) {
  Octet rho[kRows];
  for (int k = 0; k < kRows; ++k) rho[k] = all(sign * from.inverse[k][lane]);
  const double length = __builtin_sqrt(from.length2[lane]);
  Octet alpha[4];
  along_rays(program, rho, alpha);
  const Octet none = all(0);
  Octet gain[4];
  Octet cost[4];
  Octet steepest = none;
  for (int p = 0; p < 4; ++p) {
    const Octet down = none - alpha[p];
    steepest = larger(steepest, down);
    gain[p] = choose(below(all(kPivotTolerance * length), down), down, none);
    cost[p] = load(&from.reduced_cost[p * kLanes]) + all(kTie);
  }
  // least cost / gain, without dividing but once
  const Mask first = below(cost[1] * gain[0], cost[0] * gain[1]);
  const Mask second = below(cost[3] * gain[2], cost[2] * gain[3]);
  const Octet gain_up = choose(first, gain[1], gain[0]);
  const Octet cost_up = choose(first, cost[1], cost[0]);
  const Octet gain_down = choose(second, gain[3], gain[2]);
  const Octet cost_down = choose(second, cost[3], cost[2]);
  const Mask third = below(cost_down * gain_up, cost_up * gain_down);
  const Octet ratio = choose(third, cost_down, cost_up) / choose(third, gain_down, gain_up);
  const double least = least_of(ratio);
  if (!(least < __builtin_inf())) return largest_of(steepest) <= kFarkasExcess * length ? kEndless : kUnknown;
  const int column = lowest_bit(lanes_at(ratio, least));
  const bool down = ((bits_of(third) >> column) & 1U) != 0;
  const bool high = (((down ? bits_of(second) : bits_of(first)) >> column) & 1U) != 0;
  return (down ? kPlanRays : 0) + (high ? kLanes : 0) + column;
}

/// What changes from one vertex to the next: the lane given up takes the column that enters.
struct Exchange {
  int lane = 0;
  int column = 0;
  double amount = 1;  // how much of the column a unit of what enters is
  int spare = -1;     // lane that becomes a function of others: the sum of the lanes in `sum`
  unsigned sum = 0;
  unsigned plus_one = 0;  // lanes whose function also changes by the entering amount times this
  unsigned minus_half = 0;
  double reduced_cost = 0;  // of the entering column
  std::uint32_t tight = 0;
  Lanes lanes = 0;
  Lanes columns = 0;
};

/// Lets the plan rays of a pin multiply the columns from `base` on.
inline void set_columns(std::uint32_t rays, int base, Exchange& change) {
  for (; rays != 0; rays &= rays - 1)
    put(change.columns, find(change.lanes, lowest_bit(rays)), base + lowest_bit(rays));
}

inline void set_lane(int lane, int what, int column, Exchange& change) {
  put(change.lanes, lane, what);
  put(change.columns, lane, column);
}

/// Takes the lane's own variable out of the basis.
inline void give_up(const Program& program, int entering_pin, Exchange& change) {
  const int gone = lane_of(change.lanes, change.lane);
  set_lane(change.lane, lane::kNone, kNothing, change);
  if (gone < lane::kUp) {
    const std::uint32_t rays = program.rays_of_pin[program.pin_of_ray[gone]];
    change.tight &= ~((1U << gone) | (1U << (gone + kPlanRays)));
    const std::uint32_t left = change.tight & (change.tight >> kPlanRays) & rays;
    const int pin = program.pin_of_ray[gone];
    if (left == 0 || !is_single(left) || pin == entering_pin) return;
    // a sticking pin's only plan ray is up + down: it needs no lane
    const int only = lowest_bit(left);
    set_lane(find(change.lanes, only), lane::kNone, kNothing, change);
    put(change.columns, find(change.lanes, lane::kUp + pin), only);
    put(change.columns, find(change.lanes, lane::kDown + pin), only + kPlanRays);
    return;
  }
  if (gone >= lane::kLogical) return;
  const bool was_up = gone < lane::kDown;
  const int pin = gone - (was_up ? lane::kUp : lane::kDown);
  change.tight &= ~(program.rays_of_pin[pin] << (was_up ? 0 : kPlanRays));
  const std::uint32_t left = (change.tight | (change.tight >> kPlanRays)) & program.rays_of_pin[pin];
  const int other = find(change.lanes, (was_up ? lane::kDown : lane::kUp) + pin);
  if (is_single(left)) {
    put(change.lanes, other, lowest_bit(left));
    return;
  }
  set_lane(other, lane::kNone, kNothing, change);
  set_columns(left, was_up ? kPlanRays : 0, change);
}

/// Lets a pin that slides stick: the force up or down that is at its limit moves off it.
inline void let_stick(const Program& program, const Vertex& from, int pin, bool slides_up, Exchange& change) {
  const std::uint32_t rays = (change.tight | (change.tight >> kPlanRays)) & program.rays_of_pin[pin];
  const int first = lowest_bit(rays);
  change.column = (slides_up ? kDownwards : kUpwards) + pin;
  change.amount = 2;
  change.reduced_cost = from.reduced_cost[slides_up ? first + kPlanRays : first];
  change.tight |= rays | (rays << kPlanRays);
  put(change.lanes, change.lane, (slides_up ? lane::kDown : lane::kUp) + pin);
  int other = 0;
  if (is_single(rays)) {
    other = find(change.lanes, first);
    put(change.columns, change.lane, slides_up ? first + kPlanRays : first);
  } else {
    other = find(change.lanes, lane::kNone);
    change.spare = other;
    put(change.columns, change.lane, change.column);
    put(change.columns, other, (slides_up ? kUpwards : kDownwards) + pin);
    set_columns(rays, kMiddle, change);
    for (std::uint32_t left = rays; left != 0; left &= left - 1)
      change.sum |= 1U << find(change.lanes, lowest_bit(left));
  }
  change.plus_one = 1U << other;
  put(change.lanes, other, (slides_up ? lane::kUp : lane::kDown) + pin);
}

/// Lets a plan ray of a sticking pin into the basis.
inline void let_stick_more(const Program& program, int ray, int pin, Exchange& change) {
  const std::uint32_t rays = change.tight & program.rays_of_pin[pin];
  const int up = find(change.lanes, lane::kUp + pin);
  const int down = find(change.lanes, lane::kDown + pin);
  change.column = kMiddle + ray;
  change.tight |= (1U << ray) | (1U << (ray + kPlanRays));
  set_lane(change.lane, ray, change.column, change);
  change.minus_half = (1U << up) | (1U << down);
  if (!is_single(rays)) return;
  const int only = lowest_bit(rays);
  if (find(change.lanes, only) >= 0) return;
  change.spare = find(change.lanes, lane::kNone);
  change.sum = change.minus_half;
  set_lane(change.spare, only, kMiddle + only, change);
  put(change.columns, up, kUpwards + pin);
  put(change.columns, down, kDownwards + pin);
}

/// Whether a pin that slides comes to rest along the edge of a lane; else both rays of each of its pairs come
/// nearer alike.
inline bool stops_sliding(const Program& program, const Vertex& from, int lane, int pin, bool slides_up) {
  const double* column = program.column[(slides_up ? kDownwards : kUpwards) + pin];
  double along = 0;
  for (int k = 2; k < 5; ++k) along += column[k] * from.inverse[k][lane];
  return 2 * along < -kPivotTolerance * __builtin_sqrt(from.length2[lane]);
}

/// The exchange of a lane's variable for what `entering` stands for.
inline Exchange exchange_of(const Program& program, const Vertex& from, int given_up, int entering) {
  Exchange change;
  change.lane = given_up;
  change.tight = from.tight;
  change.lanes = from.lanes;
  change.columns = from.columns;
  const int ray = entering % kPlanRays;
  const bool is_up = entering < kPlanRays;
  const int pin = program.pin_of_ray[ray];
  give_up(program, pin, change);
  const std::uint32_t up = change.tight & program.rays_of_pin[pin];
  const std::uint32_t down = (change.tight >> kPlanRays) & program.rays_of_pin[pin];
  change.reduced_cost = from.reduced_cost[entering];
  if (up != 0 && down != 0) {
    let_stick_more(program, ray, pin, change);
  } else if ((is_up ? down : up) != 0 && stops_sliding(program, from, given_up, pin, !is_up)) {
    let_stick(program, from, pin, !is_up, change);
  } else {
    const int ray_of_pair = up != 0 ? ray : down != 0 ? ray + kPlanRays : entering;
    change.column = ray_of_pair;
    change.reduced_cost = from.reduced_cost[ray_of_pair];
    change.tight |= 1U << ray_of_pair;
    set_lane(given_up, ray, change.column, change);
  }
  return change;
}

/// Fills `to` but for what settle() does; false where the pivot is too small or the basis nearly singular.
inline bool walk(const Program& program, const Vertex& from, const Exchange& change, Vertex& to) {
  Octet rows[kRows];
  for (int k = 0; k < kRows; ++k) rows[k] = load(from.inverse[k]);
  if (change.spare >= 0) {
    for (int k = 0; k < kRows; ++k) {
      double sum = 0;
      for (unsigned left = change.sum; left != 0; left &= left - 1) sum += from.inverse[k][lowest_bit(left)];
      rows[k] = insert(rows[k], change.spare, sum);
    }
  }
  Octet column[kRows];
  spread(program.column[change.column], column);
  const Octet w = combine(rows, column) * all(change.amount);
  alignas(64) double entries[kLanes];
  store(entries, w);
  const double pivot = entries[change.lane];
  if (!(pivot * pivot > kPivotTolerance * kPivotTolerance * from.length2[change.lane])) return false;
  const double inverse_pivot = 1 / pivot;
  Octet moved = choose(mask_of(1U << change.lane), w - all(1), w);
  moved = choose(mask_of(change.plus_one), moved + all(1), moved);
  moved = choose(mask_of(change.minus_half), moved - all(0.5), moved);
  const Mask empty = mask_of(empty_lanes(change.lanes));
  Octet length2 = all(0);
  for (int k = 0; k < kRows; ++k) {
    const double step = from.inverse[k][change.lane] * inverse_pivot;
    const Octet row = choose(empty, all(0), rows[k] - moved * all(step));
    store(to.inverse[k], row);
    length2 = length2 + row * row;
    to.y[k] = from.y[k] + change.reduced_cost * step;
  }
  length2 = choose(empty, all(1), length2);
  if (bits_of(below(length2, all(kLongest2))) != 0xff) return false;
  store(to.length2, length2);
  store(to.per_length2, all(1) / length2);
  to.inverse_error = -1;
  to.tight = change.tight;
  to.lanes = change.lanes;
  to.columns = change.columns;
  to.logical = static_cast<std::uint8_t>(from.logical & ~(1U << change.lane));
  for (std::int16_t& next : to.next) next = kUnknown;
  return true;
}

}  // namespace
}  // namespace pinjaw::planner::kernel

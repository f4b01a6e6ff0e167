#include "host/planner/planar/pair.hpp"

#include <algorithm>
#include <cmath>

#include "host/planner/planar/constants.hpp"

namespace pinjaw::planner::planar {
namespace {

using geometry::across;
using geometry::cross;

constexpr double kParallelSine = 1e-6;   // chosen: nearer lines are searched as parallel, then polished
constexpr double kCoincident_mm = 1e-6;  // chosen: nearer circles are searched as coinciding, then polished
constexpr double kFoldNoise_mm2 = 1e-9;  // chosen: rounding of a square of some 100 mm, with room
constexpr double kSamePoint_rad = 1e-13;
constexpr double kLeastStretch_rad = 1e-12;

double angle_of(const Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

struct Turn {
  double c;
  double s;
  explicit Turn(double theta_rad) : c(std::cos(theta_rad)), s(std::sin(theta_rad)) {}
  Vector2d operator*(const Vector2d& v) const { return {c * v.x() - s * v.y(), s * v.x() + c * v.y()}; }
  [[nodiscard]] Vector2d back(const Vector2d& v) const {
    return {c * v.x() + s * v.y(), c * v.y() - s * v.x()};
  }
};

/// Point of the circle (origin, radius) on the line normal . p = level: along the tangent, either way.
std::optional<Vector2d> on_circle_and_line(double radius_mm, const Vector2d& normal, double level_mm,
                                           int branch) {
  const double square = radius_mm * radius_mm - level_mm * level_mm;
  if (square < -kFoldNoise_mm2) return std::nullopt;
  const double along_mm = square > 0 ? std::sqrt(square) : 0.0;
  return Vector2d(level_mm * normal + (branch == 0 ? along_mm : -along_mm) * across(normal));
}

std::optional<Vector2d> on_two_circles(double radius_mm, const Vector2d& other_center_mm,
                                       double other_radius_mm, int branch) {
  const double gap_mm = other_center_mm.norm();
  if (gap_mm < 1e-12) return std::nullopt;
  const double level_mm =
      (gap_mm * gap_mm + radius_mm * radius_mm - other_radius_mm * other_radius_mm) / (2 * gap_mm);
  return on_circle_and_line(radius_mm, other_center_mm / gap_mm, level_mm, branch);
}

/// Part origin seen from pin A; nothing where the branch does not exist.
std::optional<Vector2d> origin_at(const Pair& pair, const Turn& turn, int branch) {
  const ContactCurve& a = *pair.a;
  const ContactCurve& b = *pair.b;
  const Vector2d& v = pair.apart_mm;
  if (!a.arc && !b.arc) {
    if (branch != 0) return std::nullopt;
    const Vector2d na = turn * a.normal;
    const Vector2d nb = turn * b.normal;
    const double det = cross(na, nb);
    if (det == 0) return std::nullopt;
    const double level_a = -a.offset_mm;
    const double level_b = nb.dot(v) - b.offset_mm;
    return Vector2d((level_a * nb.y() - level_b * na.y()) / det, (na.x() * level_b - nb.x() * level_a) / det);
  }
  if (a.arc && b.arc) {
    const Vector2d centers = turn * Vector2d(b.center_mm - a.center_mm);
    const auto center_a = on_two_circles(a.rho_mm, v - centers, b.rho_mm, branch);
    if (!center_a) return std::nullopt;
    return Vector2d(*center_a - turn * a.center_mm);
  }
  if (a.arc) {
    const Vector2d nb = turn * b.normal;
    const double level = nb.dot(v) - b.offset_mm + b.normal.dot(a.center_mm);
    const auto center_a = on_circle_and_line(a.rho_mm, nb, level, branch);
    if (!center_a) return std::nullopt;
    return Vector2d(*center_a - turn * a.center_mm);
  }
  const Vector2d na = turn * a.normal;
  const double level = a.normal.dot(b.center_mm) - a.offset_mm - na.dot(v);
  const auto center_b = on_circle_and_line(b.rho_mm, na, level, branch);
  if (!center_b) return std::nullopt;
  return Vector2d(v + *center_b - turn * b.center_mm);
}

Vector2d jaw_normal(const ContactCurve& curve, const Turn& turn, const Vector2d& o_mm,
                    const Vector2d& pin_mm) {
  if (!curve.arc) return turn * curve.normal;
  return curve.kappa / curve.rho_mm * (pin_mm - o_mm - turn * curve.center_mm);
}

/// Values of theta at which something about a pair changes.
class Changes {
 public:
  explicit Changes(const Pair& pair) : pair_(pair) {
    at_end(*pair.a, *pair.b, 1);
    at_end(*pair.b, *pair.a, -1);
    at_folds();
    at_window(*pair.a);
    at_window(*pair.b);
    add(0);
    add(kPi);
  }

  [[nodiscard]] std::vector<double> sorted() {
    std::sort(at_.begin(), at_.end());
    at_.push_back(kTurn);
    return at_;
  }

 private:
  void add(double theta_rad) { at_.push_back(geometry::wrapped_rad(theta_rad)); }

  /// theta where the unit vector at theta + phi has the component `level / |k|` along k.
  void add_component(const Vector2d& k, double phi_rad, double level) {
    const double length = k.norm();
    if (length < 1e-12 || std::abs(level) > length) return;
    const double half_rad = std::acos(level / length);
    const double middle_rad = angle_of(k) - phi_rad;
    add(middle_rad - half_rad);
    add(middle_rad + half_rad);
  }

  /// One pin at an end of its curve, the other anywhere on its own.
  void at_end(const ContactCurve& ended, const ContactCurve& other, int sign) {
    const double apart_mm = pair_.apart_mm.norm();
    if (ended.arc && ended.full) return;
    for (const Vector2d& end : ended.ends_mm) {
      for (int branch = 0; branch < 2; ++branch) {
        std::optional<Vector2d> w;
        if (other.arc) {
          w = on_two_circles(apart_mm, other.center_mm - end, other.rho_mm, branch);
        } else {
          w = on_circle_and_line(apart_mm, other.normal, other.offset_mm - other.normal.dot(end), branch);
        }
        if (w) add(angle_of(pair_.apart_mm) - angle_of(sign * *w));
      }
    }
  }

  void at_folds() {
    const ContactCurve& a = *pair_.a;
    const ContactCurve& b = *pair_.b;
    const Vector2d& v = pair_.apart_mm;
    if (a.arc && b.arc) {
      const Vector2d centers = b.center_mm - a.center_mm;
      const double length = centers.norm();
      if (length < 1e-12) return;
      for (const double gap : {a.rho_mm + b.rho_mm, std::abs(a.rho_mm - b.rho_mm)}) {
        add_component(v, angle_of(centers), (v.squaredNorm() + length * length - gap * gap) / (2 * length));
      }
    } else if (a.arc) {
      const double level = b.offset_mm - b.normal.dot(a.center_mm);
      add_component(v, b.normal_rad, level + a.rho_mm);
      add_component(v, b.normal_rad, level - a.rho_mm);
    } else if (b.arc) {
      const double level = a.normal.dot(b.center_mm) - a.offset_mm;
      add_component(v, a.normal_rad, level + b.rho_mm);
      add_component(v, a.normal_rad, level - b.rho_mm);
    }
  }

  /// The contact on `curve` starts or stops pushing the part to +x: its normal is +y or -y.
  void at_window(const ContactCurve& curve) {
    if (!curve.arc) {
      add(kPi / 2 - curve.normal_rad);
      add(-kPi / 2 - curve.normal_rad);
      return;
    }
    const bool is_a = &curve == pair_.a;
    const ContactCurve& other = is_a ? *pair_.b : *pair_.a;
    const Vector2d towards = is_a ? pair_.apart_mm : Vector2d(-pair_.apart_mm);
    for (const double side : {-1.0, 1.0}) {
      const Vector2d k =
          towards - Vector2d(0, side * curve.rho_mm);  // the other pin from this curve's centre
      if (!other.arc) {
        add_component(k, other.normal_rad, other.offset_mm - other.normal.dot(curve.center_mm));
        continue;
      }
      const Vector2d centers = other.center_mm - curve.center_mm;
      const double length = centers.norm();
      if (length < 1e-12) continue;
      const double level = (k.squaredNorm() + length * length - other.rho_mm * other.rho_mm) / (2 * length);
      add_component(k, angle_of(centers), level);
    }
  }

  const Pair& pair_;
  std::vector<double> at_;
};

bool feasible(const Pair& pair, double theta_rad, int branch) {
  const Turn turn(theta_rad);
  const auto o_mm = origin_at(pair, turn, branch);
  if (!o_mm) return false;
  if (jaw_normal(*pair.a, turn, *o_mm, Vector2d::Zero()).x() >= 0) return false;
  if (jaw_normal(*pair.b, turn, *o_mm, pair.apart_mm).x() >= 0) return false;
  return in_range(*pair.a, turn.back(-*o_mm), kSearchWidening_mm) &&
         in_range(*pair.b, turn.back(pair.apart_mm - *o_mm), kSearchWidening_mm);
}

}  // namespace

std::optional<PairState> state_at(const Pair& pair, double theta_rad, int branch) {
  const Turn turn(theta_rad);
  const auto o_mm = origin_at(pair, turn, branch);
  if (!o_mm) return std::nullopt;
  PairState state;
  state.o_mm = *o_mm;
  state.normal_a = jaw_normal(*pair.a, turn, *o_mm, Vector2d::Zero());
  state.normal_b = jaw_normal(*pair.b, turn, *o_mm, pair.apart_mm);
  const double turning_a = -state.normal_a.dot(across(-*o_mm));
  const double turning_b = -state.normal_b.dot(across(pair.apart_mm - *o_mm));
  state.y_slope = (state.normal_a.x() * turning_b - state.normal_b.x() * turning_a) /
                  cross(state.normal_a, state.normal_b);
  return state;
}

std::vector<Stretch> stretches(const Pair& pair) {
  std::vector<Stretch> found;
  if (parallel_lines(pair)) return found;
  const std::vector<double> changes = Changes(pair).sorted();
  const int branches = pair.a->arc || pair.b->arc ? 2 : 1;
  for (int branch = 0; branch < branches; ++branch) {
    const std::size_t first = found.size();
    for (std::size_t i = 0; i + 1 < changes.size(); ++i) {
      const geometry::Interval between{changes[i], changes[i + 1]};
      if (between.length() < kLeastStretch_rad) continue;
      if (!feasible(pair, (between.lo + between.hi) / 2, branch)) continue;
      const bool joins = found.size() > first && branches == 1 &&
                         between.lo - found.back().theta_rad.hi < kSamePoint_rad &&
                         found.back().theta_rad.hi != kPi;
      if (joins) {
        found.back().theta_rad.hi = between.hi;
      } else {
        found.push_back({branch, between});
      }
    }
  }
  return found;
}

bool parallel_lines(const Pair& pair) {
  return !pair.a->arc && !pair.b->arc && std::abs(cross(pair.a->normal, pair.b->normal)) < kParallelSine;
}

std::vector<Standstill> standstills(const Pair& pair) {
  std::vector<Standstill> found;
  const ContactCurve& a = *pair.a;
  const ContactCurve& b = *pair.b;
  const Vector2d& v = pair.apart_mm;
  const double apart_mm = v.norm();
  if (parallel_lines(pair)) {
    const double level = b.offset_mm - a.offset_mm;
    if (a.normal.dot(b.normal) < 0 || std::abs(level) > apart_mm) return found;
    for (const double side : {-1.0, 1.0}) {
      const double theta_rad = angle_of(v) + side * std::acos(level / apart_mm) - a.normal_rad;
      const Turn turn(theta_rad);
      const Vector2d n = turn * a.normal;
      const Vector2d t = turn * a.tangent;
      if (n.x() >= 0) continue;
      const double lo = std::max(-a.range.hi, t.dot(v) - b.range.hi);
      const double hi = std::min(-a.range.lo, t.dot(v) - b.range.lo);
      if (lo > hi + kSearchWidening_mm) continue;
      const double y0 = -a.offset_mm * n.y() + lo * t.y();
      const double y1 = -a.offset_mm * n.y() + hi * t.y();
      found.push_back({geometry::wrapped_rad(theta_rad), {std::min(y0, y1), std::max(y0, y1)}});
    }
    return found;
  }
  if (!a.arc || !b.arc || a.kappa != b.kappa || std::abs(a.rho_mm - b.rho_mm) > kCoincident_mm) return found;
  const Vector2d centers = b.center_mm - a.center_mm;
  if (std::abs(centers.norm() - apart_mm) > kCoincident_mm) return found;
  const double theta_rad = angle_of(v) - angle_of(centers);
  const double center_y = (Turn(theta_rad) * a.center_mm).y();
  found.push_back({geometry::wrapped_rad(theta_rad), {-a.rho_mm - center_y, a.rho_mm - center_y}});
  return found;
}

}  // namespace pinjaw::planner::planar

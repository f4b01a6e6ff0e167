#include "tests/host/planner/planar/slow_search.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "host/planner/planar/outline.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Arc;
using geometry::Segment;
using geometry::Vector2d;

constexpr double kTurn = 2 * std::numbers::pi;

/// An angle with its sine and cosine, which every pair of one step shares.
struct Turn {
  double rad = 0;
  Vector2d x_axis = Vector2d::UnitX();

  explicit Turn(double angle_rad) : rad(angle_rad), x_axis(geometry::direction(angle_rad)) {}
};
Vector2d turned(const Turn& by, const Vector2d& v) {
  return {by.x_axis.x() * v.x() - by.x_axis.y() * v.y(), by.x_axis.y() * v.x() + by.x_axis.x() * v.y()};
}
Vector2d turned_back(const Turn& by, const Vector2d& v) {
  return {by.x_axis.x() * v.x() + by.x_axis.y() * v.y(), by.x_axis.x() * v.y() - by.x_axis.y() * v.x()};
}
double cross(const Vector2d& u, const Vector2d& v) {
  return u.x() * v.y() - u.y() * v.x();
}

/// A straight line or a circle in the plane of part origins.
struct Locus {
  bool circle = false;
  Vector2d point = Vector2d::Zero();  ///< on the line; centre of the circle
  Vector2d direction = Vector2d::UnitX();
  double radius = 0;
};

/// Both crossings, in a fixed order that follows the loci as they move.
std::array<std::optional<Vector2d>, 2> crossings(const Locus& p, const Locus& q) {
  if (!p.circle && !q.circle) {
    const double sine = cross(p.direction, q.direction);
    if (std::abs(sine) < 1e-9) return {};
    return {Vector2d(p.point + cross(q.point - p.point, q.direction) / sine * p.direction), std::nullopt};
  }
  if (p.circle && !q.circle) return crossings(q, p);
  if (!p.circle) {
    const double along = p.direction.dot(q.point - p.point);
    const Vector2d foot = p.point + along * p.direction;
    const double square = q.radius * q.radius - (foot - q.point).squaredNorm();
    if (square < 0) return {};
    const Vector2d half = std::sqrt(square) * p.direction;
    return {Vector2d(foot + half), Vector2d(foot - half)};
  }
  const Vector2d gap = q.point - p.point;
  const double distance = gap.norm();
  if (distance < 1e-12) return {};
  const double along = (distance * distance + p.radius * p.radius - q.radius * q.radius) / (2 * distance);
  const double square = p.radius * p.radius - along * along;
  if (square < 0) return {};
  const Vector2d middle = p.point + along / distance * gap;
  const Vector2d half = std::sqrt(square) / distance * Vector2d(-gap.y(), gap.x());
  return {Vector2d(middle + half), Vector2d(middle - half)};
}

struct Offset {
  int columns = 0;
  int rows = 0;
};

/// A pin that holds the part: which feature, in which hole (columns outwards, rows upwards).
struct Placed {
  int feature = 0;
  bool left = true;
  int column = 0;
  int row = 0;
};

class Search {
 public:
  Search(const model::Profile& profile, const model::Kit& kit, const ThetaSteps& steps)
      : profile_(profile), kit_(kit), features_(model::features_of(profile)), steps_(steps) {
    for (int rows = 0; rows < kit.grid.rows; ++rows) {
      for (int columns = rows == 0 ? 1 : 1 - kit.grid.columns; columns < kit.grid.columns; ++columns) {
        offsets_.push_back({columns, rows});
      }
    }
  }

  std::vector<SlowFixture> run() {
    const double start = steps_.from_rad + 0.5 * step();
    std::vector<Alive> before[2] = {alive(Turn(start), true), alive(Turn(start), false)};
    for (int i = 0; i < steps_.count; ++i) {
      const double lo = start + i * step();
      std::vector<Alive> after[2] = {alive(Turn(lo + step()), true), alive(Turn(lo + step()), false)};
      pairs(lo, before, after);
      triples(lo, before[0], after[0]);
      before[0] = std::move(after[0]);
      before[1] = std::move(after[1]);
    }
    parallels();
    return std::move(found_);
  }

 private:
  struct Key {
    int a, b, offset, branch;
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  struct Alive {
    Key key;
    Vector2d o_mm;  ///< part origin from pin A
  };

  [[nodiscard]] double step() const { return (steps_.to_rad - steps_.from_rad) / steps_.count; }
  [[nodiscard]] Vector2d apart(int offset, bool left) const {
    const Offset& o = offsets_[static_cast<std::size_t>(offset)];
    return kit_.grid.spacing_mm * Vector2d(left ? -o.columns : o.columns, o.rows);
  }

  /// Part origins from which the feature touches a pin at `pin_mm`.
  [[nodiscard]] Locus locus(int feature, const Turn& theta, const Vector2d& pin_mm) const {
    const model::Feature& f = features_[static_cast<std::size_t>(feature)];
    const double r = kit_.pins.radius_mm;
    Locus result;
    if (const auto* s = std::get_if<Segment>(&f.curve)) {
      const Vector2d t = (s->b_mm - s->a_mm).normalized();
      result.point = pin_mm - turned(theta, s->a_mm + r * Vector2d(t.y(), -t.x()));
      result.direction = turned(theta, t);
      return result;
    }
    const Arc& arc = std::get<Arc>(f.curve);
    result.circle = true;
    result.point = pin_mm - turned(theta, arc.center_mm);
    result.radius = f.bulge == model::Bulge::Convex ? arc.radius_mm + r : arc.radius_mm - r;
    return result;
  }

  /// Whether the pin stands on the feature's piece with room `slack_mm`, and its outward normal in the jaw
  /// frame.
  [[nodiscard]] std::optional<Vector2d> contact(int feature, const Turn& theta, const Vector2d& pin_mm,
                                                const Vector2d& o_mm, double slack_mm) const {
    const model::Feature& f = features_[static_cast<std::size_t>(feature)];
    const Vector2d q = turned_back(theta, pin_mm - o_mm);
    if (const auto* s = std::get_if<Segment>(&f.curve)) {
      const Vector2d t = (s->b_mm - s->a_mm).normalized();
      const double at = t.dot(q - s->a_mm);
      if (at < -slack_mm || at > (s->b_mm - s->a_mm).norm() + slack_mm) return std::nullopt;
      return turned(theta, Vector2d(t.y(), -t.x()));
    }
    const Arc& arc = std::get<Arc>(f.curve);
    const Vector2d u = (q - arc.center_mm).normalized();
    const double slack = slack_mm / arc.radius_mm;
    const double at = geometry::wrapped_rad(std::atan2(u.y(), u.x()) - arc.from_rad + slack);
    if (at > arc.sweep_rad + 2 * slack) return std::nullopt;
    return turned(theta, f.bulge == model::Bulge::Convex ? u : Vector2d(-u));
  }

  [[nodiscard]] std::optional<Vector2d> origin(const Key& key, const Turn& theta, bool left) const {
    return crossings(locus(key.a, theta, Vector2d::Zero()),
                     locus(key.b, theta, apart(key.offset, left)))[static_cast<std::size_t>(key.branch)];
  }

  /// All pairs that hold, give or take a little, at `theta`.
  [[nodiscard]] std::vector<Alive> alive(const Turn& theta, bool left) const {
    constexpr double kSlack_mm = 0.05;
    std::vector<Alive> list;
    const int count = static_cast<int>(features_.size());
    for (Key key{0, 0, 0, 0}; key.a < count; ++key.a) {
      for (key.b = 0; key.b < count; ++key.b) {
        for (key.offset = 0; key.offset < static_cast<int>(offsets_.size()); ++key.offset) {
          for (key.branch = 0; key.branch < 2; ++key.branch) {
            const auto o = origin(key, theta, left);
            if (!o) continue;
            const auto na = contact(key.a, theta, Vector2d::Zero(), *o, kSlack_mm);
            const auto nb = contact(key.b, theta, apart(key.offset, left), *o, kSlack_mm);
            const double side = left ? -1 : 1;
            if (na && nb && side * na->x() > -0.01 && side * nb->x() > -0.01) list.push_back({key, *o});
          }
        }
      }
    }
    return list;
  }

  /// Each pair that is alive before or after a step, with y at both ends of the part of the step in which its
  /// loci cross: all of it, or up to where they part.
  struct Moving {
    Key key;
    double from_rad, to_rad;
    double y0, y1;
  };
  [[nodiscard]] std::vector<Moving> moving(double lo, const std::vector<Alive>& before,
                                           const std::vector<Alive>& after, bool left) const {
    std::map<Key, std::pair<std::optional<double>, std::optional<double>>> both;
    for (const Alive& one : before) both[one.key].first = one.o_mm.y();
    for (const Alive& one : after) both[one.key].second = one.o_mm.y();
    const Turn at_lo(lo);
    const Turn at_hi(lo + step());
    std::vector<Moving> list;
    for (auto& [key, y] : both) {
      if (!y.first) {
        if (const auto o = origin(key, at_lo, left)) y.first = o->y();
      }
      if (!y.second) {
        if (const auto o = origin(key, at_hi, left)) y.second = o->y();
      }
      double from = lo;
      double to = lo + step();
      if (!y.first) y.first = last_y(key, to, from, left);
      if (!y.second) y.second = last_y(key, from, to, left);
      if (y.first && y.second) list.push_back({key, from, to, *y.first, *y.second});
    }
    return list;
  }

  /// y where the pair's loci part on the way from `there`, where they cross, to `gone`, which is moved to it.
  [[nodiscard]] std::optional<double> last_y(const Key& key, double there, double& gone, bool left) const {
    std::optional<double> y;
    for (int i = 0; i < 50; ++i) {
      const double middle = (there + gone) / 2;
      const auto o = origin(key, Turn(middle), left);
      if (o) y = o->y();
      (o ? there : gone) = middle;
    }
    gone = there;
    return y;
  }

  [[nodiscard]] std::optional<double> y_at(const Moving& pair, double theta, bool left) const {
    if (theta == pair.from_rad) return pair.y0;
    if (theta == pair.to_rad) return pair.y1;
    const auto o = origin(pair.key, Turn(theta), left);
    return o ? std::optional(o->y()) : std::nullopt;
  }

  /// The part of the step in which both pairs cross, and how much higher `p` is at its ends.
  struct Meeting {
    double from_rad, to_rad;
    double h0, h1;
  };
  [[nodiscard]] std::optional<Meeting> meeting(const Moving& p, const Moving& q, bool q_left) const {
    const double from = std::max(p.from_rad, q.from_rad);
    const double to = std::min(p.to_rad, q.to_rad);
    if (from >= to) return std::nullopt;
    const auto p0 = y_at(p, from, true);
    const auto p1 = y_at(p, to, true);
    const auto q0 = y_at(q, from, q_left);
    const auto q1 = y_at(q, to, q_left);
    if (!p0 || !p1 || !q0 || !q1) return std::nullopt;
    return Meeting{from, to, *p0 - *q0, *p1 - *q1};
  }

  template <typename Difference>
  [[nodiscard]] std::optional<Turn> halved(double lo, double hi, const Difference& difference) const {
    const auto at_lo = difference(Turn(lo));
    if (!at_lo) return std::nullopt;
    for (int i = 0; i < 60; ++i) {
      const double middle = (lo + hi) / 2;
      const auto at = difference(Turn(middle));
      if (!at) return std::nullopt;
      ((*at < 0) == (*at_lo < 0) ? lo : hi) = middle;
    }
    return Turn((lo + hi) / 2);
  }

  void pairs(double lo, const std::vector<Alive> (&before)[2], const std::vector<Alive> (&after)[2]) {
    const double d = kit_.grid.spacing_mm;
    const auto lefts = moving(lo, before[0], after[0], true);
    const auto rights = moving(lo, before[1], after[1], false);
    for (const Moving& l : lefts) {
      for (const Moving& r : rights) {
        const auto both = meeting(l, r, false);
        if (!both) continue;
        const double h0 = both->h0 / d;
        const double h1 = both->h1 / d;
        for (double m = std::ceil(std::min(h0, h1)); m <= std::max(h0, h1); ++m) {
          const auto root =
              halved(both->from_rad, both->to_rad, [&](const Turn& theta) -> std::optional<double> {
                const auto ol = origin(l.key, theta, true);
                const auto orr = origin(r.key, theta, false);
                if (!ol || !orr) return std::nullopt;
                return ol->y() - orr->y() - m * d;
              });
          if (root) two_and_two(*root, l.key, r.key, static_cast<int>(m));
        }
      }
    }
  }

  void two_and_two(const Turn& theta, const Key& l, const Key& r, int m) {
    const auto ol = origin(l, theta, true);
    const auto orr = origin(r, theta, false);
    if (ol && orr) judge(theta, pair_pins(l, true, 0), pair_pins(r, false, m), *ol, orr->x());
  }

  [[nodiscard]] std::vector<Placed> pair_pins(const Key& key, bool left, int row) const {
    const Offset& offset = offsets_[static_cast<std::size_t>(key.offset)];
    return {{key.a, left, 0, row}, {key.b, left, offset.columns, row + offset.rows}};
  }

  void triples(double lo, const std::vector<Alive>& before, const std::vector<Alive>& after) {
    const auto list = moving(lo, before, after, true);
    for (const Moving& p : list) {
      for (const Moving& q : list) {
        if (p.key.a != q.key.a || p.key.offset >= q.key.offset) continue;
        const auto both = meeting(p, q, true);
        if (!both || (both->h0 < 0) == (both->h1 < 0)) continue;
        const auto root =
            halved(both->from_rad, both->to_rad, [&](const Turn& theta) -> std::optional<double> {
              const auto op = origin(p.key, theta, true);
              const auto oq = origin(q.key, theta, true);
              if (!op || !oq) return std::nullopt;
              return op->y() - oq->y();
            });
        if (!root) continue;
        const auto op = origin(p.key, *root, true);
        const auto oq = origin(q.key, *root, true);
        if (!op || !oq || (*op - *oq).norm() > 1e-6) continue;
        std::vector<Placed> pins = pair_pins(p.key, true, 0);
        pins.push_back(pair_pins(q.key, true, 0)[1]);
        oppose(*root, pins, *op);
      }
    }
  }

  /// Every right pin on every feature and row.
  void oppose(const Turn& theta, const std::vector<Placed>& pins, const Vector2d& o) {
    for (int feature = 0; feature < static_cast<int>(features_.size()); ++feature) {
      for (int row = -kit_.grid.rows; row < kit_.grid.rows; ++row) {
        const Locus curve = locus(feature, theta, kit_.grid.spacing_mm * Vector2d(0, row));
        const Locus level{false, Vector2d(0, o.y()), Vector2d::UnitX(), 0};
        for (const auto& at : crossings(level, curve)) {
          if (at) judge(theta, pins, {{feature, false, 0, row}}, o, at->x());
        }
      }
    }
  }

  /// Two pins on parallel lines: theta stands still, the part slides; where it slides into other contacts.
  void parallels() {
    for (int a = 0; a < static_cast<int>(features_.size()); ++a) {
      for (int b = 0; b < static_cast<int>(features_.size()); ++b) {
        for (int k = 0; k < static_cast<int>(offsets_.size()); ++k) parallel(a, b, k);
      }
    }
  }

  void parallel(int a, int b, int offset) {
    const auto* sa = std::get_if<Segment>(&features_[static_cast<std::size_t>(a)].curve);
    const auto* sb = std::get_if<Segment>(&features_[static_cast<std::size_t>(b)].curve);
    if (sa == nullptr || sb == nullptr) return;
    const Vector2d ta = (sa->b_mm - sa->a_mm).normalized();
    const Vector2d tb = (sb->b_mm - sb->a_mm).normalized();
    if (std::abs(cross(ta, tb)) > 1e-9 || ta.dot(tb) < 0) return;
    const Vector2d n(ta.y(), -ta.x());
    const Vector2d v = apart(offset, true);
    const double level = n.dot(sb->a_mm - sa->a_mm) / v.norm();
    if (std::abs(level) > 1) return;
    for (const double sign : {-1.0, 1.0}) {
      const double theta = std::atan2(v.y(), v.x()) + sign * std::acos(level) - std::atan2(n.y(), n.x());
      slide(Turn(theta), {a, b, offset, 0});
    }
  }

  void slide(const Turn& theta, const Key& key) {
    const Locus line = locus(key.a, theta, Vector2d::Zero());
    if (std::abs(line.direction.y()) < 1e-6) return;
    for (const Alive& right : alive(theta, false)) {
      for (int m = -2 * kit_.grid.rows; m <= 2 * kit_.grid.rows; ++m) {
        const double y = right.o_mm.y() + m * kit_.grid.spacing_mm;
        const Vector2d o = line.point + (y - line.point.y()) / line.direction.y() * line.direction;
        judge(theta, pair_pins(key, true, 0), pair_pins(right.key, false, m), o, right.o_mm.x());
      }
    }
    for (int c = 0; c < static_cast<int>(features_.size()); ++c) {
      for (int k = 0; k < static_cast<int>(offsets_.size()); ++k) {
        if (k == key.offset) continue;
        for (const auto& o : crossings(line, locus(c, theta, apart(k, true)))) {
          if (!o) continue;
          std::vector<Placed> pins = pair_pins(key, true, 0);
          pins.push_back(pair_pins({key.a, c, k, 0}, true, 0)[1]);
          oppose(theta, pins, *o);
        }
      }
    }
  }

  /// The strict test; keeps the fixture and its twin. x_right: from the right pins' column 0.
  void judge(const Turn& theta, std::vector<Placed> pins, const std::vector<Placed>& rights,
             const Vector2d& o, double x_right) {
    pins.insert(pins.end(), rights.begin(), rights.end());
    Eigen::Matrix<double, 3, 4> wrenches;
    for (std::size_t k = 0; k < 4; ++k) {
      const Placed& pin = pins[k];
      const Vector2d hole = kit_.grid.spacing_mm * Vector2d(pin.left ? -pin.column : pin.column, pin.row);
      const Vector2d at(pin.left ? o.x() : x_right, o.y());
      const auto n = contact(pin.feature, theta, hole, at, 1e-7);
      if (!n || (pin.left ? -n->x() : n->x()) < 1e-6) return;
      const Vector2d lever = hole - at;
      if (planar::outline_distance_mm(profile_, turned_back(theta, lever)) < kit_.pins.radius_mm - 1e-6)
        return;
      wrenches.col(static_cast<Eigen::Index>(k)) << -n->x(), -n->y(), -cross(lever, *n) / 10;
    }
    const Eigen::FullPivLU<Eigen::Matrix<double, 3, 4>> lu(wrenches);
    if (lu.rank() < 3) return;
    Eigen::Vector4d multipliers = lu.kernel().col(0);
    if (multipliers.sum() < 0) multipliers = -multipliers;
    const double margin = multipliers.minCoeff() / multipliers.cwiseAbs().sum();
    if (margin < 1e-8) return;
    keep(theta.rad, pins, o.x() - x_right, margin);
  }

  void keep(double theta, const std::vector<Placed>& pins, double span, double margin) {
    const double d = kit_.grid.spacing_mm;
    const auto [low, high] = std::ranges::minmax(pins, {}, &Placed::row);
    int least[2] = {99, 99};
    int most[2] = {-99, -99};
    for (const Placed& pin : pins) {
      least[pin.left ? 0 : 1] = std::min(least[pin.left ? 0 : 1], pin.column);
      most[pin.left ? 0 : 1] = std::max(most[pin.left ? 0 : 1], pin.column);
    }
    const int extent[2] = {most[0] - least[0], most[1] - least[1]};
    if (high.row - low.row > kit_.grid.rows - 1) return;
    if (std::max(extent[0], extent[1]) > kit_.grid.columns - 1) return;
    const double canonical = span + (least[0] + least[1]) * d;
    bool in_range = false;
    for (int shift = 0; shift <= 2 * (kit_.grid.columns - 1) - extent[0] - extent[1]; ++shift) {
      in_range =
          in_range || kit_.jaws.separation_mm.contains(canonical - 2 * kit_.grid.edge_offset_mm - shift * d);
    }
    if (!in_range) return;
    SlowFixture one{geometry::wrapped_rad(theta), canonical, margin, {}};
    SlowFixture twin{geometry::wrapped_rad(theta + kTurn / 2), canonical, margin, {}};
    for (const Placed& pin : pins) {
      const auto jaw = pin.left ? model::JawSide::Left : model::JawSide::Right;
      const auto other = pin.left ? model::JawSide::Right : model::JawSide::Left;
      const int column = pin.column - least[pin.left ? 0 : 1];
      one.pins.push_back({{jaw, column, pin.row - low.row}, pin.feature});
      twin.pins.push_back({{other, column, high.row - pin.row}, pin.feature});
    }
    for (SlowFixture* fixture : {&one, &twin}) {
      std::ranges::sort(fixture->pins);
      found_.push_back(*fixture);
    }
  }

  const model::Profile& profile_;
  const model::Kit& kit_;
  std::vector<model::Feature> features_;
  ThetaSteps steps_;
  std::vector<Offset> offsets_;
  std::vector<SlowFixture> found_;
};

}  // namespace

std::vector<SlowFixture> slow_search(const model::Profile& profile, const model::Kit& kit,
                                     const ThetaSteps& steps) {
  return Search(profile, kit, steps).run();
}

}  // namespace pinjaw::planner

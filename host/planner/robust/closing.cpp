#include "host/planner/robust/closing.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pinjaw::planner {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;
using geometry::Arc;
using geometry::Segment;
using geometry::Vector2d;

constexpr double kSettled_mm = 1e-12;
constexpr int kMostSteps = 30;        // chosen: Newton needs three to five
constexpr int kMostBoundSteps = 300;  // chosen: what settles shrinks by a tenth a step or more
constexpr double kFarthest_mm = 10;   // chosen: a part that moves this far has not closed as designed

Vector2d quarter_turn(const Vector2d& v) {
  return {-v.y(), v.x()};
}

/// How far a pin's axis is from where it touches, and which way is out.
struct Distance {
  double over_curve_mm = 0;  ///< from the feature's curve, outwards positive
  Vector2d outward = Vector2d::UnitX();
};

Distance distance_of(const geometry::Curve& curve, model::Bulge bulge, const Vector2d& p_mm) {
  if (const auto* segment = std::get_if<Segment>(&curve)) {
    const Vector2d outward = -quarter_turn((segment->b_mm - segment->a_mm).normalized());
    return {outward.dot(p_mm - segment->a_mm), outward};
  }
  const auto& arc = std::get<Arc>(curve);
  const Vector2d radial = p_mm - arc.center_mm;
  const double sign = bulge == model::Bulge::Convex ? 1 : -1;
  return {sign * (radial.norm() - arc.radius_mm), sign * radial.normalized()};
}

/// Arc length of the point of the curve nearest to `p_mm`, below 0 or above its length past its ends.
double along_of(const geometry::Curve& curve, const Vector2d& p_mm) {
  if (const auto* segment = std::get_if<Segment>(&curve))
    return (segment->b_mm - segment->a_mm).normalized().dot(p_mm - segment->a_mm);
  const auto& arc = std::get<Arc>(curve);
  const Vector2d radial = p_mm - arc.center_mm;
  const double at_rad = geometry::wrapped_rad(std::atan2(radial.y(), radial.x()) - arc.from_rad);
  const double past_rad = (2 * std::numbers::pi - arc.sweep_rad) / 2;
  return arc.radius_mm * (at_rad > arc.sweep_rad + past_rad ? at_rad - 2 * std::numbers::pi : at_rad);
}

/// The radius of the circle that a pin's axis follows about an arc; infinite along a segment.
double path_radius_mm(const geometry::Curve& curve, model::Bulge bulge, double pin_radius_mm) {
  const auto* arc = std::get_if<Arc>(&curve);
  if (arc == nullptr) return std::numeric_limits<double>::infinity();
  return arc->radius_mm + (bulge == model::Bulge::Convex ? pin_radius_mm : -pin_radius_mm);
}

double greatest_push_mm(const model::Ranges& ranges) {
  return ranges.pin_position_mm + ranges.pin_radius_mm + ranges.part_size_mm;
}

}  // namespace

/// The contact equations at q: the reference point's way in the gripper frame, the part's turn and the jaws'.
struct Closing::State {
  Vector4d gap_mm = Vector4d::Zero();
  Matrix4d jacobian = Matrix4d::Zero();
  std::array<Vector2d, 4> axis_P_mm;
  std::array<Vector2d, 4> outward_P;
};

Closing::Closing(const model::Design& design, const std::vector<model::Feature>& features,
                 const model::Kit& kit, const Vector2d& reference_P_mm)
    : radius_mm_(kit.pins.radius_mm),
      separation_mm_(design.jaw_separation_mm),
      nominal_(design.part_pose),
      reference_P_mm_(reference_P_mm),
      reference_G_mm_(design.part_pose * reference_P_mm) {
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    const model::PinDesign& pin = design.pins[i];
    const model::Feature& feature = features[static_cast<std::size_t>(pin.feature)];
    pins_[i] = {feature.curve, feature.bulge, pin.hole.jaw == model::JawSide::Left ? -1.0 : 1.0,
                model::p_GHole_mm(kit.grid, pin.hole, design.jaw_separation_mm), pin.normal};
  }
}

Closing::State Closing::state_at(const Vector4d& q, const model::Ranges& ranges,
                                 const model::PinErrors& errors) const {
  State state;
  const geometry::Pose2 turn{nominal_.theta_rad + q[2], Vector2d::Zero()};
  const geometry::Pose2 back = turn.inverse();
  const Vector2d reference_G_mm = reference_G_mm_ + q.head<2>();
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    const Pin& pin = pins_[i];
    const model::PinError& error = errors[i];
    const Vector2d axis_G_mm =
        pin.axis_G_mm +
        ranges.pin_position_mm * (error.towards * pin.n_G + error.across * quarter_turn(pin.n_G)) +
        Vector2d(pin.jaw_sign * q[3] / 2, 0);
    const Vector2d lever_G_mm = axis_G_mm - reference_G_mm;
    state.axis_P_mm[i] = back.turned(lever_G_mm) + reference_P_mm_;
    const Distance distance = distance_of(pin.curve, pin.bulge, state.axis_P_mm[i]);
    state.outward_P[i] = distance.outward;
    const Vector2d outward_G = turn.turned(distance.outward);
    const auto row = static_cast<Eigen::Index>(i);
    state.gap_mm[row] =
        distance.over_curve_mm - radius_mm_ - error.towards * (ranges.pin_radius_mm + ranges.part_size_mm);
    state.jacobian.row(row) << -outward_G.transpose(), -outward_G.dot(quarter_turn(lever_G_mm)),
        pin.jaw_sign * outward_G.x() / 2;
  }
  return state;
}

std::optional<ClosedPart> Closing::at(const model::Ranges& ranges, const model::PinErrors& errors) const {
  Vector4d q = Vector4d::Zero();
  State state = state_at(q, ranges, errors);
  for (int step = 0; step < kMostSteps && state.gap_mm.cwiseAbs().maxCoeff() > kSettled_mm; ++step) {
    q -= state.jacobian.fullPivLu().solve(state.gap_mm);
    if (!q.allFinite() || q.head<2>().norm() > kFarthest_mm || std::abs(q[3]) > kFarthest_mm)
      return std::nullopt;
    state = state_at(q, ranges, errors);
  }
  if (!(state.gap_mm.cwiseAbs().maxCoeff() < 100 * kSettled_mm)) return std::nullopt;

  ClosedPart part;
  part.separation_mm = separation_mm_ + q[3];
  part.moved_mm = q.head<2>().norm();
  part.turned_rad = q[2];
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    ClosedPart::Contact& contact = part.contacts[i];
    const double radius_mm = radius_mm_ + errors[i].towards * ranges.pin_radius_mm;
    contact.n_P = -state.outward_P[i];
    contact.p_P_mm = state.axis_P_mm[i] + radius_mm * contact.n_P;
    contact.along_mm = along_of(pins_[i].curve, contact.p_P_mm);
    const double length_mm = geometry::length_mm(pins_[i].curve);
    const auto* arc = std::get_if<Arc>(&pins_[i].curve);
    const bool full = arc != nullptr && arc->sweep_rad > 2 * std::numbers::pi - 1e-9;
    constexpr double kEndTolerance_mm = 1e-6;  // chosen: a foot planned exactly at an end is still on it
    contact.on_feature =
        full || (contact.along_mm >= -kEndTolerance_mm && contact.along_mm <= length_mm + kEndTolerance_mm);
  }
  return part;
}

namespace {

using Eigen::Matrix;

/// A linear map of the errors and the departures: its most over every sign of `push`, exactly, since a norm
/// is convex, and over departures up to `most`.
class Spread {
 public:
  Spread(Matrix<double, 2, 4> map, const Vector4d& push) : sizes_(map.cwiseAbs()) {
    for (int signs = 0; signs < 16; ++signs) {
      Vector4d at = push;
      for (int i = 0; i < 4; ++i) at[i] *= ((signs >> i) & 1) != 0 ? 1 : -1;
      corner_mm_ = std::max(corner_mm_, (map * at).norm());
    }
  }
  [[nodiscard]] double most_mm(const Vector4d& departure_mm) const {
    return corner_mm_ + (sizes_ * departure_mm).norm();
  }

 private:
  Matrix<double, 2, 4> sizes_;
  double corner_mm_ = 0;
};

}  // namespace

std::optional<LocationBound> Closing::bound(const model::Ranges& ranges) const {
  const State state = state_at(Vector4d::Zero(), ranges, {});
  const Eigen::FullPivLU<Matrix4d> lu(state.jacobian);
  if (!lu.isInvertible()) return std::nullopt;
  const Matrix4d inverse = lu.inverse();
  const Vector4d push = Vector4d::Constant(greatest_push_mm(ranges)) + state.gap_mm.cwiseAbs();
  const double shift_mm = std::sqrt(2.0) * ranges.pin_position_mm;  // of an axis from its hole
  const Spread moved(inverse.topRows<2>(), push);
  const auto turned_rad = [&](const Vector4d& departure_mm) {
    return inverse.row(2).cwiseAbs().dot(push + departure_mm);
  };
  std::vector<Spread> levers;  // by how much each axis moves about the reference point, in the gripper's axes
  std::vector<Spread> ways;    // and how far it moves over the part
  for (const Pin& pin : pins_) {
    Matrix<double, 2, 4> lever = Matrix<double, 2, 4>::Zero();
    lever.leftCols<2>() = -Eigen::Matrix2d::Identity();
    lever(0, 3) = pin.jaw_sign / 2;
    levers.emplace_back(lever * inverse, push);
    lever.col(2) = -quarter_turn(pin.axis_G_mm - reference_G_mm_);
    ways.emplace_back(lever * inverse, push);
  }

  // How far each equation departs from its tangent where none departs by more than `most`: a turn by t moves
  // a lever l by t z x l up to t^2 l / 2, and a way m about an arc of radius R bends by m^2 / (2 (R - m)).
  const auto departure_of = [&](const Vector4d& most_mm) {
    Vector4d departure_mm;
    const double turn_rad = turned_rad(most_mm);
    for (std::size_t i = 0; i < pins_.size(); ++i) {
      const double slide_mm = levers[i].most_mm(most_mm) + shift_mm;
      const double lever_mm = (pins_[i].axis_G_mm - reference_G_mm_).norm() + slide_mm;
      const double turning_mm = turn_rad * turn_rad * lever_mm / 2 + turn_rad * slide_mm;
      const double way_mm = ways[i].most_mm(most_mm) + shift_mm + turning_mm;
      const double path_mm = path_radius_mm(pins_[i].curve, pins_[i].bulge, radius_mm_);
      double bending_mm = 0;
      if (std::isfinite(path_mm)) {
        if (way_mm >= path_mm) return Vector4d(Vector4d::Constant(std::numeric_limits<double>::infinity()));
        bending_mm = way_mm * way_mm / (2 * (path_mm - way_mm));
      }
      departure_mm[static_cast<Eigen::Index>(i)] = turning_mm + bending_mm;
    }
    return departure_mm;
  };
  constexpr double kGrowth = 1 + 1e-6;  // `most` must be left strictly
  constexpr double kLeast_mm = 1e-12;
  Vector4d most_mm = Vector4d::Constant(kLeast_mm);
  for (int step = 0; step < kMostBoundSteps; ++step) {
    const Vector4d departure_mm = departure_of(most_mm);
    if (!(departure_mm.maxCoeff() < kFarthest_mm)) return std::nullopt;
    if ((departure_mm.array() < most_mm.array()).all())
      return LocationBound{moved.most_mm(most_mm), turned_rad(most_mm)};
    most_mm = kGrowth * departure_mm.cwiseMax(most_mm);
  }
  return std::nullopt;
}

}  // namespace pinjaw::planner

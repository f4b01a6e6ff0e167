#include "host/planner/planar/candidate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/geometry/curve_foot.hpp"
#include "host/planner/planar/constants.hpp"

namespace pinjaw::planner::planar {
namespace {

constexpr double kLeastPush = 1e-6;        // |n_x| under this is rounding of 0, as in the known cases
constexpr double kLeastMultiplier = 1e-9;  // chosen: above rounding, far below any real margin
constexpr double kRoughMultiplier =
    -0.02;  // chosen: seeds are near enough to tell this much before polishing
constexpr double kSeparationTolerance_mm = 1e-9;
constexpr double kMarginTolerance_mm = 1e-9;
constexpr double kRoughSpan_mm = 1.0;  // chosen: seeds of a span are good to far less

geometry::Interval extent(const Candidate& candidate, bool rows, bool left) {
  double lo = 1e9;
  double hi = -1e9;
  for (const CandidatePin& pin : candidate.pins) {
    if (!rows && pin.left != left) continue;
    const double at = rows ? pin.row : pin.column;
    lo = std::min(lo, at);
    hi = std::max(hi, at);
  }
  return {lo, hi};
}

}  // namespace

Judge::Judge(const std::vector<ContactCurve>& curves, const std::vector<model::Feature>& features,
             const model::Kit& kit)
    : curves_(curves), features_(features), kit_(kit) {}

std::optional<Candidate> Judge::judged(Candidate candidate) const {
  if (!fits_plates(candidate)) return std::nullopt;
  const std::array<Touch, 4> touches{touch(candidate.pins[0]), touch(candidate.pins[1]),
                                     touch(candidate.pins[2]), touch(candidate.pins[3])};
  std::array<ContactState, 4> states;
  const auto look = [&] {
    for (std::size_t k = 0; k < 4; ++k) states[k] = contact_at(touches[k], candidate.placement);
    return std::ranges::min(closure_multipliers(states));
  };
  if (look() < kRoughMultiplier) return std::nullopt;
  if (!polish(touches, candidate.placement)) return std::nullopt;
  candidate.closure_margin = look();
  if (!(candidate.closure_margin > kLeastMultiplier)) return std::nullopt;
  if (!feet_hold(touches, states, candidate.placement.theta_rad)) return std::nullopt;
  if (!span_in_range(candidate) || jaws_overlap(candidate)) return std::nullopt;
  return candidate;
}

bool Judge::fits_plates(const Candidate& candidate) const {
  if (extent(candidate, true, true).length() > kit_.grid.rows - 1) return false;
  for (const bool left : {true, false}) {
    if (extent(candidate, false, left).length() > kit_.grid.columns - 1) return false;
  }
  const double span_mm = candidate.placement.x_left_mm - candidate.placement.x_right_mm;
  const double most_mm = kit_.jaws.separation_mm.hi + 2 * kit_.grid.edge_offset_mm +
                         2 * (kit_.grid.columns - 1) * kit_.grid.spacing_mm;
  return span_mm > kit_.jaws.separation_mm.lo + 2 * kit_.grid.edge_offset_mm - kRoughSpan_mm &&
         span_mm < most_mm + kRoughSpan_mm;
}

bool Judge::span_in_range(const Candidate& candidate) const {
  const int room = 2 * (kit_.grid.columns - 1) - static_cast<int>(extent(candidate, false, true).length()) -
                   static_cast<int>(extent(candidate, false, false).length());
  const double s_mm =
      candidate.placement.x_left_mm - candidate.placement.x_right_mm - 2 * kit_.grid.edge_offset_mm;
  const geometry::Interval& range = kit_.jaws.separation_mm;
  for (int shift = 0; shift <= room; ++shift) {
    const double shifted_mm = s_mm - shift * kit_.grid.spacing_mm;
    if (shifted_mm >= range.lo - kSeparationTolerance_mm &&
        shifted_mm <= range.hi + kSeparationTolerance_mm) {
      return true;
    }
  }
  return false;
}

bool Judge::jaws_overlap(const Candidate& candidate) const {
  const double span_mm = candidate.placement.x_left_mm - candidate.placement.x_right_mm;
  for (const CandidatePin& left : candidate.pins) {
    for (const CandidatePin& right : candidate.pins) {
      if (!left.left || right.left) continue;
      const double across_mm = span_mm + (left.column + right.column) * kit_.grid.spacing_mm;
      const double along_mm = (left.row - right.row) * kit_.grid.spacing_mm;
      if (std::hypot(across_mm, along_mm) < 2 * kit_.pins.radius_mm - kOverlap_mm) return true;
    }
  }
  return false;
}

bool Judge::feet_hold(const std::array<Touch, 4>& touches, const std::array<ContactState, 4>& states,
                      double theta_rad) const {
  const geometry::Pose2 back{-theta_rad, Vector2d::Zero()};
  for (std::size_t k = 0; k < 4; ++k) {
    const double push = touches[k].left ? -states[k].normal.x() : states[k].normal.x();
    if (push < kLeastPush) return false;
    const Vector2d q_mm = back.turned(states[k].lever_mm);
    if (!in_range(*touches[k].curve, q_mm, kFootTolerance_mm)) return false;
    if (kit_.pins.min_foot_margin_mm > 0 &&
        foot_margin_mm(*touches[k].curve, q_mm) < kit_.pins.min_foot_margin_mm - kMarginTolerance_mm) {
      return false;
    }
  }
  return true;
}

double Judge::foot_along_mm(const ContactCurve& curve, const Vector2d& q_mm) const {
  return geometry::nearest_along_mm(features_[static_cast<std::size_t>(curve.feature)].curve, q_mm);
}

double Judge::foot_margin_mm(const ContactCurve& curve, const Vector2d& q_mm) const {
  return geometry::end_margin_mm(features_[static_cast<std::size_t>(curve.feature)].curve,
                                 foot_along_mm(curve, q_mm));
}

}  // namespace pinjaw::planner::planar

#include "tests/host/planner/planar/slow/track.hpp"

#include <cmath>
#include <numbers>

namespace pinjaw::planner::slow {
namespace {

double angle_of(const Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

}  // namespace

Track::Track(const model::Feature& feature, double pin_radius_mm) {
  if (const auto* segment = std::get_if<geometry::Segment>(&feature.curve)) {
    length_mm_ = (segment->b_mm - segment->a_mm).norm();
    tangent_ = (segment->b_mm - segment->a_mm) / length_mm_;
    start_mm_ = segment->a_mm + pin_radius_mm * Vector2d(tangent_.y(), -tangent_.x());
    return;
  }
  const auto& arc = std::get<geometry::Arc>(feature.curve);
  arc_ = true;
  side_ = feature.bulge == model::Bulge::Convex ? 1 : -1;
  center_mm_ = arc.center_mm;
  rho_mm_ = arc.radius_mm + side_ * pin_radius_mm;
  from_rad_ = arc.from_rad;
  length_mm_ = rho_mm_ * arc.sweep_rad;
  feature_per_track_ = arc.radius_mm / rho_mm_;
}

double Track::turn_mm() const {
  return 2 * std::numbers::pi * rho_mm_;
}

Vector2d Track::centre(double at_mm) const {
  if (arc_) return center_mm_ + rho_mm_ * geometry::direction(from_rad_ + at_mm / rho_mm_);
  return start_mm_ + at_mm * tangent_;
}

double Track::nearest(const Vector2d& p_mm) const {
  if (!arc_) return tangent_.dot(p_mm - start_mm_);
  const double middle_rad = from_rad_ + length_mm_ / rho_mm_ / 2;
  const double off_rad = std::remainder(angle_of(p_mm - center_mm_) - middle_rad, 2 * std::numbers::pi);
  return length_mm_ / 2 + rho_mm_ * off_rad;
}

double Track::miss_mm(const Vector2d& p_mm) const {
  if (arc_) return side_ * ((p_mm - center_mm_).norm() - rho_mm_);
  return Vector2d(tangent_.y(), -tangent_.x()).dot(p_mm - start_mm_);
}

Vector2d Track::outward(const Vector2d& p_mm) const {
  if (arc_) return side_ * (p_mm - center_mm_).normalized();
  return {tangent_.y(), -tangent_.x()};
}

Track::Places Track::places_away(const Vector2d& p_mm, double distance_mm) const {
  if (arc_) {
    const Vector2d towards = p_mm - center_mm_;
    const double gap_mm = towards.norm();
    if (gap_mm < 1e-12) return {};
    return around(towards,
                  (gap_mm * gap_mm + rho_mm_ * rho_mm_ - distance_mm * distance_mm) / (2 * gap_mm * rho_mm_));
  }
  const double off_mm = miss_mm(p_mm);
  const double square = distance_mm * distance_mm - off_mm * off_mm;
  if (square < 0) return {};
  const double foot_mm = nearest(p_mm);
  return {foot_mm - std::sqrt(square), foot_mm + std::sqrt(square)};
}

Track::Places Track::places_on_line(const Vector2d& p_mm, const Vector2d& along) const {
  const Vector2d across(-along.y(), along.x());
  if (arc_) return around(across, across.dot(p_mm - center_mm_) / rho_mm_);
  const double slope = across.dot(tangent_);
  if (std::abs(slope) < 1e-9) return {};
  return {across.dot(p_mm - start_mm_) / slope, std::nullopt};
}

/// The two places whose direction from the centre has this cosine to `towards`.
Track::Places Track::around(const Vector2d& towards, double cosine) const {
  if (std::abs(cosine) > 1) return {};
  const double half_rad = std::acos(cosine);
  const double middle_rad = angle_of(towards);
  return {nearest(center_mm_ + geometry::direction(middle_rad - half_rad)),
          nearest(center_mm_ + geometry::direction(middle_rad + half_rad))};
}

}  // namespace pinjaw::planner::slow

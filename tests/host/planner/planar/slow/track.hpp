#pragma once

#include <array>
#include <optional>

#include "host/model/feature.hpp"

namespace pinjaw::planner::slow {

using geometry::Vector2d;

/// A turn of the plane, its sine and cosine worked out once.
class Turn {
 public:
  explicit Turn(double angle_rad) : x_axis_(geometry::direction(angle_rad)) {}
  Vector2d operator*(const Vector2d& v) const {
    return {x_axis_.x() * v.x() - x_axis_.y() * v.y(), x_axis_.y() * v.x() + x_axis_.x() * v.y()};
  }
  [[nodiscard]] Vector2d back(const Vector2d& v) const {
    return {x_axis_.x() * v.x() + x_axis_.y() * v.y(), x_axis_.x() * v.y() - x_axis_.y() * v.x()};
  }

 private:
  Vector2d x_axis_;
};

/// The line or circle that the centre of a pin runs along while it touches one feature, in the part frame. A
/// place on it is its distance `at_mm` along the track from where the feature starts; places before the start
/// and behind the end are on the continuation. All closed forms of plane geometry, none of the planner's own.
class Track {
 public:
  Track(const model::Feature& feature, double pin_radius_mm);

  /// No pin fits into a bore of at most its own radius.
  [[nodiscard]] bool exists() const { return !arc_ || rho_mm_ > 1e-9; }
  [[nodiscard]] bool closed() const { return arc_ && length_mm_ > turn_mm() - 1e-6; }
  [[nodiscard]] double length_mm() const { return length_mm_; }
  /// Millimetres of the feature for one of the track.
  [[nodiscard]] double feature_per_track() const { return feature_per_track_; }

  [[nodiscard]] Vector2d centre(double at_mm) const;
  /// Place next to a point of the plane, between -turn / 2 + length / 2 and turn / 2 + length / 2 on a
  /// circle.
  [[nodiscard]] double nearest(const Vector2d& p_mm) const;
  /// Distance of a point from the whole track, positive on the free side.
  [[nodiscard]] double miss_mm(const Vector2d& p_mm) const;
  /// Unit normal at a point next to the track, from the material to the free side.
  [[nodiscard]] Vector2d outward(const Vector2d& p_mm) const;

  using Places = std::array<std::optional<double>, 2>;
  /// Where the track is `distance_mm` away from a point.
  [[nodiscard]] Places places_away(const Vector2d& p_mm, double distance_mm) const;
  /// Where the track meets the line through `p_mm` along the unit vector `along`.
  [[nodiscard]] Places places_on_line(const Vector2d& p_mm, const Vector2d& along) const;

 private:
  [[nodiscard]] double turn_mm() const;
  [[nodiscard]] Places around(const Vector2d& towards, double cosine) const;

  bool arc_ = false;
  double length_mm_ = 0;
  double feature_per_track_ = 1;
  double side_ = 1;                       ///< arc: +1 outside, -1 in a bore
  Vector2d start_mm_ = Vector2d::Zero();  ///< line
  Vector2d tangent_ = Vector2d::UnitX();  ///< line
  Vector2d center_mm_ = Vector2d::Zero();
  double rho_mm_ = 0;
  double from_rad_ = 0;
};

}  // namespace pinjaw::planner::slow

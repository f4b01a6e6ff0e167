#pragma once

#include <array>
#include <optional>
#include <string>

#include "host/geometry/plane.hpp"

namespace pinjaw::model {

/// How far the world may be from what a plan takes it for. The defaults are chosen: jig-bored holes, ground
/// pins, a machined part, shop air.
struct Ranges {
  std::optional<geometry::Interval> friction;    ///< static coefficient; nothing: a fifth to either side
  double pin_position_mm = 0.02;                 ///< of each pin's axis, along and across its normal
  double pin_radius_mm = 0.01;                   ///< each pin thicker or thinner by up to this
  double part_size_mm = 0.05;                    ///< each feature in or out by up to this
  geometry::Interval air_pressure = {0.9, 1.1};  ///< share of the nominal pressure

  [[nodiscard]] geometry::Interval friction_about(double nominal) const {
    return friction.value_or(geometry::Interval{0.8 * nominal, 1.2 * nominal});
  }
};

/// Where in its ranges one pin stands: -1 to 1, shares of the whole range.
struct PinError {
  double towards = 0;  ///< pin moved towards the part and thicker, the feature further out
  double across = 0;   ///< pin moved along z x n
};
using PinErrors = std::array<PinError, 4>;

/// A design at its worst over the ranges of its task.
struct Robust {
  std::optional<double> worst_required_n;  ///< nothing where the design fails somewhere in the ranges
  std::string failure;  ///< how: jams, wedges, not_resistable, leaves_a_feature, does_not_close
  double friction = 0;  ///< where the worst was found, or the failure
  PinErrors pins;
  std::string critical;                     ///< name of the disturbance that needs worst_required_n
  double usable_n = 0;                      ///< at the least air pressure
  double margin_n = 0;                      ///< usable_n - worst_required_n; 0 where that is nothing
  double location_error_mm = 0;             ///< how far the part's centroid was found to move in plan
  double location_error_deg = 0;            ///< how far the part was found to turn
  std::optional<double> location_bound_mm;  ///< no point of the ranges moves it further; nothing: not proven
  std::optional<double> location_bound_deg;
};

}  // namespace pinjaw::model

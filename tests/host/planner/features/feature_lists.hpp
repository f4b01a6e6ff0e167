#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "host/model/feature.hpp"

/// Comparing lists of features whatever their order.
namespace pinjaw::planner {

inline double total_length_mm(const std::vector<model::Feature>& features) {
  double sum_mm = 0;
  for (const model::Feature& feature : features) sum_mm += geometry::length_mm(feature.curve);
  return sum_mm;
}

/// What two equal features share up to rounding: ends, middle and the way that is free.
struct Trace {
  geometry::Vector2d from_mm;
  geometry::Vector2d middle_mm;
  geometry::Vector2d to_mm;
  geometry::Vector2d normal;
  double length_mm = 0;  ///< below 0 where the material lies around the curve
};

/// A full circle has no ends; its centre stands for them.
inline Trace trace_of(const model::Feature& feature) {
  const auto* arc = std::get_if<geometry::Arc>(&feature.curve);
  const double length_mm = geometry::length_mm(feature.curve);
  const double signed_mm = feature.bulge == model::Bulge::Convex ? length_mm : -length_mm;
  if (arc != nullptr && arc->sweep_rad > 6.283185) {
    return {arc->center_mm, arc->center_mm, arc->center_mm, geometry::Vector2d::Zero(), signed_mm};
  }
  return {geometry::point_at(feature.curve, 0), geometry::point_at(feature.curve, length_mm / 2),
          geometry::point_at(feature.curve, length_mm), model::outward_normal_at(feature, length_mm / 2),
          signed_mm};
}

inline double difference(const Trace& a, const Trace& b) {
  return std::max({(a.from_mm - b.from_mm).norm(), (a.middle_mm - b.middle_mm).norm(),
                   (a.to_mm - b.to_mm).norm(), (a.normal - b.normal).norm(),
                   std::abs(a.length_mm - b.length_mm)});
}

/// How many of `features` have no equal in `others`, compared as they are or after `move` of the former.
template <class Move>
int without_equal(const std::vector<model::Feature>& features, const std::vector<model::Feature>& others,
                  double tolerance_mm, const Move& move) {
  int missing = 0;
  for (const model::Feature& feature : features) {
    const Trace moved = move(trace_of(feature));
    const bool found = std::ranges::any_of(others, [&](const model::Feature& other) {
      return difference(moved, trace_of(other)) < tolerance_mm;
    });
    if (!found) ++missing;
  }
  return missing;
}

inline Trace unmoved(const Trace& trace) {
  return trace;
}

}  // namespace pinjaw::planner

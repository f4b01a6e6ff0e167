#include "host/planner/features/visibility.hpp"

#include <algorithm>
#include <cmath>

#include "host/planner/features/features.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;

constexpr double kSampleStepMm = 0.25;  // chosen: edges split elsewhere; only curved faces change in between
constexpr double kCutMm = 1e-5;

double lowest_z_mm(const geometry::Surface& surface, const geometry::Vector2d& p_mm) {
  const auto hit = surface.lowest_above(p_mm);
  return hit ? hit->point_mm.z() : std::numeric_limits<double>::infinity();
}

struct Edge {
  const geometry::Surface& surface;
  const Carrier& carrier;
  double engagement_mm;
  double beside_mm;

  [[nodiscard]] FreeSide side_at(double along_mm) const {
    const geometry::Vector2d p_mm = carrier.point_at(along_mm);
    const geometry::Vector2d aside_mm = beside_mm * carrier.right_at(along_mm);
    const double right_mm = lowest_z_mm(surface, p_mm + aside_mm);
    const double left_mm = lowest_z_mm(surface, p_mm - aside_mm);
    // Heights of meshed faces carry rounding; a wall exactly as high as the engagement counts.
    constexpr double kRoundingMm = 1e-9;
    if (right_mm > left_mm && right_mm - left_mm >= engagement_mm - kRoundingMm) return FreeSide::Right;
    if (left_mm > right_mm && left_mm - right_mm >= engagement_mm - kRoundingMm) return FreeSide::Left;
    return FreeSide::None;
  }

  /// Where the side stops being that at `lo_mm`; it differs at `hi_mm`.
  [[nodiscard]] double change_mm(double lo_mm, double hi_mm) const {
    const FreeSide before = side_at(lo_mm);
    while (hi_mm - lo_mm > kCutMm) {
      const double middle_mm = (lo_mm + hi_mm) / 2;
      (side_at(middle_mm) == before ? lo_mm : hi_mm) = middle_mm;
    }
    return (lo_mm + hi_mm) / 2;
  }
};

}  // namespace

std::vector<Stretch> jumping_stretches(const geometry::Surface& surface, const Carrier& carrier,
                                       const geometry::Interval& edgelet_mm, double engagement_mm) {
  const double length_mm = edgelet_mm.length();
  const Edge edge{surface, carrier, engagement_mm, std::min(model::kEps_mm, length_mm / 4)};
  const double inset_mm = std::min(3 * model::kEps_mm, length_mm / 4);
  const double first_mm = edgelet_mm.lo + inset_mm;
  const double last_mm = edgelet_mm.hi - inset_mm;
  const int steps = std::max(2, static_cast<int>(std::ceil((last_mm - first_mm) / kSampleStepMm)));
  std::vector<Stretch> stretches;
  double from_mm = edgelet_mm.lo;
  double before_mm = first_mm;
  FreeSide side = edge.side_at(first_mm);
  for (int i = 1; i <= steps; ++i) {
    const double here_mm = first_mm + i * (last_mm - first_mm) / steps;
    const FreeSide here = edge.side_at(here_mm);
    if (here != side) {
      const double cut_mm = edge.change_mm(before_mm, here_mm);
      if (side != FreeSide::None) stretches.push_back({{from_mm, cut_mm}, side});
      from_mm = cut_mm;
      side = here;
    }
    before_mm = here_mm;
  }
  if (side != FreeSide::None) stretches.push_back({{from_mm, edgelet_mm.hi}, side});
  return stretches;
}

Fate why_no_stretch(const geometry::Surface& surface, const Carrier& carrier,
                    const geometry::Interval& edgelet_mm, double z_mm) {
  // Chosen: the lowest surface lies that much lower beside an edge only where it is steeper than 84 degrees.
  constexpr double kBelowMm = 10 * model::kEps_mm;
  // Chosen: what leans by up to 45 degrees runs on.
  constexpr double kFlatMm = 2 * model::kEps_mm;
  const double middle_mm = (edgelet_mm.lo + edgelet_mm.hi) / 2;
  const Vector2d p_mm = carrier.point_at(middle_mm);
  const Vector2d aside_mm = model::kEps_mm * carrier.right_at(middle_mm);
  const double right_mm = lowest_z_mm(surface, p_mm + aside_mm);
  const double left_mm = lowest_z_mm(surface, p_mm - aside_mm);
  if (std::isinf(right_mm) && std::isinf(left_mm)) return Fate::OffSurface;
  if (std::max(right_mm, left_mm) < z_mm - kBelowMm) return Fate::Hidden;
  return std::abs(right_mm - left_mm) <= kFlatMm ? Fate::InFlat : Fate::LowStep;
}

std::vector<Stretch> joined(const std::vector<Stretch>& stretches, const Carrier& carrier) {
  std::vector<Stretch> result;
  for (const Stretch& stretch : stretches) {
    const bool adjacent = !result.empty() && result.back().side == stretch.side &&
                          stretch.along_mm.lo - result.back().along_mm.hi <= kCutMm;
    if (adjacent) {
      result.back().along_mm.hi = stretch.along_mm.hi;
    } else {
      result.push_back(stretch);
    }
  }
  if (!carrier.round || result.size() < 2) return result;
  const bool across_zero =
      result.front().side == result.back().side &&
      result.front().along_mm.lo + carrier.circumference_mm() - result.back().along_mm.hi <= kSameCarrierMm;
  if (across_zero) {
    result.back().along_mm.hi = carrier.circumference_mm() + result.front().along_mm.hi;
    result.erase(result.begin());
  }
  return result;
}

}  // namespace pinjaw::planner

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "host/geometry/patch.hpp"
#include "host/model/tolerance.hpp"
#include "host/planner/heights/heights.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Patch;
using geometry::Slab;
using geometry::Surface;
using geometry::Sweep;
using geometry::Vector2d;

/// Slack on comparisons of heights that are sums of the same numbers in another order.
constexpr double kRounding_mm = 1e-9;
/// Shorter contacts are points (DESIGN 3.1 no. 7).
constexpr double kPointContact_mm = 1e-3;

Sweep disc(const Vector2d& center_mm, double radius_mm) {
  return {center_mm, center_mm, radius_mm};
}

Vector2d axis_mm(const model::PinStock& pins, const Foot& foot) {
  return foot.p_PFoot_mm - pins.radius_mm * foot.n_P;
}

/// All of the part that a pin at this foot can have to do with.
Patch around(const Surface& part, const model::PinStock& pins, const Foot& foot) {
  return {part, disc(axis_mm(pins, foot), pins.radius_mm + 3 * model::kEps_mm)};
}

/// The edge at the foot and the three rays of BB 3.3: what a pin there may touch and how tall it may be.
/// Nothing where no part lies above the point eps inside the foot.
std::optional<PinHeight> probe(const Patch& part, const model::PinStock& pins, const Foot& foot) {
  const auto edge = part.lowest_above(foot.p_PFoot_mm + model::kEps_mm * foot.n_P);
  if (!edge) return std::nullopt;
  const Sweep large = disc(axis_mm(pins, foot), pins.radius_mm + model::kEps_mm);
  const Sweep small = disc(axis_mm(pins, foot), pins.radius_mm - model::kEps_mm);
  PinHeight pin;
  pin.z_edge_mm = edge->point_mm.z();
  pin.contact_min_mm = part.lowest_z_mm(large);
  pin.height_max_mm = part.lowest_z_mm(small);
  // BB starts down-large eps under the ceiling, so that the ceiling itself is no contact.
  pin.contact_max_mm = part.highest_z_mm(large, Slab{.hi_mm = pin.height_max_mm - model::kEps_mm});
  return pin;
}

/// The longest stock length up to `most_mm`; `most_mm` itself where any length can be cut.
std::optional<double> longest_mm(const model::PinStock& pins, double most_mm) {
  if (pins.lengths_mm.empty()) return most_mm;
  const auto above = std::upper_bound(pins.lengths_mm.begin(), pins.lengths_mm.end(), most_mm + kRounding_mm);
  if (above == pins.lengths_mm.begin()) return std::nullopt;
  return *std::prev(above);
}

model::Interval contact_z_mm(const Patch& part, const Foot& foot, double top_mm) {
  const Sweep touch = disc(foot.p_PFoot_mm, 2 * model::kEps_mm);
  const Slab below{.hi_mm = top_mm};
  const model::Interval z{part.lowest_z_mm(touch, below), part.highest_z_mm(touch, below)};
  if (z.length() >= kPointContact_mm || z.lo > z.hi) return z;
  const double middle_mm = std::midpoint(z.lo, z.hi);
  return {middle_mm, middle_mm};
}

/// Where a pin touches at a height found near its foot: at the silhouette that passes there, if the height is
/// its bulge's.
double touched_mm(const Surface& part, const Foot& foot, double z_mm) {
  return part.silhouette_z_mm(foot.p_PFoot_mm, z_mm, 2 * model::kEps_mm).value_or(z_mm);
}

/// Heights that the top may have: engaged on the edge below, under what is above.
model::Interval top_mm(const PinHeight& pin, const model::PinStock& pins) {
  return {pin.z_edge_mm + pins.min_engagement_mm - kRounding_mm,
          std::min(pin.contact_max_mm + pins.protrusion_mm, pin.height_max_mm - pins.clearance_mm)};
}

}  // namespace

std::optional<TopRange> top_range(const Surface& part, const model::PinStock& pins, const Foot& foot) {
  const auto pin = probe(around(part, pins, foot), pins, foot);
  if (!pin) return std::nullopt;
  return TopRange{pin->z_edge_mm, top_mm(*pin, pins)};
}

PinHeightOutcome pin_height(const Surface& part, const model::PinStock& pins, double plate_top_mm,
                            const Foot& foot) {
  const Patch patch = around(part, pins, foot);
  const auto probed = probe(patch, pins, foot);
  if (!probed) return tl::unexpected(HeightLoss::NoSurfaceAtFoot);
  PinHeight pin = *probed;
  pin.z_edge_mm = touched_mm(part, foot, pin.z_edge_mm);
  const auto [least_mm, most_mm] = top_mm(pin, pins);
  if (most_mm < least_mm) return tl::unexpected(HeightLoss::NoEngagement);

  const auto length_mm = longest_mm(pins, most_mm - plate_top_mm);
  if (!length_mm) return tl::unexpected(HeightLoss::NoStockLength);
  pin.length_mm = *length_mm;
  pin.top_mm = pins.lengths_mm.empty() ? most_mm : plate_top_mm + *length_mm;
  if (pin.top_mm < least_mm) return tl::unexpected(HeightLoss::StockTooShort);

  pin.contact_z_mm = contact_z_mm(patch, foot, pin.top_mm);
  pin.contact_z_mm = {touched_mm(part, foot, pin.contact_z_mm.lo),
                      touched_mm(part, foot, pin.contact_z_mm.hi)};
  if (pin.contact_z_mm.lo > pin.contact_z_mm.hi) return tl::unexpected(HeightLoss::NoSurfaceAtFoot);
  return pin;
}

}  // namespace pinjaw::planner
